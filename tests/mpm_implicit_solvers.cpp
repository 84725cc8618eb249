// The equations of one step of the implicit material point method: matrices of grains and their
// factors, what closed pairs allow, and conjugate gradients among them.
#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/any_theta_step.hpp"

namespace {

using namespace facts;
using Dense = Eigen::MatrixXd;
using Sparse = Eigen::SparseMatrix<double>;

// ---- grains in all positions --------------------------------------------------------------------

struct Situation {
    std::string name;
    Case c;
    double shift;  // of all particles, in cells
    bool turns;    // nothing hinders a rigid rotation
};

// One or two grains on a mesh of h = 0.1: free, at walls, around a periodic mesh, over its ends,
// and with nodes of small mass.
std::vector<Situation> situations(const std::string& shape) {
    std::vector<Situation> all;
    const auto add = [&](const std::string& name, bool turns, double shift,
                         const std::vector<GrainCase>& grains) -> Problem& {
        Case c = case_on(12, 8, 1.2);
        c.shape = shape, c.alpha = 3;
        c.problem.origin_x = -0.37, c.problem.origin_y = 5.2;
        c.problem.grains = grains;
        for (GrainCase& g : c.problem.grains) g.x += c.problem.origin_x, g.y += c.problem.origin_y;
        all.push_back({name, c, shift, turns});
        return all.back().c.problem;
    };
    add("wide", true, 0.03, {box_at("a", 0.6, 0.4, 0.6, 0.3)});
    add("tall", true, 0.03, {box_at("a", 0.6, 0.4, 0.2, 0.5)});
    add("two", false, 0.03, {disk_at("a", 0.35, 0.4, 0.22), box_at("b", 0.8, 0.4, 0.4, 0.3)});
    add("slip", false, 0, {box_at("a", 0.2, 0.2, 0.4, 0.4), box_at("b", 1, 0.55, 0.4, 0.5)})
        .walls = {"slip", "slip", "slip", "slip"};
    add("stick", false, 0, {box_at("a", 0.2, 0.2, 0.4, 0.4), box_at("b", 1, 0.55, 0.4, 0.5)})
        .walls = {"stick", "slip", "slip", "stick"};
    add("ring", false, 0.04, {box_at("a", 0.6, 0.3, 1.2, 0.4)}).periodic_x = true;
    add("over the ends", true, 0.04, {disk_at("a", 0.05, 0.4, 0.25)}).periodic_x = true;
    const double hardly = shape == "linear" ? 0.251 : shape == "gimp" ? 0.03 : -0.22;
    add("small masses", false, hardly, {box_at("a", 0.6, 0.4, 0.6, 0.4)});
    return all;
}

// The start of a step in a situation, with random velocities and stresses.
ThetaRun start(const Situation& s, const ThetaScheme& scheme, bool turning = true) {
    ThetaRun run(s.c, scheme, [&](Assembly& all) {
        disturb(0, 10, 3, all);
        shake(0.1, 4, all);
        const bool walls = s.c.problem.walls[0] != "open";
        Random random(5);
        for (std::size_t k = 0; k < all.particles.x_p.size(); ++k) {
            all.particles.x_p[k] += 0.1 * s.shift, all.particles.y_p[k] += 0.1 * s.shift;
            if (walls || s.name == "small masses") continue;
            all.particles.x_p[k] += 0.004 * random(-1, 1);
            all.particles.y_p[k] += 0.004 * random(-1, 1);
        }
    });
    if (!turning) run.particles().turn_p.assign(run.particles().x_p.size(), 0.0);
    run.begin();
    return run;
}

template <class Work>
void for_each_start(const Work& work, bool turning = true) {
    for (const std::string& shape : shape_names) {
        for (const Situation& s : situations(shape)) {
            for (const char* mass : {"consistent", "lumped"}) {
                CAPTURE(shape);
                CAPTURE(s.name);
                CAPTURE(mass);
                ThetaRun run = start(s, theta_scheme(0.7, mass), turning);
                run.with([&](const auto& of, auto& solver) {
                    solver.prepare(run.scheme, run.body, run.dt, run.nodes);
                    work(s, of, run, solver);
                });
            }
        }
    }
}

// B, which gives all dofs their velocities: ghosts take those of whom they stand for.
Sparse spreading(const GrainNodes& nodes) {
    const long n = nodes.size();
    Dense B = Dense::Identity(2 * n, 2 * n);
    const auto& ghosts = nodes.ghosts();
    for (auto ghost = ghosts.rbegin(); ghost != ghosts.rend(); ++ghost) {
        B.row(ghost->dof) = ghost->part_x * B.row(ghost->master);
        B.row(n + ghost->dof) = ghost->part_y * B.row(n + ghost->master);
        if (ghost->beyond < 0) continue;
        B.row(ghost->dof) -= B.row(ghost->beyond);
        B.row(n + ghost->dof) -= B.row(n + ghost->beyond);
    }
    return B.sparseView();
}

struct ParticleSums {
    Sparse M, K;  // of all dofs, ghosts by themselves
};

// M and K particle by particle, K = V B^T D B with the rows of B those of strain.
template <class Shape>
ParticleSums particle_sums(const Shape& shape, ThetaRun& run) {
    const long n = run.nodes.size();
    std::vector<Eigen::Triplet<double>> M, K;
    const Locator at(run.nodes.mesh());
    const Particles& p = run.particles();
    for (std::size_t g = 0; g < run.grains().size(); ++g) {
        const Grain& grain = run.grains()[g];
        if (grain.rigid) continue;
        const Elastic law =
            std::get<Elastic>(run.laws[static_cast<std::size_t>(grain.material)].law);
        Eigen::Matrix3d D;
        const double P = law.T.lambda + 2 * law.T.G;
        D << P, law.T.lambda, 0, law.T.lambda, P, 0, 0, 0, law.T.G;
        for (long k = grain.begin; k < grain.end; ++k) {
            const auto q = static_cast<std::size_t>(k);
            std::vector<long> dof;
            std::vector<double> S, Gx, Gy;
            for_each_node(shape, at, run.nodes.origins(static_cast<int>(g)), p.x_p[q], p.y_p[q],
                          [&](long s, double w, double x, double y) {
                              const double t = p.turn_p[q], c = 1 / (1 + t * t);  // G_ip
                              dof.push_back(s), S.push_back(w);
                              Gx.push_back(c * (x - t * y)), Gy.push_back(c * (y + t * x));
                          });
            for (std::size_t i = 0; i < dof.size(); ++i) {
                Eigen::Matrix<double, 3, 2> B_i, B_j;
                B_i << Gx[i], 0, 0, Gy[i], Gy[i], Gx[i];
                for (std::size_t j = 0; j < dof.size(); ++j) {
                    B_j << Gx[j], 0, 0, Gy[j], Gy[j], Gx[j];
                    const Eigen::Matrix2d k_ij = p.V_p[q] * B_i.transpose() * D * B_j;
                    for (const long a : {0L, 1L}) {
                        M.emplace_back(a * n + dof[i], a * n + dof[j], p.m_p[q] * S[i] * S[j]);
                        for (const long b : {0L, 1L})
                            K.emplace_back(a * n + dof[i], b * n + dof[j], k_ij(a, b));
                    }
                }
            }
        }
    }
    ParticleSums sums{Sparse(2 * n, 2 * n), Sparse(2 * n, 2 * n)};
    sums.M.setFromTriplets(M.begin(), M.end());
    sums.K.setFromTriplets(K.begin(), K.end());
    return sums;
}

// Random numbers where velocities can change, zero elsewhere.
Vector anything(const Vector& scale, Random& random) {
    Vector v = Vector::Zero(scale.size());
    for (long i = 0; i < v.size(); ++i)
        if (scale[i] > 0) v[i] = random(-1, 1);
    return v;
}

// K v from the two matrices of a step.
template <class Solver>
Vector stiffness_times(const Solver& solver, const ThetaRun& run, Vector v) {
    Vector Av = Vector::Zero(v.size()), Mv = Av;
    solver.matrix.multiply(v, Av);
    solver.matrix.multiply_mass(v, Mv);
    const double theta_dt = run.scheme.theta * run.dt;
    return (Av - Mv) / (theta_dt * theta_dt);
}

// A velocity field on the nodes of all grains.
template <class Field>
Vector on_nodes(const ThetaRun& run, const Field& field) {
    const long n = run.nodes.size();
    Vector v = Vector::Zero(2 * n);
    const Mesh& mesh = run.nodes.mesh();
    for_each_dof(run.nodes, run.state.layout, [&](int, long i, long j, std::size_t dof) {
        const auto [x, y] = field(mesh.x_of(real(i)), mesh.y_of(real(j)));
        const long s = static_cast<long>(dof);
        v[s] = x, v[n + s] = y;
    });
    return v;
}

double total_mass(const Particles& p) {
    double m = 0;
    for (const double one : p.m_p) m += one;
    return m;
}

// ---- grains that meet ---------------------------------------------------------------------------

// Boxes around one place, h = 0.1: two to four grains, a rigid one, walls, grains under force
// control.
std::vector<std::pair<std::string, Case>> contact_cases(const std::string& shape) {
    std::vector<std::pair<std::string, Case>> all;
    const auto add = [&](const std::string& name, double y, std::size_t boxes) -> Problem& {
        Case c = case_on(10, 8, 1);
        c.shape = shape, c.alpha = 2;
        c.problem.contact.friction = 0.5;
        add_material(c, "steel", "rigid", Material{});
        const double x = 0.3;
        c.problem.grains = {box_at("a", x, y, 0.3, 0.2), box_at("b", x + 0.3, y, 0.3, 0.2),
                            box_at("c", x, y + 0.2, 0.3, 0.2),
                            box_at("d", x + 0.3, y + 0.2, 0.3, 0.2)};
        c.problem.grains.resize(boxes);
        all.push_back({name, c});
        return all.back().second.problem;
    };
    const auto plate = [](double x, double y, double width, double height) {
        GrainCase g = box_at("plate", x, y, width, height, 0.1, -0.2);
        g.material = "steel";
        return g;
    };
    add("two", 0.3, 2), add("three", 0.3, 3), add("four", 0.3, 4);
    add("plate", 0.3, 2).grains.push_back(plate(0.45, 0.5, 0.8, 0.2));
    Problem& walls = add("walls", 0.1, 3);
    walls.walls = {"slip", "open", "frictional", "open"}, walls.contact.wall_friction = 0.3;
    walls.origin_x = 0.15;
    Problem& control = add("force control", 0.1, 2);
    control.walls = {"open", "open", "frictional", "open"}, control.contact.wall_friction = 0.3;
    control.grains.push_back(plate(0.45, 0.3, 0.8, 0.2));
    control.grains.back().control = "force_y", control.grains.back().force = -3;
    control.grains.back().damping = 10;
    Problem& controls = add("two force controls", 0.3, 2);
    controls.grains.push_back(plate(0.25, 0.5, 0.2, 0.2));
    controls.grains.back().control = "force_y", controls.grains.back().force = -3;
    controls.grains.push_back(plate(0.85, 0.3, 0.2, 0.2));
    controls.grains.back().control = "force_x", controls.grains.back().force = -5;
    return all;
}

// What closed pairs ask for, in all these cases and with random states.
template <class Work>
void for_each_contact_case(const Work& work) {
    long pairs = 0, crowded = 0;
    for (const std::string& shape : {shape_names[0], shape_names[2]}) {
        for (const auto& meeting : contact_cases(shape)) {
            for (const std::uint64_t seed : {1, 2, 5}) {
                const std::string name = meeting.first;
                CAPTURE(shape);
                CAPTURE(name);
                CAPTURE(seed);
                ThetaRun run(meeting.second, theta_scheme(0.6, seed == 2 ? "lumped" : "consistent"),
                             [&](Assembly& all) {
                                 disturb(0.002, 10, seed, all);
                                 shake(0.1, seed, all);
                             });
                run.begin();
                run.with([&](const auto&, auto& solver) {
                    solver.prepare(run.scheme, run.body, run.dt, run.nodes);
                    Random random(seed + 7);
                    for (ContactPair& pair : solver.set.list.pairs) {
                        const double dice = random();
                        pair.state = dice < 0.2   ? ContactState::open
                                     : dice < 0.5 ? ContactState::slip
                                                  : ContactState::stick;
                    }
                    for (const ContactList::Node& node : solver.set.list.nodes)
                        crowded += node.body_end - node.body_begin > 2;
                    pairs += static_cast<long>(solver.set.list.pairs.size());
                    solver.constraints.build(solver.set, solver.scale(), run.nodes.size(),
                                             solver.force_controls.size(), false);
                    work(run, solver, random);
                });
            }
        }
    }
    CHECK(pairs >= 500);
    CHECK(crowded >= 100);
}

// What a pair is made of: visit(body of the node, part), negative of the first grain.
template <class Visit>
void for_each_part(const ContactPair& pair, const Visit& visit) {
    for (const ContactLink& link : pair.all_links())
        visit(link.a, -link.weight), visit(link.b, link.weight);
}

// How the members of a pair part and slip: the largest that closed pairs do, though they may not.
double forbidden(const ActiveSet& set, const Vector& v, const std::vector<double>& V) {
    const long n = v.size() / 2;
    double most = 0;
    const auto velocity = [&](const ContactBody& is) -> std::array<double, 2> {
        if (!is.is_fixed()) return {v[is.dof], v[n + is.dof]};
        std::array<double, 2> given{is.vx, is.vy};
        if (is.force_control >= 0)
            given[is.control_along_x ? 0 : 1] = V[static_cast<std::size_t>(is.force_control)];
        return given;
    };
    for (const ContactList::Node& node : set.list.nodes) {
        for (std::size_t k = node.pair_begin; k < node.pair_end; ++k) {
            const ContactPair& pair = set.list.pairs[k];
            if (!pair.closed()) continue;
            double x = 0, y = 0;
            for (const ContactLink& link : pair.all_links()) {
                const auto a = velocity(set.list.bodies[node.body_begin + link.a]),
                           b = velocity(set.list.bodies[node.body_begin + link.b]);
                x += link.weight * (b[0] - a[0]), y += link.weight * (b[1] - a[1]);
            }
            most = worst({most, std::fabs(x * pair.nx + y * pair.ny)});
            if (pair.state == ContactState::stick)
                most = worst({most, std::fabs(y * pair.nx - x * pair.ny)});
        }
    }
    return most;
}

// H^T lambda on the dofs that move, and on grains under force control.
Vector impulses_on(const ActiveSet& set, const Vector& scale, std::vector<double>& plates) {
    const long n = scale.size() / 2;
    Vector sum = Vector::Zero(2 * n);
    std::fill(plates.begin(), plates.end(), 0.0);
    for (const ContactList::Node& node : set.list.nodes) {
        for (std::size_t k = node.pair_begin; k < node.pair_end; ++k) {
            const ContactPair& pair = set.list.pairs[k];
            if (!pair.closed()) continue;
            const double t = pair.state == ContactState::stick ? pair.lambda_t : 0,
                         jx = pair.lambda_n * pair.nx - t * pair.ny,
                         jy = pair.lambda_n * pair.ny + t * pair.nx;
            for_each_part(pair, [&](int who, double part) {
                const ContactBody& is = set.list.bodies[node.body_begin + who];
                if (is.force_control >= 0)
                    plates[static_cast<std::size_t>(is.force_control)] +=
                        part * (is.control_along_x ? jx : jy);
                if (is.is_fixed()) return;
                if (scale[is.dof] > 0) sum[is.dof] += part * jx;
                if (scale[n + is.dof] > 0) sum[n + is.dof] += part * jy;
            });
        }
    }
    return sum;
}

// The same equations without any cleverness: all velocities that can change, those of plates, and
// the rows of all closed pairs, dense.
struct Kkt {
    std::vector<long> dofs;
    Dense A, H;
    Vector b, h;
    double off = 0;  // how well the solution obeys
    /// v, then the velocities of the plates.
    Vector solve() {
        const long m = A.rows(), rows = H.rows();
        const Vector d = A.diagonal().cwiseSqrt().cwiseInverse();
        Dense all = Dense::Zero(m + rows, m + rows);
        all.topLeftCorner(m, m) = d.asDiagonal() * A * d.asDiagonal();
        all.bottomLeftCorner(rows, m) = H * d.asDiagonal();
        all.topRightCorner(m, rows) = all.bottomLeftCorner(rows, m).transpose();
        Vector right(m + rows);
        right << d.cwiseProduct(b), h;
        const Vector x = all.completeOrthogonalDecomposition().solve(right);
        off = (all * x - right).norm() / right.norm();
        return d.cwiseProduct(x.head(m));
    }
};

template <class Solver>
Kkt kkt_of(const ThetaRun& run, const Solver& solver, const Vector& b,
           const ControlledGrains& controlled) {
    Kkt kkt;
    const long n = run.nodes.size();
    const auto count = static_cast<long>(controlled.V.size());
    std::vector<long> number(static_cast<std::size_t>(2 * n), -1);
    for (long i = 0; i < 2 * n; ++i)
        if (solver.scale()[i] > 0) {
            number[static_cast<std::size_t>(i)] = static_cast<long>(kkt.dofs.size());
            kkt.dofs.push_back(i);
        }
    const long m = static_cast<long>(kkt.dofs.size());
    kkt.A = Dense::Zero(m + count, m + count), kkt.b = Vector::Zero(m + count);
    Vector x(2 * n), y = Vector::Zero(2 * n);
    for (long j = 0; j < m; ++j) {
        x.setZero(), x[kkt.dofs[static_cast<std::size_t>(j)]] = 1;
        solver.matrix.multiply(x, y);
        for (long i = 0; i < m; ++i) kkt.A(i, j) = y[kkt.dofs[static_cast<std::size_t>(i)]];
        kkt.b[j] = b[kkt.dofs[static_cast<std::size_t>(j)]];
    }
    for (long s = 0; s < count; ++s) {
        kkt.A(m + s, m + s) = controlled.diagonal[static_cast<std::size_t>(s)];
        kkt.b[m + s] = controlled.b[static_cast<std::size_t>(s)];
    }
    std::vector<Vector> rows;
    std::vector<double> right;
    for (const ContactList::Node& node : solver.set.list.nodes) {
        for (std::size_t k = node.pair_begin; k < node.pair_end; ++k) {
            const ContactPair& pair = solver.set.list.pairs[k];
            for (const bool across : {false, true}) {
                if (!pair.closed() || (across && pair.state != ContactState::stick)) continue;
                const double nx = across ? -pair.ny : pair.nx, ny = across ? pair.nx : pair.ny;
                Vector row = Vector::Zero(m + count);
                double given = 0;
                for_each_part(pair, [&](int who, double part) {
                    const ContactBody& is = solver.set.list.bodies[node.body_begin + who];
                    if (is.is_fixed()) {
                        const bool x_is_free = is.force_control >= 0 && is.control_along_x,
                                   y_is_free = is.force_control >= 0 && !is.control_along_x;
                        if (x_is_free) row[m + is.force_control] += part * nx;
                        if (y_is_free) row[m + is.force_control] += part * ny;
                        given +=
                            part * ((x_is_free ? 0 : is.vx * nx) + (y_is_free ? 0 : is.vy * ny));
                        return;
                    }
                    const long at_x = number[static_cast<std::size_t>(is.dof)],
                               at_y = number[static_cast<std::size_t>(n + is.dof)];
                    if (at_x >= 0) row[at_x] += part * nx;
                    if (at_y >= 0) row[at_y] += part * ny;
                });
                rows.push_back(row), right.push_back(-given);
            }
        }
    }
    kkt.H = Dense(static_cast<long>(rows.size()), m + count);
    kkt.h = Vector(kkt.H.rows());
    for (long r = 0; r < kkt.H.rows(); ++r)
        kkt.H.row(r) = rows[static_cast<std::size_t>(r)],
        kkt.h[r] = right[static_cast<std::size_t>(r)];
    return kkt;
}

template <class Solver>
ControlledGrains controlled_of(const ThetaRun& run, const Solver& solver) {
    ControlledGrains controlled;
    for (const ForceControl& control : solver.force_controls) {
        controlled.diagonal.push_back(run.scheme.theta * (control.mass + run.dt * control.damping));
        controlled.b.push_back(run.scheme.theta *
                               (control.mass * control.velocity + run.dt * control.force));
        controlled.V.push_back(0.3);
    }
    return controlled;
}

// Conjugate gradients from a guess, with or without the factors of grains.
template <class Solver>
CgResult find(ThetaRun& run, Solver& solver, const char* preconditioner, const Vector& b,
              double tolerance, long most, Vector& v, ControlledGrains& controlled,
              CgWorkspace& work) {
    ThetaScheme scheme = run.scheme;
    scheme.preconditioner = preconditioner;
    solver.use_preconditioner(scheme, run.grains(), run.nodes);
    const auto multiply = [&](Vector& x, Vector& y) { solver.matrix.multiply(x, y); };
    work.resize(run.nodes.size());
    return projected_cg(multiply, solver.preconditioner(solver.constraints), solver.constraints,
                        solver.scale(), b, tolerance, most, v, controlled, work);
}

}  // namespace

