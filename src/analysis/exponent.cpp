#include "analysis/exponent.hpp"

#include "analysis/stability.hpp"
#include "analysis/tangent.hpp"
#include "base/error.hpp"
#include "physics/angle_chain.hpp"
#include "physics/physical_chain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace doppel {
namespace {

/// The growth of one tangent, as its logarithm.
class TangentGrowth {
public:
    TangentGrowth(const TangentFlow& flow, const PhysicalPendulum<double>& p, double tolerance, double unit_s)
        : motion_(flow, p.chain.links(), tolerance),
          links_(static_cast<Eigen::Index>(p.chain.links())),
          size_(flow.start.size() / 2),
          unit_(unit_s),
          rescale_at_(p.friction.is_none() ? -huge : tenth) {
        // 1, 1/2, 1/3 …: a direction without any symmetry
        auto y = flow.start;
        for (Eigen::Index i = 0; i < links_; ++i) {
            y[size_ + i] = 1 / static_cast<double>(i + 1);
            y[size_ + size_ / 2 + i] = 1 / static_cast<double>(links_ + i + 1) / unit_;
        }
        last_ = log_norm(y);
        motion_.restart(y);
    }

    /// The growth of ln|δ| over `seconds`.
    double advance(double seconds) {
        constexpr double many_turns = 100;  // rad
        TangentState y = motion_.advance(seconds);
        const double now = log_norm(y), growth = now - last_;
        last_ = now;
        if (now > huge || now < rescale_at_ || y.head(links_).cwiseAbs().maxCoeff() > many_turns) {
            y.tail(size_) *= portable_exp(-now);
            last_ = log_norm(y);
            motion_.restart(y);
        }
        return growth;
    }

private:
    static constexpr double huge = 13.8, tenth = -2.3;  // ln of a million; ln of 1/10

    /// ln of the tangent's Euclidean norm; rates are multiplied by the natural unit of time.
    double log_norm(const TangentState& y) const {
        double angles = 0, rates = 0;  // sums of squares
        for (Eigen::Index i = 0; i < links_; ++i) {
            const double angle = y[size_ + i], rate = y[size_ + size_ / 2 + i];
            angles += angle * angle;
            rates += rate * rate;
        }
        return 0.5 * portable_log(angles + unit_ * unit_ * rates);
    }

