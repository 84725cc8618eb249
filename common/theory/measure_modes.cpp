#include "common/theory/measure_modes.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <vector>

#include "common/run/sentence.hpp"

namespace common {

namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXcd, Eigen::VectorXcd;

constexpr double pi = 3.14159265358979323846;
constexpr long most_samples = 320;     // in a window, after averaging
constexpr double fastest_decay = -5;   // of an exponential, in a sample
constexpr double far_out = 100;        // energy of a mode over that of the noise
constexpr double weak = 0.05;          // share of a mode that may be noise
constexpr double least_evidence = 30;  // of noise alone one mode in some thousand has that much
constexpr double faint = 1e-3;  // share, over the largest, of a mode that has to be near theory

// The model sum_j c_j exp(s_j (n - n_j)), n_j the sample at which its exponential is 1 at most.
struct Model {
    VectorXcd s, c;
    double rest = 0;  // sum of |z - model|^2

    // exp(s_j (n - n_j)) of all samples and exponentials.
    MatrixXcd columns(Index samples) const {
        MatrixXcd result(samples, s.size());
        for (Index j = 0; j < s.size(); ++j)
            for (Index n = 0; n < samples; ++n)
                result(n, j) = std::exp(s[j] * double(n - origin(j, samples)));
        return result;
    }
    Index origin(Index j, Index samples) const { return s[j].real() > 0 ? samples - 1 : 0; }