// ---- matrices -----------------------------------------------------------------------------------

TEST_CASE("the product with a stencil is the sum over particles") {
    double worst_A = 0, worst_M = 0, worst_diagonal = 0;
    for_each_start([&](const Situation&, const auto& shape, ThetaRun& run, auto& solver) {
        const long n = run.nodes.size();
        const ParticleSums sums = particle_sums(shape, run);
        const Sparse B = spreading(run.nodes);
        Sparse M = B.transpose() * sums.M * B;
        if (!run.scheme.consistent()) {
            Vector lumped(2 * n);
            for (long i = 0; i < 2 * n; ++i)
                lumped[i] = run.nodes.sums[static_cast<std::size_t>(i % n)].m;
            M = Dense(lumped.asDiagonal()).sparseView();
        }
        const double theta_dt = 0.7 * run.dt;
        const Sparse BKB = B.transpose() * sums.K * B, A = M + theta_dt * theta_dt * BKB;
        Random random(1);
        for (int k = 0; k < 3; ++k) {
            Vector x = anything(solver.scale(), random), y = Vector::Zero(2 * n);
            const Vector from = x;
            solver.matrix.multiply(x, y);
            const Vector Ax = A * from, Mx = M * from;
            worst_A = worst({worst_A, (y - Ax).norm() / Ax.norm()});
            x = from;
            solver.matrix.multiply_mass(x, y);
            worst_M = worst({worst_M, (y - Mx).norm() / Mx.norm()});
        }
        // The diagonals of all dofs that stand for one, together.
        Vector d = Vector::Zero(2 * n), whole = Vector::Zero(2 * n);
        solver.matrix.diagonal(d);
        const bool consistent = run.scheme.consistent();
        for (long j = 0; j < 2 * n; ++j)
            for (Sparse::InnerIterator b(B, j); b; ++b)
                whole[j] += b.value() * b.value() *
                            (theta_dt * theta_dt * sums.K.coeff(b.row(), b.row()) +
                             (consistent ? sums.M.coeff(b.row(), b.row()) : 0));
        if (!consistent) whole += M.diagonal();
        for (long i = 0; i < 2 * n; ++i)
            if (solver.scale()[i] > 0)
                worst_diagonal = worst({worst_diagonal, std::fabs(d[i] / whole[i] - 1),
                                        std::fabs(solver.scale()[i] * std::sqrt(d[i]) - 1)});
    });
    CHECK(worst_A <= 1e-14);
    CHECK(worst_M <= 1e-14);
    CHECK(worst_diagonal <= 1e-13);
}