    TangentMotion motion_;
    Eigen::Index links_, size_;  // size of the state without the tangent
    double unit_;                // s
    double rescale_at_;          // ln|δ| above which it is rescaled to 1; error control hardly sees small tangents
    double last_ = 0;
};

/// The factor on a standard error from `count` numbers that makes Student's distribution cover as much as one standard
/// deviation of a normal one, within 2 %.
/// Source  Abramowitz & Stegun, 26.7.5, for x = 1.
double student_factor(std::size_t count) {
    const double n = static_cast<double>(count - 1);
    return 1 + 1 / (2 * n) + 1 / (4 * n * n) + 1 / (16 * n * n * n);
}

/// The standard error of the mean, 1/s, from `count` blocks of equal size; larger if there are few blocks.
double standard_error(const std::vector<double>& local, std::size_t count) {
    const auto parts = local.size() / count;
    std::vector<double> blocks(count);
    double mean = 0, square = 0;
    for (std::size_t i = 0; i < count * parts; ++i) blocks[i / parts] += local[i] / static_cast<double>(parts);
    for (const double block : blocks) mean += block / static_cast<double>(count);
    for (const double block : blocks) square += (block - mean) * (block - mean);
    return student_factor(count) * std::sqrt(square / static_cast<double>(count * (count - 1)));
}

/// The number of blocks after the transient; block lengths up to four times as long are tried.
constexpr std::size_t blocks = 20;

/// Mean and uncertainty of the local exponents of equal parts. Contributions to the uncertainty:
///     standard error      the largest of those from blocks of increasing length (Flyvbjerg & Petersen 1989, J. Chem.
///                         Phys. 91:461): near sticky orbits, short blocks are not independent. If it still grows at
///                         the end, by blocks four times as long, the same growth is assumed once more
///     finite time         the value that a tangent growing like t, as in regular motion, would give at this time
///     comparison          a run four times as long has half this error
Exponent summary(const std::vector<double>& local, const ExponentSpec& spec) {
    double mean = 0, error = 0, whole = 0, last = 0;
    for (const double value : local) mean += value / static_cast<double>(local.size());
    for (std::size_t count = 4 * blocks; count >= blocks / 4; count /= 2) {
        if (count > local.size()) continue;
        last = standard_error(local, count);
        error = std::max(error, last);
        if (count == blocks) whole = last;
    }
    if (last > whole) error *= last / whole;
    // measured: exceeded by 1 of 48 runs in two chaotic seas, 6 of 24 from 70° (sticky orbits), 15 of 24 in a transient
    constexpr double unlike = 3;
    const bool is_settled = !(error > unlike * whole);
    const double finite_time = portable_log(spec.duration_s / spec.transient_s) / (spec.duration_s - spec.transient_s);
    return {mean, std::sqrt(1.25 * (error * error + finite_time * finite_time)), is_settled};
}

/// The tangent flow of the rigid-body equations.
TangentFlow flow_of(const PhysicalPendulum<double>& p) {
    using Chain = PhysicalChain<Dual<double, 1>>;
    const auto release = p.cast<Dual<double, 1>>();
    return tangent_flow(Chain(release, false), Chain::start(release, false));
}

/// Nothing if the release is no equilibrium, as for driven pendulums.
std::optional<double> equilibrium_exponent(const PhysicalPendulum<double>& p) {
    constexpr double level = 1e-14;  // of a sine
    for (std::size_t i = 0; i < p.chain.links(); ++i)
        if (p.chain.rate[i] != 0 || (p.chain.gravity != 0 && std::abs(SinCos<double>(p.chain.angle[i]).sin) > level))
            return std::nullopt;
    if (p.is_driven()) return std::nullopt;
    if (p.chain.gravity == 0) return 0.0;
    // The Jacobian ∂(θ′, ω′)/∂(θ, ω).
    const auto flow = flow_of(p);
    const auto size = flow.start.size() / 2;
    Eigen::MatrixXd jacobian(size, size);
    TangentState y = flow.start, rates;
    for (Eigen::Index j = 0; j < size; ++j) {
        y.tail(size) = Eigen::VectorXd::Unit(size, j);
        flow.rate(y, rates);
        jacobian.col(j) = rates.tail(size);
    }
    if (!p.friction.is_none()) return largest_real_part(jacobian);
    // θ″ = A θ
    return std::sqrt(std::max(0.0, largest_real_part(jacobian.bottomLeftCorner(size / 2, size / 2))));
}

Exponent exponent_of(const TangentFlow& flow, const PhysicalPendulum<double>& p, const ExponentSpec& spec,
                     const std::atomic<bool>& stop) {
    if (const auto exact = equilibrium_exponent(p)) return {*exact, 0};
    const NaturalUnits units(p);
    TangentGrowth growth(flow, p, spec.tolerance, units.time);
    const auto exponents_of_parts = [&](double seconds, long parts) {
        std::vector<double> local;
        for (long i = 0; i < parts; ++i) {
            throw_if_set(stop);
            local.push_back(growth.advance(seconds) / seconds);
        }
        return local;
    };
    const long parts = parts_of(spec.transient_s, units);
    exponents_of_parts(spec.transient_s / static_cast<double>(parts), parts);
    const double block_s = (spec.duration_s - spec.transient_s) / static_cast<double>(blocks);
    const long of_block = parts_of(block_s, units);
    return summary(exponents_of_parts(block_s / static_cast<double>(of_block), static_cast<long>(blocks) * of_block),
                   spec);
}

}  // namespace

void require_smooth(const PhysicalPendulum<double>& p) {
    if (!p.friction.coulomb.empty())
        throw bad_input(
            "Lyapunov exponents need a smooth motion; with Coulomb friction (joint_coulomb_N_m) joints stick and slip");
}

Exponent largest_exponent(const Pendulum<double>& p, const ExponentSpec& spec, const std::atomic<bool>& stop) {
    using Two = DoublePendulum<Dual<double, 1>>;
    using Chain = AngleChain<Dual<double, 1>, Eigen::Dynamic>;
    const auto release = p.cast<Dual<double, 1>>();
    const auto flow = p.links() == 2 ? tangent_flow(Two(release), Two::start(release))
                                     : tangent_flow(Chain(release), Chain::start(release));
    return exponent_of(flow, physical(p), spec, stop);
}

Exponent largest_exponent(const PhysicalPendulum<double>& p, const ExponentSpec& spec, const std::atomic<bool>& stop) {
    require_smooth(p);
    return exponent_of(flow_of(p), p, spec, stop);
}

}  // namespace doppel
