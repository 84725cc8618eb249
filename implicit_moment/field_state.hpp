// The electromagnetic field of a run: what a checkpoint keeps of it.
#pragma once

#include "implicit_moment/vector_field.hpp"

namespace implicit_moment {

/// E and B at t^n, ghosts filled, and E^{n+theta} of the last step, where the solver starts;
/// explicit_em does not use that one.
struct FieldState {
    VectorField E, B, E_theta;
    explicit FieldState(const Grid& grid) : E(grid), B(grid), E_theta(grid) {}
};

}  // namespace implicit_moment