TEST_CASE("the matrices of a step are symmetric and positive") {
    double worst_A = 0, worst_M = 0, least = 1e300;
    for_each_start([&](const Situation&, const auto&, ThetaRun& run, auto& solver) {
        const long n = run.nodes.size();
        Random random(2);
        for (int k = 0; k < 5; ++k) {
            Vector x = anything(solver.scale(), random), y = anything(solver.scale(), random),
                   Ax = Vector::Zero(2 * n), Ay = Ax, Mx = Ax, My = Ax;
            const Vector x_only = x, y_only = y;
            solver.matrix.multiply(x, Ax), solver.matrix.multiply(y, Ay);
            x = x_only, y = y_only;
            solver.matrix.multiply_mass(x, Mx), solver.matrix.multiply_mass(y, My);
            worst_A = worst({worst_A, std::fabs(x_only.dot(Ay) - y_only.dot(Ax)) /
                                          (x_only.norm() * Ay.norm())});
            worst_M = worst({worst_M, std::fabs(x_only.dot(My) - y_only.dot(Mx)) /
                                          (x_only.norm() * My.norm())});
            least = std::min({least, x_only.dot(Ax), x_only.dot(Mx)});
        }
    });
    CHECK(worst_A <= 1e-14);
    CHECK(worst_M <= 1e-14);
    CHECK(least > 0);
}