    // The least squares of the amplitudes, at these s.
    void find_amplitudes(const VectorXcd& z) {
        const MatrixXcd A = columns(z.size());
        c = A.colPivHouseholderQr().solve(z);
        rest = (z - A * c).squaredNorm();
    }
    // What a record of this length cannot tell apart is not two modes.
    bool is_resolved(Index samples) const {
        for (Index j = 1; j < s.size(); ++j)
            if ((s.head(j).array() - s[j]).abs().minCoeff() * double(samples) < 1) return false;
        return true;
    }
    // Derivatives of the model by the c_j, and by the s_j.
    MatrixXcd slopes(Index samples) const {
        MatrixXcd J(samples, 2 * s.size());
        J.leftCols(s.size()) = columns(samples);
        for (Index j = 0; j < s.size(); ++j)
            for (Index n = 0; n < samples; ++n)
                J(n, s.size() + j) = c[j] * double(n - origin(j, samples)) * J(n, j);
        return J;
    }
};

// Steps 1 and 2 of find_modes().
Model start_of(const VectorXcd& z, const MatrixXcd& V, Index order) {
    const MatrixXcd span = V.leftCols(order).conjugate();
    const Index rows = span.rows() - 1;
    const MatrixXcd step = span.topRows(rows).colPivHouseholderQr().solve(span.bottomRows(rows));
    Model model;
    model.s = Eigen::ComplexEigenSolver<MatrixXcd>(step, false).eigenvalues();
    // What dies within a sample, or grows by e^60, is nothing that the record can tell.
    for (Complex& s : model.s) {
        s = std::abs(s) > 0 ? std::log(s) : Complex(fastest_decay);
        s.real(std::clamp(s.real(), fastest_decay, 60.0 / double(z.size())));
    }
    model.find_amplitudes(z);
    return model;
}

// Step 3.
void improve(const VectorXcd& z, Model& model) {
    const Index order = model.s.size();
    for (int iteration = 0; iteration < 12; ++iteration) {
        const VectorXcd difference = z - model.columns(z.size()) * model.c;
        const VectorXcd change =
            model.slopes(z.size()).colPivHouseholderQr().solve(difference).tail(order);
        if (!change.allFinite()) return;
        bool better = false;
        for (double part = 1; part > 0.1 && !better; part *= 0.5) {
            Model next = model;
            next.s += part * change;
            if (next.s.real().maxCoeff() * double(z.size()) > 100 ||
                next.s.real().minCoeff() < fastest_decay || next.s.imag().cwiseAbs().maxCoeff() > 4)
                continue;
            next.find_amplitudes(z);
            better = next.rest < model.rest;
            if (better) model = next;
        }
        if (!better || change.norm() < 1e-9 * model.s.norm()) return;
    }
}

// The standard error of s of the first of these modes in noise like `rest`.
//   J^+ R J^+H,  R_mn = C(m - n) the covariance of the noise, of lags below a tenth of the record, whole up to
//   those that averaging makes, 2; not below that of white noise, R = C(0)
// in: slopes J by all c and then all s of a model
double error_of_first(const MatrixXcd& J, const std::vector<Index>& modes, const VectorXcd& rest,
                      double freedom) {
    const Index count = Index(modes.size()), samples = J.rows(),
                lags = std::max<Index>(4, samples / 10);
    MatrixXcd slopes(samples, 2 * count);
    for (Index j = 0; j < count; ++j) {
        slopes.col(j) = J.col(modes[std::size_t(j)]);
        slopes.col(count + j) = J.col(J.cols() / 2 + modes[std::size_t(j)]);
    }
    const Eigen::VectorXd size =
        slopes.colwise().norm().transpose().cwiseMax(std::numeric_limits<double>::min());
    const MatrixXcd unit = slopes * size.cwiseInverse().asDiagonal();
    const Eigen::SelfAdjointEigenSolver<MatrixXcd> gram(unit.adjoint() * unit);
    const Eigen::ArrayXd values =
        gram.eigenvalues().array().max(1e-15 * gram.eigenvalues().tail(1)[0]);
    const VectorXcd inverse =
        gram.eigenvectors() *
        (gram.eigenvectors().row(count).adjoint().array() / values.cast<Complex>()).matrix();
    const VectorXcd row = unit * inverse / size[count];  // of J^+, conjugate
    double squares = row.squaredNorm() * rest.squaredNorm();
    const double white = squares;
    for (Index k = 1; k < lags; ++k) {
        const Complex C = rest.head(samples - k).dot(rest.tail(samples - k)),
                      turned = row.tail(samples - k).dot(row.head(samples - k));
        squares += 2 * std::min(1.0, 1 - double(k - 2) / double(lags)) * (C * turned).real();
    }
    return std::sqrt(std::max(squares, white) / freedom);
}

// The modes of a model, with errors and evidence.
ModeList modes_of(const VectorXcd& z, const Model& model, double dt) {
    const Index order = model.s.size(), samples = z.size();
    // Averaging shares a third of its noise with the next sample, so that about half of them count.
    const double freedom = double(std::max<Index>(1, samples - 4 * order));
    const double energy = z.squaredNorm(), floor = 1e-30 * energy;
    const MatrixXcd A = model.columns(samples), parts = A * model.c.asDiagonal();
    const VectorXcd difference = z - A * model.c;
    const auto share = [&](Index j) { return parts.col(j).squaredNorm() / energy; };

    const MatrixXcd J = model.slopes(samples);
    ModeList list;
    for (Index j = 0; j < order; ++j) {
        // Weak modes that do not stand far out of the noise may be noise as well: they count as such
        // in the errors of all others.
        VectorXcd rest = difference;
        std::vector<Index> kept{j};
        for (Index k = 0; k < order; ++k) {
            if (k == j) continue;
            const bool opposite = std::abs(model.s[k] - std::conj(model.s[j])) < 1e-2;
            const bool noisy = parts.col(k).squaredNorm() < far_out * model.rest;
            if (share(k) < weak && noisy && !opposite)
                rest += parts.col(k);
            else
                kept.push_back(k);
        }
        const double deviation = std::sqrt(0.5) * error_of_first(J, kept, rest, freedom);
        Model without;
        without.s.resize(order - 1);
        without.s << model.s.head(j), model.s.tail(order - 1 - j);
        without.rest = energy;
        if (order > 1) without.find_amplitudes(z);
        Mode mode;
        mode.omega = Complex(0, 1) * model.s[j] / dt;
        mode.error = Complex(2.2, 2.2) * std::max(deviation, 1e-15) / dt;
        mode.amplitude = model.c[j] * A(0, j);
        mode.share = share(j);
        mode.evidence = (without.rest - model.rest) * freedom / (model.rest + floor);
        list.modes.push_back(mode);
    }
    list.noise = std::sqrt(model.rest / energy);
    std::ranges::sort(list.modes, std::greater{}, &Mode::share);
    return list;
}

}  // namespace

