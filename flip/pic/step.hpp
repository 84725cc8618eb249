// The step of pic: Harlow's phases, call by call.
#pragma once

#include "common/step_clock.hpp"
#include "flip/pic/eulerian_phase.hpp"
#include "flip/pic/lagrangian_phase.hpp"
#include "flip/pic/largest_step.hpp"
#include "flip/pic/pic_cells.hpp"

namespace flip {

/// From t^n to t^{n+1}, as long as the flow allows.
/// in:     cells after find_pressure() for t^n
/// in/out: state: particles, cells, time and the length of the last step, budget
template <class Clock = common::NoClock>
void take_pic_step(const Problem& problem, State& state, PicCells& cells, Clock&& clock = {}) {
    // [step]
    const double dt = largest_step(problem, state, cells);
    accelerate_cells(problem, dt, state, cells);  // Lagrangian phase: u~                 [PIC]
    do_work(problem, dt, state, cells);           // Lagrangian phase: I~                 [PIC]
    clock.lap("mesh");
    move_particles(problem, dt, state, cells);  // particles move to final position       [PIC]
    clock.lap("move");
    repartition(problem, state, cells);  // Eulerian phase: M, momentum, energy           [PIC]
    clock.lap("repartition");
    // [/step]
    state.time += dt;
    state.dt = dt;
}

}  // namespace flip