TEST_CASE("the mass matrix weighs a translation with the mass") {
    double off = 0;
    for_each_start([&](const Situation& s, const auto&, ThetaRun& run, auto& solver) {
        if (s.c.problem.walls[0] != "open") return;
        const long n = run.nodes.size();
        Vector x = on_nodes(run,
                            [](double, double) {
                                return std::array{1.0, 0.0};
                            }),
               y = Vector::Zero(2 * n);
        solver.matrix.multiply_mass(x, y);
        double nodes = 0;
        for (const NodeSums& sum : run.nodes.sums) nodes += sum.m;
        const double m = total_mass(run.particles());
        off = worst({off, std::fabs(y.head(n).sum() / m - 1), std::fabs(nodes / m - 1),
                     y.tail(n).cwiseAbs().maxCoeff<Eigen::PropagateNaN>() / m});
        // Row by row: sum_j M_ij = m_i.
        for (long i = 0; i < n; ++i)
            off = worst({off, std::fabs(y[i] - run.nodes.sums[static_cast<std::size_t>(i)].m) / m});
    });
    CHECK(off <= 1e-13);
}

TEST_CASE("with the lumped mass the velocity of a node is momentum over mass without iteration") {
    long lumped = 0, consistent = 0;
    for_each_start([&](const Situation&, const auto&, ThetaRun& run, auto&) {
        (run.scheme.consistent() ? consistent : lumped) += run.sums.solver.mass_iterations;
    });
    CHECK(lumped == 0);
    CHECK(consistent > 0);
}