ModeList find_modes(std::span<const Complex> record, double dt, int most) {
    const VectorXcd z = Eigen::Map<const VectorXcd>(record.data(), Index(record.size()));
    const Index samples = z.size();
    if (samples < 8) return {{}, 0, "the record has fewer than 8 samples"};
    if (!z.allFinite()) return {{}, 0, "a value of the record is not finite"};
    const double size = z.cwiseAbs().maxCoeff();
    if (!(size > 0)) return {{}, 0, "the record is zero"};
    const VectorXcd unit = z / size;

    const Index columns = std::min<Index>(samples / 2, 80);
    MatrixXcd Z(samples - columns, columns + 1);
    for (Index i = 0; i < Z.rows(); ++i) Z.row(i) = unit.segment(i, columns + 1).transpose();
    const Eigen::SelfAdjointEigenSolver<MatrixXcd> gram(Z.adjoint() * Z);
    const MatrixXcd V = gram.eigenvectors().rowwise().reverse();  // the largest first

    // Step 4.
    std::vector<Model> models;
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    const double floor = 1e-26 * unit.squaredNorm();
    const Index largest = std::min<Index>({most, columns - 1, Z.rows(), (samples - 2) / 3});
    for (Index order = 1; order <= largest; ++order) {
        models.push_back(start_of(unit, V, order));
        Model& model = models.back();
        improve(unit, model);
        const double score = 2 * double(samples) * std::log(std::max(model.rest, floor)) +
                             12 * double(order) * std::log(2 * double(samples));
        if (std::isfinite(score) && score < least && model.is_resolved(samples))
            least = score, best = models.size() - 1;
        if (model.rest <= floor) break;
    }
    if (!std::isfinite(least)) return {{}, 0, "no exponentials fit the record"};
    ModeList list = modes_of(unit, models[best], dt);
    for (Mode& mode : list.modes) {
        mode.amplitude *= size;
        // Noise with a color looks like modes. Models that explain nearly as much, and have this
        // mode, tell how far that moves it.
        double real = 0, imag = 0;
        for (const Model& model : models) {
            if (!(model.rest <= 4 * std::max(models[best].rest, floor))) continue;
            Complex off = std::numeric_limits<double>::infinity();
            for (const Complex& s : model.s)
                if (const Complex here = Complex(0, 1) * s / dt - mode.omega;
                    std::abs(here) < std::abs(off))
                    off = here;
            const auto is_nearer = [&](const Mode& one) {
                return std::abs(mode.omega + off - one.omega) < std::abs(off);
            };
            if (std::ranges::any_of(list.modes, is_nearer)) continue;
            real = std::max(real, std::abs(off.real())),
            imag = std::max(imag, std::abs(off.imag()));
        }
        mode.error = {std::hypot(mode.error.real(), real), std::hypot(mode.error.imag(), imag)};
    }
    return list;
}

