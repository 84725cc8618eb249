// What explicit_em takes from its case for a step.
#pragma once

namespace implicit_moment {

/// How explicit_em goes about it; means nothing to implicit_moment.
struct LeapfrogSettings {
    bool chosen = false;  // the run is explicit_em's
    long order = 1;       // of the spline of the charge: 1 linear, 2 quadratic
    bool relativistic = true;
};

}  // namespace implicit_moment
