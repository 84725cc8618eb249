// What explicit_em takes from its case for a step.
#pragma once

#include "implicit_moment/units.hpp"

namespace implicit_moment {

/// How explicit_em goes about it; means nothing to implicit_moment.
struct LeapfrogSettings {
    bool chosen = false;  // the run is explicit_em's
    long order = 1;       // of the spline of the charge: 1 linear, 2 quadratic
    bool relativistic = true;

    /// 1/c^2, or 0 for a push that is not relativistic.
    double per_c_squared() const { return relativistic ? 1 / (c * c) : 0; }
};

}  // namespace implicit_moment