namespace {

// The rows begin ... end - 1 of a history.
struct Rows {
    long begin = 0, end = 0;
    long count() const { return end - begin; }
};

// What is looked for, in numbers.
struct Wanted {
    double growth = 0, frequency = 0, size = 0;  // of the roots of theory, the largest of each
    explicit Wanted(const ModeSearch& search) {
        for (const Complex& omega : search.expected) {
            growth = std::abs(omega.imag()) > std::abs(growth) ? omega.imag() : growth;
            frequency = std::max(frequency, std::abs(omega.real()));
            size = std::max(size, std::abs(omega));
        }
    }
};

// A root of theory and the mode that is taken for it.
struct Match {
    Mode mode;
    double distance = std::numeric_limits<double>::infinity();
    bool mirrored = false;
};

// What is left of modes that a window of this length can tell from a constant, and from noise.
std::vector<Mode> told_apart(const ModeList& list, double length, const Wanted& wanted) {
    std::vector<Mode> modes;
    const double least = std::min(2.0, 0.5 * wanted.size * length);
    for (const Mode& mode : list.modes)
        if (mode.evidence >= least_evidence && std::abs(mode.omega) * length >= least)
            modes.push_back(mode);
    return modes;
}

// What a difference has beyond its error.
double beyond(double difference, double error) {
    return std::sqrt(std::max(0.0, difference * difference - error * error));
}

// The mode nearest to one of the roots, turned into the direction of the first root. Of a record with
// next to no noise even the last trace of another wave has evidence: it counts within its error and a
// tenth of the root.
Match nearest(const std::vector<Mode>& modes, const std::vector<Complex>& expected) {
    Match best;
    double largest = 0;
    for (const Mode& mode : modes) largest = std::max(largest, mode.share);
    for (const Complex& root : expected)
        for (const Mode& mode : modes) {
            const double distance = std::abs(mode.omega - root),
                         near = std::abs(mode.error) + 0.1 * std::abs(root);
            if (distance < best.distance && (mode.share >= faint * largest || distance <= near))
                best = {mode, distance, root.real() * expected.front().real() < 0};
        }
    if (best.mirrored) best.mode.omega = -std::conj(best.mode.omega);
    return best;
}

// A wave that stands runs both ways with the same frequency and rate: their mean, and an error that
// holds both. Of one direction with less than a tenth of the other nothing is asked.
Match of_both_directions(Match match, const std::vector<Mode>& modes, double size) {
    Mode &mode = match.mode, other;
    double closest = 0.3 * size;
    if (std::abs(mode.omega.real()) < closest) return match;
    for (Mode one : modes) {
        if (!match.mirrored) one.omega = -std::conj(one.omega);
        if (std::abs(one.omega - mode.omega) < closest)
            closest = std::abs(one.omega - mode.omega), other = one;
    }
    for (Mode one : modes) {
        if (match.mirrored) one.omega = -std::conj(one.omega);
        if (std::abs(one.omega - other.omega) < closest)
            return match;  // whose other direction it is
    }
    const double part = other.share / (other.share + mode.share);
    if (part > 10.0 / 11) {
        mode = other;
    } else if (part > 1.0 / 11) {
        const Complex apart = other.omega - mode.omega;
        const auto error = [part](double one, double two, double off) {
            return std::hypot((1 - part) * one, part * two, beyond(off, std::hypot(one, two)));
        };
        mode.omega += part * apart;
        mode.error = {error(mode.error.real(), other.error.real(), apart.real()),
                      error(mode.error.imag(), other.error.imag(), apart.imag())};
    }
    return match;
}

// One sample in `block`, the mean of a mean of a mean over a block. One mean lets a seventh of a wave through that is
// eight times as fast as the one looked for, and samples fold it back to where that one is; three a 300th.
std::vector<Complex> averaged(std::span<const Complex> z, Rows rows, long block) {
    std::vector<double> weights{1};
    for (int mean = 0; mean < 3; ++mean) {
        std::vector<double> wider(weights.size() + std::size_t(block - 1));
        for (std::size_t n = 0; n < weights.size(); ++n)
            for (long m = 0; m < block; ++m) wider[n + m] += weights[n] / double(block);
        weights = wider;
    }
    std::vector<Complex> result;
    for (long n = rows.begin; n + long(weights.size()) <= rows.end; n += block)
        result.push_back(
            std::inner_product(weights.begin(), weights.end(), z.begin() + n, Complex()));
    return result;
}

// The part of the record that tells most, and in how large blocks.
Rows window_of(std::span<const double> times, std::span<const Complex> z, const ModeSearch& search,
               const Wanted& wanted, long& block, bool& high) {
    const double dt = times[1] - times[0], slack = 1e-9 * dt;
    Rows rows;
    rows.begin = std::ranges::lower_bound(times, search.begin - slack) - times.begin();
    rows.end = std::ranges::upper_bound(times, search.end + slack) - times.begin();
    rows.end = std::max(rows.begin, rows.end);
    const bool grows = wanted.growth > 0 && search.below_maximum < 1;
    const auto size = [&](long n) { return std::abs(z[std::size_t(n)]); };
    // The largest amplitude in some rows, over what the mode grows until then.
    const auto largest = [&](long begin, long end, double growth = 0) {
        double most = 0;
        for (long n = begin; n < std::min(end, rows.end); ++n)
            most = std::max(most, size(n) * std::exp(-growth * dt * double(n - begin)));
        return most;
    };
    if (grows && rows.count() > 0) {
        double level = 0;
        for (long n = rows.begin; n < long(z.size()); ++n) level = std::max(level, size(n));
        level *= search.below_maximum;
        long end = rows.begin;
        while (end < rows.end && size(end) < level) ++end;
        // A record that begins above the level has another mode, and only search.end knows.
        const bool turns = wanted.frequency > std::abs(wanted.growth);
        const double half = turns ? pi / (wanted.frequency * dt) : 1;
        high = largest(rows.begin, rows.begin + std::lround(half), wanted.growth) >= level;
        if (!high) rows.end = end;
    }
    if (wanted.growth < 0 && rows.count() > 8) {
        std::vector<double> late;
        for (long n = rows.end - rows.count() / 4; n < rows.end; ++n) late.push_back(size(n));
        std::nth_element(late.begin(), late.begin() + long(late.size() / 2), late.end());
        const double noise = late[late.size() / 2];
        const long period = std::lround(std::ceil(2 * pi / (wanted.size * dt)));
        long end = rows.begin;
        while (end < rows.end && largest(end, end + period) > 2.5 * noise) ++end;
        // It is noise where it is more than what theory leaves of the wave by then.
        const double start = largest(rows.begin, rows.begin + period),
                     left = start * std::exp(wanted.growth * dt * 0.875 * double(rows.count()));
        if (start > 5 * noise && noise > 1.5 * left) rows.end = end;
    }
    const double e_folding = 1 / (std::abs(wanted.growth) * dt), radian = 1 / (wanted.size * dt);
    const long enough = std::lround(std::ceil(std::min(std::max(8 * e_folding, 8.0), 1e9)));
    if (enough < rows.count())
        (grows ? rows.begin : rows.end) = grows ? rows.end - enough : rows.begin + enough;
    block = std::max(1L, std::min(long(0.8 * radian), rows.count() / 64));
    const long longer = (rows.count() + most_samples - 1) / most_samples;
    block = std::max(block, std::min(longer, long(0.8 * radian)));
    if (rows.count() > most_samples * block)
        (grows ? rows.begin : rows.end) =
            grows ? rows.end - most_samples * block : rows.begin + most_samples * block;
    return rows;
}

}  // namespace

