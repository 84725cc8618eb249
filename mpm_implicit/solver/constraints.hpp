// Constraints of the closed pairs: the velocities that they allow, and projection on them.
//
// A closed pair asks for (v_b - v_a).n = 0, one that sticks for the same across. With D the
// diagonal of the matrix and y = D^{1/2} v, the rows of all pairs of one node, or run of nodes, are
// made orthonormal, q_k, so that projection on their null space takes a few products for each:
//     y <- y - sum_k q_k (q_k . y - g_k)
// g_k comes from bodies whose velocity is given. A grain under force control has a velocity of its
// own, V: then g_k = g_k^0 + g_k^V V, and the space is spanned by one more vector per such grain,
// e_V. Different nodes share no dof, so that projection is exact whatever the number of pairs.
#pragma once

#include "mpm_implicit/solver/active_set.hpp"

namespace mpm_implicit {

class Constraints {
   public:
    /// Takes the rows of all closed pairs.
    /// in:     scale, D^{-1/2} of every dof, 0 where the velocity cannot change; only_bonds: leave
    ///         out pairs that merely press
    void build(const ActiveSet& set, const Vector& scale, long size, std::size_t force_controls,
               bool only_bonds) {
        contacts_ = &set.list, scale_ = &scale, size_ = size, rights_ = force_controls + 1;
        rows_.clear(), basis_.clear(), right_.clear(), factor_.clear(), blocks_.clear();
        for (std::size_t n = 0; n < set.list.nodes.size(); ++n) {
            Block block{n, rows_.size(), 0, basis_.size(), right_.size(), factor_.size()};
            const ContactList::Node& node = set.list.nodes[n];
            // Normals first: where not all can hold, it is friction that gives way.
            for (const bool across : {false, true}) {
                for (std::size_t k = node.pair_begin; k < node.pair_end; ++k) {
                    const ContactPair& pair = set.list.pairs[k];
                    if (!pair.closed() || (only_bonds && pair.bond < 0)) continue;
                    // A grain under force control holds none before the step.
                    if (only_bonds && (driven(node, pair.a) || driven(node, pair.b))) continue;
                    if (!across || pair.state == ContactState::stick)
                        add_row(node, k, across, block);
                }
            }
            if (block.rank > 0) blocks_.push_back(block);
        }
    }

    /// Projects y on the null space of the constraints.
    void project(Vector& y) const {
        for_each(false, y, [&](const double* q, const double*, double* local, std::size_t width) {
            const double size = dot(q, local, width);
            for (std::size_t i = 0; i < width; ++i) local[i] -= q[i] * size;
        });
    }

    /// Enforces the constraints by the smallest change of v, in the measure of D.
    /// in:     V, velocities of the grains under force control
    void enforce(const std::vector<double>& V, Vector& v) const {
        for_each(true, v, [&](const double* q, const double* g, double* local, std::size_t width) {
            double size = dot(q, local, width) - g[0];
            for (std::size_t s = 0; s < V.size(); ++s) size -= g[1 + s] * V[s];
            for (std::size_t i = 0; i < width; ++i) local[i] -= q[i] * size;
        });
    }

    /// v += V e_V: the motion that the grains under force control impose.
    void add_controlled_motion(const double* V, Vector& v) const {
        if (rights_ == 1) return;
        for_each(true, v, [&](const double* q, const double* g, double* local, std::size_t width) {
            double size = 0;
            for (std::size_t s = 0; s + 1 < rights_; ++s) size += g[1 + s] * V[s];
            for (std::size_t i = 0; i < width; ++i) local[i] += q[i] * size;
        });
    }

    /// e_V . r of every grain under force control.
    void controlled_force(const Vector& r, double* sums) const {
        std::fill_n(sums, rights_ - 1, 0.0);
        if (rights_ == 1) return;
        Local local{};
        for (const Block& block : blocks_) {
            load(block, r, 1, local);
            for (std::size_t k = 0; k < block.rank; ++k) {
                const double size = dot(q(block, k), local.data(), width(block));
                for (std::size_t s = 0; s + 1 < rights_; ++s) sums[s] += g(block, k)[1 + s] * size;
            }
        }
    }
    /// e_V . D e_V.
    void controlled_diagonal(double* sums) const {
        std::fill_n(sums, rights_ - 1, 0.0);
        for (const Block& block : blocks_)
            for (std::size_t k = 0; k < block.rank; ++k)
                for (std::size_t s = 0; s + 1 < rights_; ++s)
                    sums[s] += g(block, k)[1 + s] * g(block, k)[1 + s];
    }

    /// Impulses of the closed pairs, from what is left of the equation: H^T lambda = A v - b = -r.
    void find_impulses(const Vector& r, ActiveSet& set) const {
        for (ContactPair& pair : set.list.pairs) {
            pair.lambda_n = 0;
            if (pair.state != ContactState::slip) pair.lambda_t = 0;
        }
        Local local{}, lambda{};
        for (const Block& block : blocks_) {
            load(block, r, 1, local);
            for (std::size_t k = block.rank; k-- > 0;) {
                double c = -dot(q(block, k), local.data(), width(block));
                for (std::size_t i = k + 1; i < block.rank; ++i)
                    c -= factor_[block.factor + i * most_rows + k] * lambda[i];
                lambda[k] = c / factor_[block.factor + k * most_rows + k];
                const Row& row = rows_[block.row + k];
                ContactPair& pair = set.list.pairs[row.pair];
                (row.across ? pair.lambda_t : pair.lambda_n) = lambda[k];
            }
        }
    }

   private:
    static constexpr std::size_t most_rows = 2 * ContactNode::max_bodies;
    struct Row {
        std::size_t pair;
        bool across;
    };
    struct Block {
        std::size_t node, row, rank, basis, right, factor;
    };