TEST_CASE("rigid motions meet no stiffness") {
    double off = 0;
    long turned = 0;
    for_each_start(
        [&](const Situation& s, const auto&, ThetaRun& run, auto& solver) {
            if (s.c.problem.walls[0] != "open") return;
            const auto stretch = [](double x, double y) { return std::array{x - y, y}; };
            const double size = stiffness_times(solver, run, on_nodes(run, stretch)).norm();
            CHECK(size > 100);
            const auto still = [&](const auto& field) {
                off =
                    worst({off, stiffness_times(solver, run, on_nodes(run, field)).norm() / size});
            };
            still([](double, double) { return std::array{1.0, 0.0}; });
            still([](double, double) { return std::array{0.0, 1.0}; });
            if (!s.turns) return;
            still([](double x, double y) { return std::array{-(y - 5.6), x - 0.2}; });
            ++turned;
        },
        false);
    CHECK(off <= 1e-12);
    CHECK(turned >= 6);
}

TEST_CASE("the force at the level theta of an elastic grain is f_0 less theta dt K v") {
    double off = 0;
    for_each_start([&](const Situation&, const auto& shape, ThetaRun& run, auto& solver) {
        const long n = run.nodes.size();
        Random random(3);
        const Vector v = anything(solver.scale(), random);
        const auto force = [&](const Vector& at) {
            Vector all = at;
            fill_ghosts(run.nodes, all);
            for (long i = 0; i < n; ++i) {
                NodeMotion& motion = run.nodes.motion[static_cast<std::size_t>(i)];
                motion.vx_1 = all[i], motion.vy_1 = all[n + i];
            }
            force_at_theta(shape, run.laws, run.scheme, run.dt, run.grains(), run.particles(),
                           run.nodes);
            Vector f(2 * n);
            for (long i = 0; i < n; ++i) {
                f[i] = run.nodes.force[static_cast<std::size_t>(i)].x;
                f[n + i] = run.nodes.force[static_cast<std::size_t>(i)].y;
            }
            return f;
        };
        const Vector f_0 = force(Vector::Zero(2 * n)), f = force(v),
                     Kv = stiffness_times(solver, run, v);
        CHECK(f_0.norm() > 1);
        off = worst({off, (f - (f_0 - 0.7 * run.dt * Kv)).norm() / f.norm()});
    });
    CHECK(off <= 1e-13);
}

TEST_CASE("tying light nodes keeps mass and momentum") {
    long constraints = 0;
    for_each_start([&](const Situation& s, const auto& shape, ThetaRun& run, auto&) {
        const long n = run.nodes.size();
        particles_to_grid(shape, run.particles(), run.nodes);
        const auto total = [&] {
            NodeSums sum{};
            for (const NodeSums& one : run.nodes.sums)
                sum.m += one.m, sum.px += one.px, sum.py += one.py, sum.mx += one.mx,
                    sum.my += one.my, sum.V += one.V, sum.gx += one.gx, sum.gy += one.gy;
            return sum;
        };
        const NodeSums before = total();
        double least = 1e300, most = 0;
        const std::size_t ghosts = run.nodes.ghosts().size();
        constrain_small_mass_nodes(grid_rows(run.grains(), run.nodes, run.state.layout), {}, 1e-2,
                                   Neighbors::all, run.nodes);
        const NodeSums after = total();
        const double m = before.m;
        CHECK(worst({std::fabs(after.m - m), std::fabs(after.px - before.px),
                     std::fabs(after.py - before.py), std::fabs(after.mx - before.mx),
                     std::fabs(after.my - before.my) / 5}) <= 1e-13 * m);
        CHECK(worst({std::fabs(after.V - before.V), 0.01 * std::fabs(after.gx - before.gx),
                     0.01 * std::fabs(after.gy - before.gy)}) <= 1e-14);
        const long now = static_cast<long>(run.nodes.ghosts().size() - ghosts);
        if (s.name == "small masses") CHECK(now >= 5);
        constraints += now;
        // A constrained node carries nothing, and has the velocity of its master.
        for (std::size_t k = ghosts; k < run.nodes.ghosts().size(); ++k)
            CHECK(run.nodes.sums[static_cast<std::size_t>(run.nodes.ghosts()[k].dof)].m == 0);
        for (long i = 0; i < n; ++i) {
            const double mass = run.nodes.sums[static_cast<std::size_t>(i)].m;
            if (mass > run.nodes.least_mass())
                least = std::min(least, mass), most = std::max(most, mass);
        }
        if (s.name == "small masses") CHECK(least >= 1e-4 * most);
    });
    CHECK(constraints >= 50);
}