MeasuredMode measure_mode(std::span<const double> times, std::span<const Complex> z,
                          const ModeSearch& search) {
    MeasuredMode result;
    const auto cannot = [&](const auto&... why) {
        result.found = false;
        result.reason = sentence("cannot be measured, because ", why...);
        return result;
    };
    const Wanted wanted(search);
    if (times.size() < 8 || times.size() != z.size())
        return cannot("the history has fewer than 8 rows");
    if (!(wanted.size > 0)) return cannot("theory has no root to look for");

    long block = 1;
    const Rows rows = window_of(times, z, search, wanted, block, result.high);
    const double dt = times[1] - times[0];
    // Over: growth from the end of the window to the maximum takes less than the rest. A short run is not high.
    const double ended = times[std::size_t(std::max(0L, rows.end - 1))],
                 left = search.end < times.back() ? HUGE_VAL : times.back() - ended,
                 e_folds = -1.5 * std::log(search.below_maximum);
    result.over = search.below_maximum < 1 && wanted.growth * left > e_folds;
    result.high &= wanted.growth * (times.back() - std::max(search.begin, times[0])) > e_folds;
    std::string cure = result.over   ? "; growth is over then"
                       : result.high ? "; it begins near its maximum: lower what it starts from"
                                     : ": raise time.end";
    if (wanted.growth < 0 && left > 0) cure = "; " + search.faded;
    if (rows.count() < 8 * block)
        return cannot("only ", std::max(0L, rows.count()),
                      " rows of the history are between the transient of the start and the end of "
                      "the linear phase (shorter steps between rows give more)",
                      wanted.growth > 0 ? cure : "");
    result.begin = times[std::size_t(rows.begin)], result.end = times[std::size_t(rows.end - 1)];
    const double length = result.end - result.begin;

    // Find its modes, and among them the one of theory.
    const std::vector<Complex> record = averaged(z, rows, block);
    const ModeList list = find_modes(record, double(block) * dt);
    if (list.modes.empty()) return cannot(list.reason);
    const std::vector<Mode> modes = told_apart(list, length, wanted);
    if (modes.empty())
        return cannot(list.noise, " of the record from t = ", result.begin, " to ", result.end,
                      " is noise or waves not to be told apart, and the rest stays at rest");
    Match match = nearest(modes, search.expected);
    if (search.expected.size() > 1) match = of_both_directions(match, modes, wanted.size);
    result.omega = match.mode.omega, result.error = match.mode.error;

    // Look for it in parts of the window.
    Complex strays = 0;
    const long quarter = long(record.size()) / 4;
    for (const Rows part :
         {Rows{quarter, long(record.size())}, Rows{0, long(record.size()) - quarter},
          Rows{quarter / 2, long(record.size()) - quarter / 2}}) {
        const ModeList there = find_modes(
            std::span(record).subspan(std::size_t(part.begin), std::size_t(part.count())),
            double(block) * dt);
        const Match same = nearest(
            told_apart(there, length * double(part.count()) / double(record.size()), wanted),
            {result.omega, -std::conj(result.omega)});
        if (!std::isfinite(same.distance)) continue;
        const Complex off = same.mode.omega - result.omega;
        strays.real(std::max(strays.real(), beyond(off.real(), same.mode.error.real())));
        strays.imag(std::max(strays.imag(), beyond(off.imag(), same.mode.error.imag())));
    }
    result.error = {std::hypot(result.error.real(), strays.real()),
                    std::hypot(result.error.imag(), strays.imag())};

    // Say what was seen.
    result.window = sentence("from t = ", result.begin, " to ", result.end);
    std::string others;
    for (const Mode& mode : modes) {
        const bool same = std::min(std::abs(mode.omega - match.mode.omega),
                                   std::abs(mode.omega + std::conj(match.mode.omega))) <
                          std::abs(match.mode.error) + 1e-6 * wanted.size;
        if (!same && mode.share > 1e-3)
            others +=
                sentence(others.empty() ? "" : ", ", mode.omega.real(),
                         mode.omega.imag() < 0 ? " - " : " + ", std::abs(mode.omega.imag()), " i");
    }
    if (!others.empty()) result.window += "; also seen: omega = " + others;
    const VectorXcd samples = Eigen::Map<const VectorXcd>(record.data(), Index(record.size()));
    const Complex s = Complex(0, -double(block) * dt) * match.mode.omega;
    Model wave{Eigen::Vector2cd(s, std::conj(s)), {}};
    wave.find_amplitudes(samples);
    result.share = 1 - wave.rest / samples.squaredNorm();
    const double turns = result.frequency() * length / (2 * pi),
                 folds = std::abs(result.growth()) * length;
    if (turns < 0.999 * search.periods && folds < 0.999 * search.e_foldings)
        return cannot("it has ", turns, " periods and ", folds, " e-foldings, below ",
                      search.periods, " and ", search.e_foldings, ", ", result.window, cure);
    result.found = true;
    return result;
}

MeasuredMode measure_mode(std::span<const double> times, std::span<const double> y,
                          const ModeSearch& search) {
    return measure_mode(times, std::vector<Complex>(y.begin(), y.end()), search);
}

}  // namespace common
