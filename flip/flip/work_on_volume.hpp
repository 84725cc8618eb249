// mesh -> particles: what a change of the volume of a cell does to a particle that carries its own.
#pragma once

#include "flip/flip/mesh.hpp"

namespace flip {

namespace detail {

// The factor by which a volume grows in a step, 1 + s, if nothing turned inside out. A bubble of gas
// that shares its cell with a liquid takes all of the change of volume, more than its own perhaps:
// below one half it is squeezed less and less.
inline double growth_of_volume(double s) { return s >= -0.5 ? 1 + s : -0.25 / s; }

// How far the materials of a cell come towards one pressure in a step.
inline constexpr double relaxation = 0.5;

// Work on one particle that carries its volume, which it takes at its own pressure; per mass. Where
// materials share a cell, the softer takes nearly all of its change of volume, and a liquid would keep
// the pressure that it came with, to burst with later: so they push each other towards p_c, volume for
// volume, with the work of p_c: the cell keeps its volume and its energy. A gas also takes a part of
// the room in its cell, at constant energy: volumes follow the pressure, and where they have drifted
// from the places of the particles, nothing else would bring them back.
//   V_p *= growth_of_volume(s) (1 + filling sum_c R room_c)
//   s = (C_p/V_p) sum_c R (strain_c + relaxation excess_kc),  C_p of weight_in_cell(), excess of
//   find_pressure()
// in: cells.strain, work, q_work, excess, p, room; in/out: V_p
inline double work_on_volume(const Problem& problem, const WeightScale& scale, const Weights& at,
                             const Cells& cells, long k, Particles& p) {
    const long count = long(problem.materials.size()), material = p.material[k];
    const Material& a = problem.materials[material];
    const double V = p.V_p[k], p_p = pressure(a, p.m_p[k] / V, p.e_p[k]);
    const double C = weight_in_cell(a, V, p_p, cells.one_fluid);
    double strain = 0, work = 0, room = 0;
    for_cells(scale, at, [&](long c, double R) {
        strain += R * cells.strain[c];
        work += R * (p_p * cells.work[c] + cells.q_work[c]);
    });
    if (!cells.one_fluid)
        for_cells(scale, at, [&](long c, double R) {
            const double push = R * relaxation * cells.excess[c * count + material];
            strain += push;
            work += push * cells.p[c];
        });
    if (a.p_infinity == 0 && (count > 1 || problem.scheme.confined))
        for_cells(scale, at, [&](long c, double R) { room += R * cells.room[c]; });
    p.V_p[k] *= growth_of_volume(C * strain / V) * (1 + problem.scheme.filling * room);
    return -C * work / p.m_p[k];
}

}  // namespace detail

}  // namespace flip