TEST_CASE("a grain that moves along takes the same step") {
    for (const std::string& shape : shape_names) {
        for (const Situation& s : situations(shape)) {
            if (s.c.problem.walls[0] != "open") continue;
            CAPTURE(shape);
            CAPTURE(s.name);
            for (const char* mass : {"consistent", "lumped"}) {
                const auto velocities = [&](double u, double w) {
                    ThetaRun run(s.c, theta_scheme(0.6, mass), [&](Assembly& all) {
                        disturb(0, 10, 3, all);
                        shake(0.1, 4, all);
                        for (std::size_t k = 0; k < all.particles.x_p.size(); ++k) {
                            all.particles.x_p[k] += 0.1 * s.shift;
                            all.particles.y_p[k] += 0.1 * s.shift;
                            all.particles.vx_p[k] += u, all.particles.vy_p[k] += w;
                        }
                    });
                    run.advance();
                    return run;
                };
                ThetaRun one = velocities(0, 0), two = velocities(1.5, -0.7);
                const Particles &p = one.particles(), &q = two.particles();
                double off = 0;
                for (std::size_t k = 0; k < p.x_p.size(); ++k)
                    off = worst({off, std::fabs(q.vx_p[k] - p.vx_p[k] - 1.5),
                                 std::fabs(q.vy_p[k] - p.vy_p[k] + 0.7),
                                 1e-3 * std::fabs(q.sxx_p[k] - p.sxx_p[k])});
                CHECK(off <= 1e-10);
            }
        }
    }
}

// ---- factors of grains --------------------------------------------------------------------------

TEST_CASE("the velocity of a dof is made of those that its ghosts say") {
    long lines = 0;
    for_each_start([&](const Situation& s, const auto&, ThetaRun& run, auto&) {
        const long n = run.nodes.size();
        const Dense B = spreading(run.nodes);
        const MasterDofs masters(run.nodes);
        for (long i = 0; i < n; ++i) {
            Vector x = B.row(i).head(n).transpose(), y = B.row(n + i).tail(n).transpose();
            for (const MasterDofs::Share& share : masters.of_dof(i)) {
                x[share.dof] -= share.x, y[share.dof] -= share.y;
                if (s.c.problem.walls[0] == "open") CHECK(share.mass == share.x);
                lines += share.x == 2;
            }
            CHECK((x.norm() == 0 && y.norm() == 0));
        }
    });
    CHECK(lines >= 50);
}

TEST_CASE("the factors of a grain undo its matrix") {
    double off = 0, left = 0;
    for_each_start([&](const Situation&, const auto&, ThetaRun& run, auto& solver) {
        const long n = run.nodes.size();
        GrainFactors factors;
        factors.factorize(solver.matrix, solver.scale(), run.grains(), run.nodes);
        Random random(7);
        for (int k = 0; k < 3; ++k) {
            const Vector x = anything(solver.scale(), random);
            Vector copy = x, r = Vector::Zero(2 * n), z = r, back = r;
            solver.matrix.multiply(copy, r);
            factors.solve(r, z);
            for (long i = 0; i < 2 * n; ++i)
                if (solver.scale()[i] == 0) CHECK(z[i] == 0);
            off = worst({off, (z - x).norm() / x.norm()});
            copy = z;
            solver.matrix.multiply(copy, back);
            for (long i = 0; i < 2 * n; ++i)
                if (solver.scale()[i] == 0) back[i] = r[i];
            left = worst({left, (back - r).norm() / r.norm()});
        }
    });
    // They are kept in single precision.
    CHECK(off <= 5e-6);
    CHECK(left <= 1e-6);
}

// ---- what closed pairs allow --------------------------------------------------------------------

TEST_CASE("the projection is orthogonal and needs to be done once") {
    double again = 0, across = 0, skew = 0;
    for_each_contact_case([&](ThetaRun&, auto& solver, Random& random) {
        const Constraints& allowed = solver.constraints;
        const Vector x = anything(solver.scale(), random), y = anything(solver.scale(), random);
        Vector Px = x, Py = y;
        allowed.project(Px), allowed.project(Py);
        Vector twice = Px;
        allowed.project(twice);
        CHECK((Px - x).norm() > 1e-3 * x.norm());
        again = worst({again, (twice - Px).norm() / x.norm()});
        across = worst({across, std::fabs((x - Px).dot(Px)) / x.squaredNorm()});
        skew = worst({skew, std::fabs(x.dot(Py) - y.dot(Px)) / (x.norm() * y.norm())});
        // Velocities that are left take no pair apart; fixed ones would have none.
        ActiveSet at_rest = solver.set;
        for (ContactBody& is : at_rest.list.bodies) is.vx = is.vy = 0;
        const Vector v = solver.scale().cwiseProduct(Px);
        const std::vector<double> none(solver.force_controls.size(), 0.0);
        across = worst(
            {across, forbidden(at_rest, v, none) / v.cwiseAbs().maxCoeff<Eigen::PropagateNaN>()});
    });
    CHECK(again <= 1e-14);
    CHECK(across <= 1e-13);
    CHECK(skew <= 1e-14);
}

TEST_CASE("enforced velocities part and slip at no closed pair and change as little as possible") {
    double left = 0, more = 0;
    for_each_contact_case([&](ThetaRun&, auto& solver, Random& random) {
        std::vector<double> V(solver.force_controls.size());
        for (double& one : V) one = random(-1, 1);
        const Vector u = anything(solver.scale(), random);
        Vector v = u;
        CHECK(forbidden(solver.set, v, V) > 0.1);
        solver.constraints.enforce(V, v);
        left = worst({left, forbidden(solver.set, v, V)});
        // (v - u) . D w = 0 for every w that the pairs allow.
        Vector y = anything(solver.scale(), random);
        solver.constraints.project(y);
        double sum = 0, size = 0;
        for (long i = 0; i < u.size(); ++i) {
            const double s = solver.scale()[i];
            if (s == 0) CHECK(v[i] == 0);
            if (s == 0) continue;
            sum += (v[i] - u[i]) / s * y[i], size += std::fabs((v[i] - u[i]) / s * y[i]);
        }
        more = worst({more, std::fabs(sum) / size});
    });
    CHECK(left <= 1e-13);
    CHECK(more <= 1e-13);
}