    bool driven(const ContactList::Node& at, std::size_t who) const {
        return contacts_->bodies[at.body_begin + who].force_control >= 0;
    }
    const auto& node_of(const Block& block) const { return contacts_->nodes[block.node]; }
    static std::size_t width(const ContactList::Node& node) {
        return 2 * (node.body_end - node.body_begin);
    }
    std::size_t width(const Block& block) const { return width(node_of(block)); }
    const double* q(const Block& block, std::size_t k) const {
        return basis_.data() + block.basis + k * width(block);
    }
    const double* g(const Block& block, std::size_t k) const {
        return right_.data() + block.right + k * rights_;
    }
    static double dot(const double* a, const double* b, std::size_t width) {
        double sum = 0;
        for (std::size_t i = 0; i < width; ++i) sum += a[i] * b[i];
        return sum;
    }

    // Gram and Schmidt, twice for the sake of round-off; a row that others already ask for is left
    // out.
    void add_row(const ContactList::Node& node, std::size_t k, bool across, Block& block) {
        const ContactPair& pair = contacts_->pairs[k];
        const double x = across ? pair.tx() : pair.nx, y = across ? pair.ty() : pair.ny;
        const std::size_t wide = width(node);
        std::vector<double> row(wide, 0.0), right(rights_, 0.0);
        const auto add = [&](std::size_t who, double sign) {
            const ContactBody& body = contacts_->bodies[node.body_begin + who];
            if (body.is_fixed()) {
                const bool drive = body.force_control >= 0, drive_x = drive && body.control_along_x,
                           drive_y = drive && !drive_x;
                right[0] -= sign * ((drive_x ? 0 : body.vx) * x + (drive_y ? 0 : body.vy) * y);
                if (drive && static_cast<std::size_t>(1 + body.force_control) < rights_)
                    right[1 + body.force_control] -= sign * (drive_x ? x : y);
                return;
            }
            row[2 * who] = sign * x * (*scale_)[body.dof];
            row[2 * who + 1] = sign * y * (*scale_)[size_ + body.dof];
        };
        for (const ContactLink& link : pair.all_links())
            add(link.a, -link.weight), add(link.b, link.weight);
        const double size = std::sqrt(dot(row.data(), row.data(), wide));
        std::array<double, most_rows> factor{};
        if (!(size > 0) || block.rank == most_rows) return;
        for (int round = 0; round < 2; ++round) {
            for (std::size_t i = 0; i < block.rank; ++i) {
                const double along = dot(q(block, i), row.data(), wide);
                factor[i] += along;
                for (std::size_t j = 0; j < wide; ++j) row[j] -= along * q(block, i)[j];
                for (std::size_t s = 0; s < rights_; ++s) right[s] -= along * g(block, i)[s];
            }
        }
        const double left = std::sqrt(dot(row.data(), row.data(), wide));
        if (!(left > 1e-10 * size)) return;
        for (const double one : row) basis_.push_back(one / left);
        for (const double one : right) right_.push_back(one / left);
        factor[block.rank] = left;
        factor_.insert(factor_.end(), factor.begin(), factor.end());
        rows_.push_back({k, across});
        ++block.rank;
    }

    using Local = std::array<double, most_rows>;

    // The node's part of v, each number times D^{-1/2} to a power.
    void load(const Block& block, const Vector& v, int power, Local& local) const {
        const ContactList::Node& node = node_of(block);
        for (std::size_t m = node.body_begin; m < node.body_end; ++m) {
            const ContactBody& body = contacts_->bodies[m];
            const std::size_t i = 2 * (m - node.body_begin);
            local[i] = local[i + 1] = 0;
            if (body.is_fixed()) continue;
            for (const auto& [at, dof] :
                 {std::pair(i, body.dof), std::pair(i + 1, size_ + body.dof)}) {
                const double s = (*scale_)[dof];
                local[at] = power == 0 ? v[dof] : power > 0 ? s * v[dof] : s > 0 ? v[dof] / s : 0;
            }
        }
    }
    void store(const Block& block, int power, const Local& local, Vector& v) const {
        const ContactList::Node& node = node_of(block);
        for (std::size_t m = node.body_begin; m < node.body_end; ++m) {
            const ContactBody& body = contacts_->bodies[m];
            const std::size_t i = 2 * (m - node.body_begin);
            if (body.is_fixed()) continue;
            for (const auto& [at, dof] :
                 {std::pair(i, body.dof), std::pair(i + 1, size_ + body.dof)}) {
                const double s = (*scale_)[dof];
                if (power == 0)
                    v[dof] = local[at];
                else if (s > 0)
                    v[dof] = local[at] * s;
            }
        }
    }

    // Lets work(q, g, local, width) change the part of every node, in y = D^{1/2} v; scaled: of v.
    template <class Work>
    void for_each(bool scaled, Vector& v, const Work& work) const {
        const long count = static_cast<long>(blocks_.size());
        common::for_each_block(
            count,
            [&](int, long begin, long end) {
                Local local{};
                for (long n = begin; n < end; ++n) {
                    const Block& block = blocks_[n];
                    load(block, v, scaled ? -1 : 0, local);
                    for (std::size_t k = 0; k < block.rank; ++k)
                        work(q(block, k), g(block, k), local.data(), width(block));
                    store(block, scaled ? 1 : 0, local, v);
                }
            },
            64 * count);
    }

    const ContactList* contacts_ = nullptr;
    const Vector* scale_ = nullptr;
    long size_ = 0;
    std::size_t rights_ = 1;
    std::vector<Row> rows_;
    std::vector<double> basis_, right_, factor_;
    std::vector<Block> blocks_;
};

}  // namespace mpm_implicit