TEST_CASE("impulses are found whose sum on every node is what is left of its equation") {
    double off = 0;
    long redundant = 0;
    for_each_contact_case([&](ThetaRun&, auto& solver, Random& random) {
        ActiveSet set = solver.set;
        for (ContactPair& pair : set.list.pairs)
            pair.lambda_n = random(-1, 1), pair.lambda_t = random(-1, 1);
        std::vector<double> push(solver.force_controls.size());
        const Vector Hl = impulses_on(set, solver.scale(), push);
        const ActiveSet parameters = set;
        for (ContactPair& pair : set.list.pairs) pair.lambda_n = pair.lambda_t = 1e3;
        solver.constraints.find_impulses(-Hl, set);
        const Vector found = impulses_on(set, solver.scale(), push);
        off = worst({off, (found - Hl).cwiseAbs().maxCoeff<Eigen::PropagateNaN>()});
        for (std::size_t k = 0; k < set.list.pairs.size(); ++k) {
            const ContactPair& pair = set.list.pairs[k];
            if (!pair.closed()) CHECK((pair.lambda_n == 0 && pair.lambda_t == 0));
            // Slip has the friction that it was given.
            if (pair.state == ContactState::slip) CHECK(pair.lambda_t == 1e3);
            redundant += std::fabs(pair.lambda_n - parameters.list.pairs[k].lambda_n) > 1e-6;
        }
    });
    CHECK(off <= 1e-11);
    CHECK(redundant >= 10);
}

TEST_CASE("a pull far below the largest impulse is round-off and opens no pair") {
    const double accuracy = 1e-12, largest = 1e6;  // impulses are known to 1e3 times that
    for_each_contact_case([&](ThetaRun& run, auto& solver, Random&) {
        ActiveSet& set = solver.set;
        const Vector at_rest = Vector::Zero(2 * run.nodes.size());
        const std::vector<double> V(solver.force_controls.size(), 0.0);
        for (const bool rubs : {false, true}) {
            for (const double pull : {0.5e-9, 2e-9}) {
                for (ContactPair& pair : set.list.pairs) {
                    pair.state = ContactState::slip, pair.mu = 0;
                    pair.lambda_n = -pull * largest, pair.lambda_t = 0;
                }
                ContactPair& first = set.list.pairs.front();
                (rubs ? first.lambda_t : first.lambda_n) = largest;
                update_active_set(at_rest, V, run.nodes, accuracy, set);
                const auto begin = set.list.pairs.begin() + 1, end = set.list.pairs.end();
                const auto closed = std::count_if(
                    begin, end, [](const ContactPair& pair) { return pair.closed(); });
                CHECK(closed == (pull < 1e-9 ? end - begin : 0));
            }
        }
    });
}

TEST_CASE("a pair that has changed twice gives up its friction before it opens") {
    for_each_contact_case([&](ThetaRun& run, auto& solver, Random&) {
        ActiveSet& set = solver.set;
        const std::vector<double> V(solver.force_controls.size(), 0.0);
        for (const int changes : {0, 1, 2, 3}) {
            for (const double friction : {0.0, 0.5}) {
                for (std::size_t k = 0; k < set.list.pairs.size(); ++k) {
                    ContactPair& pair = set.list.pairs[k];
                    pair.state = ContactState::slip, pair.lambda_n = -1, pair.lambda_t = friction;
                    set.updates[k].changes = changes;
                }
                update_active_set(Vector::Zero(2 * run.nodes.size()), V, run.nodes, 1e-12, set);
                const bool opens = changes < 2 || friction == 0;
                for (const ContactPair& pair : set.list.pairs) CHECK(pair.closed() == !opens);
            }
        }
    });
}

TEST_CASE(
    "friction that changes the pressure that makes it is found in one more solution than pairs") {
    Random random(7);
    for (int again = 0; again < 20; ++again) {
        constexpr int count = 5;
        ActiveSet set;
        set.list.pairs.resize(count), set.updates.resize(count);
        // g(x) = x* + G (x - x*): the plain iteration x <- g(x) grows by a half and more.
        Eigen::MatrixXd G = -1.5 * Eigen::MatrixXd::Identity(count, count);
        Eigen::VectorXd exact(count), x = Eigen::VectorXd::Zero(count);
        for (int k = 0; k < count; ++k) {
            exact[k] = random(1, 2);
            for (int j = 0; j < count; ++j) G(k, j) += random(-0.1, 0.1);
            set.list.pairs[k].state = ContactState::slip;
        }
        for (int solution = 0; solution <= count + 1; ++solution) {
            const Eigen::VectorXd g = exact + G * (x - exact);
            for (int k = 0; k < count; ++k)
                set.list.pairs[k].lambda_t = x[k], set.updates[k].target = g[k];
            extrapolate_friction(true, set);
            for (int k = 0; k < count; ++k) x[k] = set.updates[k].friction;
        }
        CHECK((x - exact).norm() <= 1e-9);
    }
}

TEST_CASE("a plate that a force drives takes along whom it presses") {
    double off = 0;
    long plates = 0;
    for_each_contact_case([&](ThetaRun&, auto& solver, Random& random) {
        const std::size_t count = solver.force_controls.size();
        if (count == 0) return;
        const Constraints& allowed = solver.constraints;
        const Vector u = anything(solver.scale(), random);
        std::vector<double> V(count), none(count, 0.0), felt(count), weight(count);
        for (double& one : V) one = random(-1, 1);
        Vector with = u, without = u, added = Vector::Zero(u.size());
        allowed.enforce(V, with), allowed.enforce(none, without);
        allowed.add_controlled_motion(V.data(), added);
        off = worst({off, (with - without - added).cwiseAbs().maxCoeff<Eigen::PropagateNaN>()});
        allowed.controlled_diagonal(weight.data());
        const Vector r = anything(solver.scale(), random);
        allowed.controlled_force(r, felt.data());
        for (std::size_t s = 0; s < count; ++s) {
            std::vector<double> one(count, 0.0);
            one[s] = 1;
            Vector e = Vector::Zero(u.size());
            allowed.add_controlled_motion(one.data(), e);
            double square = 0;
            for (long i = 0; i < e.size(); ++i)
                if (solver.scale()[i] > 0) square += std::pow(e[i] / solver.scale()[i], 2);
            // A plate that no closed pair touches takes nobody along.
            const ContactList& all = solver.set.list;
            bool presses = false;
            for (const ContactList::Node& node : all.nodes)
                for (std::size_t k = node.pair_begin; k < node.pair_end; ++k)
                    for (const ContactLink& link : all.pairs[k].all_links())
                        for (const int who : {link.a, link.b})
                            presses = presses ||
                                      (all.pairs[k].closed() &&
                                       all.bodies[node.body_begin + who].force_control == int(s));
            CHECK(presses == (weight[s] > 0.1));
            if (!presses) {
                CHECK((weight[s] == 0 && square == 0 && felt[s] == 0));
                continue;
            }
            off = worst(
                {off, std::fabs(weight[s] / square - 1), std::fabs(felt[s] - e.dot(r)) / e.norm()});
            ++plates;
        }
    });
    CHECK(off <= 1e-12);
    CHECK(plates >= 10);
}

// ---- conjugate gradients among them -------------------------------------------------------------

TEST_CASE("conjugate gradients among closed pairs solve what a dense solver does") {
    double off = 0, apart = 0, left = 0;
    long iterations = 0, with_factors = 0;
    for_each_contact_case([&](ThetaRun& run, auto& solver, Random& random) {
        Vector b = solver.right_hand_side();
        const double size = b.norm() / std::sqrt(real(b.size()));
        b += size * anything(solver.scale(), random);
        ControlledGrains controlled = controlled_of(run, solver);
        Kkt kkt = kkt_of(run, solver, b, controlled);
        const Vector exact = kkt.solve();
        REQUIRE(kkt.off <= 1e-11);
        for (const char* preconditioner : {"diagonal", "grains"}) {
            Vector v = Vector::Zero(b.size());
            controlled = controlled_of(run, solver);
            solver.constraints.enforce(controlled.V, v);
            CgWorkspace work;
            const CgResult cg =
                find(run, solver, preconditioner, b, 1e-13, 5000, v, controlled, work);
            CHECK(cg.converged);
            CHECK(cg.iterations > 0);
            (std::string(preconditioner) == "grains" ? with_factors : iterations) += cg.iterations;
            const double fast = exact.cwiseAbs().maxCoeff();
            for (std::size_t k = 0; k < kkt.dofs.size(); ++k)
                off = worst({off, std::fabs(v[kkt.dofs[k]] - exact[static_cast<long>(k)]) / fast});
            for (std::size_t s = 0; s < controlled.V.size(); ++s)
                off = worst({off, std::fabs(controlled.V[s] -
                                            exact[static_cast<long>(kkt.dofs.size() + s)]) /
                                      fast});
            apart = worst({apart, forbidden(solver.set, v, controlled.V) / fast});
            // Impulses make up for what is left.
            ActiveSet set = solver.set;
            for (ContactPair& pair : set.list.pairs) pair.lambda_t = 0;
            solver.constraints.find_impulses(work.r, set);
            std::vector<double> push(controlled.V.size());
            const Vector Hl = impulses_on(set, solver.scale(), push);
            Vector y = Vector::Zero(b.size()), copy = v;
            solver.matrix.multiply(copy, y);
            for (long i = 0; i < b.size(); ++i)
                if (solver.scale()[i] > 0)
                    left = worst({left, std::fabs(y[i] - b[i] - Hl[i]) * solver.scale()[i] /
                                            solver.scale().cwiseProduct(b).norm()});
            for (std::size_t s = 0; s < push.size(); ++s)
                left = worst({left, std::fabs(controlled.diagonal[s] * controlled.V[s] -
                                              controlled.b[s] - push[s]) /
                                        (std::fabs(controlled.b[s]) + std::fabs(push[s]))});
        }
    });
    CHECK(off <= 1e-11);
    CHECK(apart <= 1e-12);
    CHECK(left <= 1e-12);
    CHECK(with_factors <= iterations);
}

TEST_CASE("conjugate gradients know a solution when they see one and say when they have none") {
    for_each_contact_case([&](ThetaRun& run, auto& solver, Random&) {
        const Vector& b = solver.right_hand_side();
        for (const char* preconditioner : {"diagonal", "grains"}) {
            CgWorkspace work;
            Vector v = Vector::Zero(b.size());
            ControlledGrains controlled = controlled_of(run, solver);
            solver.constraints.enforce(controlled.V, v);
            // Too few iterations.
            CgResult cg = find(run, solver, preconditioner, b, 1e-13, 1, v, controlled, work);
            CHECK(!cg.converged);
            CHECK(cg.iterations == 1);
            CHECK(cg.residual > 1e-13);
            cg = find(run, solver, preconditioner, b, 1e-13, 5000, v, controlled, work);
            CHECK(cg.converged);
            CHECK(cg.residual <= 1e-12);
            // From the solution.
            const Vector found = v;
            const std::vector<double> V = controlled.V;
            cg = find(run, solver, preconditioner, b, 1e-12, 5000, v, controlled, work);
            CHECK(cg.converged);
            CHECK(cg.iterations == 0);
            CHECK((v - found).norm() == 0);
            CHECK(controlled.V == V);
        }
        // Nothing moves where nothing is moved.
        ActiveSet& set = solver.set;
        for (ContactBody& is : set.list.bodies) is.vx = is.vy = 0;
        solver.constraints.build(set, solver.scale(), run.nodes.size(),
                                 solver.force_controls.size(), false);
        Vector v = Vector::Zero(b.size());
        ControlledGrains controlled = controlled_of(run, solver);
        for (double& one : controlled.b) one = 0;
        for (double& one : controlled.V) one = 0;
        CgWorkspace work;
        const CgResult cg =
            find(run, solver, "grains", Vector::Zero(b.size()), 1e-13, 50, v, controlled, work);
        CHECK(cg.converged);
        CHECK(cg.iterations == 0);
        CHECK(v.norm() == 0);
    });
}

TEST_CASE("a step that is not solved ends the run with the reason") {
    // Less friction is advised above 2.
    ActiveSet set;
    set.list.pairs.resize(1);
    for (const double mu : {0.0, 2.0, 2.1}) {
        set.list.pairs[0].mu = mu;
        CHECK((set.advice().find("less friction") != std::string::npos) == (mu > 2));
    }
    Case c = case_on(24, 12, 1.2);
    c.alpha = 3, c.problem.contact.friction = 0.4;
    c.problem.grains = {disk_at("left", 0.4, 0.3, 0.2, 0.1, 0.05),
                        disk_at("right", 0.8, 0.32, 0.2, -0.1)};
    for (const char* solver : {"projected_cg", "newton_krylov"}) {
        ThetaScheme few = theta_scheme(0.5, "lumped", solver);
        few.max_outer_iterations = 1;
        ThetaRun run(c, few, [](Assembly& all) { shake(0.1, 1, all); });
        CHECK_THROWS_AS(run.advance(20), common::NumericalError);
        few = theta_scheme(0.5, "consistent", solver);
        few.max_iterations = 1;
        ThetaRun again(c, few, [](Assembly& all) { shake(0.1, 1, all); });
        CHECK_THROWS_AS(again.advance(5), common::NumericalError);
    }
}
