#include "analysis/exponent.hpp"

#include "analysis/stability.hpp"
#include "base/error.hpp"
#include "integrate/dormand_prince.hpp"
#include "numeric/dual.hpp"
#include "physics/angle_chain.hpp"
#include "physics/canonical.hpp"
#include "physics/physical_chain.hpp"

#include <Eigen/Householder>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <utility>

namespace doppel {
namespace {

/// The number of parts of an interval, so that no tangent overflows in one part.
long parts_of(double seconds, const NaturalUnits& units) {
    return std::max(1L, std::lround(std::ceil(seconds / (4 * units.time))));
}

/// Throws Error (exit 2) if joints have Coulomb friction: where they stop and start, the motion has no tangents.
void require_smooth(const PhysicalPendulum<double>& p) {
    if (!p.friction.coulomb.empty())
        throw bad_input(
            "Lyapunov exponents need a smooth motion; with Coulomb friction (joint_coulomb_N_m) joints stick and slip");
}

/// A state y of a model in angles over Dual<double, D>, with D tangents, as plain numbers: y, then for each component
/// of y D numbers, one for each tangent. If y contains the time, its tangents are 0.
using TangentState = State<double, Eigen::Dynamic>;

template <class DualState>
void to_dual(const TangentState& all, DualState& y) {
    constexpr Eigen::Index directions = DualState::Scalar::Tangent::RowsAtCompileTime;
    for (Eigen::Index i = 0; i < y.size(); ++i) {
        y[i].value = all[i];
        y[i].tangent = all.segment<directions>(y.size() + i * directions);
    }
}

template <class DualState>
void from_dual(const DualState& y, TangentState& all) {
    constexpr Eigen::Index directions = DualState::Scalar::Tangent::RowsAtCompileTime;
    all.resize(y.size() * (1 + directions));
    for (Eigen::Index i = 0; i < y.size(); ++i) {
        all[i] = y[i].value;
        all.segment<directions>(y.size() + i * directions) = y[i].tangent;
    }
}

/// The state and its tangents as one system, so that error control applies to all of them:
///     y′ = f(y) ,    δ′ = Df(y) δ
/// both from one evaluation of f in dual numbers.
/// Source  Benettin, Galgani, Giorgilli & Strelcyn 1980, Meccanica 15:9.
struct TangentFlow {
    using Scalar = double;
    using State = TangentState;

    std::function<void(const TangentState& all, TangentState& rates)> rate;
    TangentState start;
};

template <class Model>
TangentFlow tangent_flow(Model model, const typename Model::State& start) {
    TangentFlow flow;
    from_dual(start, flow.start);
    flow.rate = [model = std::move(model), y = start, rate = start](const TangentState& all,
                                                                    TangentState& rates) mutable {
        to_dual(all, y);
        model.rate(y, rate);
        from_dual(rate, rates);
    };
    return flow;
}

/// Integrates state and tangents by dop853, with restarts. Error control is relative to the size of tangents, so they
/// must be neither huge nor tiny. The first `angles` numbers must not be many turns.
class TangentMotion {
public:
    TangentMotion(TangentFlow flow, std::size_t angles, double tolerance)
        : flow_(std::move(flow)), angles_(static_cast<Eigen::Index>(angles)), tolerance_(tolerance) {}
    TangentMotion(const TangentMotion&) = delete;  // the method contains the address of the flow
    TangentMotion& operator=(const TangentMotion&) = delete;

    void restart(TangentState y) {
        for (Eigen::Index i = 0; i < angles_; ++i) y[i] = std::remainder(y[i], 2 * pi);
        if (dop853_)
            dop853_->reset(y);
        else
            dop853_.emplace(flow_, y, tolerance_);
    }

    const TangentState& advance(double seconds) {
        dop853_->advance(seconds);
        return dop853_->state();
    }

private:
    TangentFlow flow_;
    Eigen::Index angles_;
    double tolerance_;
    std::optional<Dop853::Stepper<TangentFlow>> dop853_;
};

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

/// Replaces the frame = QR by Q, by Householder reflections; returns |R_ii|. (Eigen's blocked QR takes seconds to
/// compile.)
/// Source  Golub & Van Loan, Matrix Computations, §5.2.
Eigen::VectorXd orthonormalise(Eigen::MatrixXd& frame) {
    const auto n = frame.rows();
    Eigen::VectorXd factor(n), stretched(n), scratch(n);
    const auto reflect = [&](Eigen::MatrixXd& matrix, Eigen::Index k, Eigen::Index columns) {
        matrix.bottomRightCorner(n - k, columns)
            .applyHouseholderOnTheLeft(frame.col(k).tail(n - k - 1), factor[k], scratch.data());
    };
    for (Eigen::Index k = 0; k < n; ++k) {
        frame.col(k).tail(n - k).makeHouseholderInPlace(factor[k], stretched[k]);
        reflect(frame, k, n - k - 1);
    }
    Eigen::MatrixXd q = Eigen::MatrixXd::Identity(n, n);
    for (Eigen::Index k = n; k-- > 0;) reflect(q, k, n - k);
    frame = q;
    return stretched.cwiseAbs();
}

/// All tangents of a motion. At intervals their frame is made orthonormal, and its stretching is added up as
/// logarithms. Frames are canonical, (δθ, δp), in which a flow without friction preserves volume: the logarithms always
/// sum to 0.
/// Source  Shimada & Nagashima 1979, Progress of Theoretical Physics 61:1605; Benettin et al. 1980, Meccanica 15:21.
/// `directions` must be at least 2N; the remaining ones are 0.
template <int directions>
class Frame {
public:
    using Matrix = Eigen::MatrixXd;
    using Column = Eigen::VectorXd;

    Frame(const PhysicalPendulum<double>& p, double tolerance, const NaturalUnits& units)
        : model_(p.template cast<Number>(), false),
          canonical_(model_),
          y_(Model::start(p.template cast<Number>(), false)),
          z_(y_),
          motion_(tangent_flow(model_, y_), p.chain.links(), tolerance),
          links_(static_cast<Eigen::Index>(p.chain.links())) {
        const double mass = std::accumulate(p.chain.mass.begin(), p.chain.mass.end(), 0.0);
        unit_.setOnes(2 * links_);
        unit_.tail(links_).setConstant(mass * units.length * units.length / units.time);
        canonical_.momenta(y_, z_);
        restart(Matrix::Identity(2 * links_, 2 * links_));
    }

    /// The growth of each ln|δ_i| over `seconds`.
    Column advance(double seconds) {
        constexpr double flat = 1e-7;  // the frame's smallest side has lost half of its digits
        to_dual(motion_.advance(seconds), y_);
        canonical_.momenta(y_, z_);
        Matrix frame(2 * links_, 2 * links_);
        for (Eigen::Index i = 0; i < 2 * links_; ++i)
            frame.row(i) = z_[row(i)].tangent.head(2 * links_).transpose() / unit_[i];
        const Column stretched = orthonormalise(frame);
        if (stretched.minCoeff() < flat * stretched.maxCoeff()) {
            motion_.restart(start_);
            const Column first = advance(seconds / 2);
            return first + advance(seconds / 2);
        }
        restart(frame);
        return stretched.unaryExpr([](double factor) { return portable_log(factor); });
    }

private:
    using Number = Dual<double, directions>;
    using Model = PhysicalChain<Number>;

    /// The rows of the state: angles and momenta, without the time.
    Eigen::Index row(Eigen::Index i) const { return i < links_ ? i : z_.size() / 2 + i - links_; }

    /// Restarts with the values of z and the columns of the frame as tangents.
    void restart(const Matrix& frame) {
        for (Eigen::Index i = 0; i < 2 * links_; ++i)
            z_[row(i)].tangent.head(2 * links_) = unit_[i] * frame.row(i).transpose();
        canonical_.velocities(z_, y_);
        from_dual(y_, start_);
        motion_.restart(start_);
    }

    Model model_;
    Canonical<Model> canonical_;
    typename Model::State y_, z_;
    TangentMotion motion_;
    TangentState start_;  // at the last restart
    Eigen::Index links_;
    Column unit_;  // units of angles and momenta: 1 and N m s
};

template <int directions>
std::vector<SpectrumSample> estimates(const PhysicalPendulum<double>& p, const SpectrumSpec& spec,
                                      const std::atomic<bool>& stop) {
    const NaturalUnits units(p);
    Frame<directions> frame(p, spec.tolerance, units);
    const double interval = spec.duration_s / spec.samples;
    const long parts = parts_of(interval, units);
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(2 * p.chain.links()));
    std::vector<SpectrumSample> samples;
    for (int k = 1; k <= spec.samples; ++k) {
        for (long i = 0; i < parts; ++i) {
            throw_if_set(stop);
            sum += frame.advance(interval / static_cast<double>(parts));
        }
        const double time = spec.duration_s * k / spec.samples;
        samples.push_back({time, {}});
        for (const double logarithm : sum) samples.back().exponents.push_back(logarithm / time);
    }
    return samples;
}

}  // namespace

NaturalUnits::NaturalUnits(const PhysicalPendulum<double>& p)
    : length(p.chain.reach() / static_cast<double>(p.chain.links())) {
    const auto& chain = p.chain;
    const double nu = p.pivot.frequency, mass = std::accumulate(chain.mass.begin(), chain.mass.end(), 0.0);
    const double unit = mass * chain.reach() / static_cast<double>(chain.links());
    double drive = nu * nu * std::hypot(p.pivot.x, p.pivot.y);
    for (const auto& motor : p.torques) drive += std::abs(motor.amplitude) / unit;
    double fastest = std::sqrt((std::abs(chain.gravity) + drive) / length);
    for (const double rate : chain.rate) fastest = std::max(fastest, std::abs(rate));
    time = fastest > 0 ? 1 / fastest : 1;
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

std::vector<SpectrumSample> lyapunov_spectrum(const PhysicalPendulum<double>& p, const SpectrumSpec& spec,
                                              const std::atomic<bool>& stop) {
    constexpr std::size_t max_links = 4;
    const std::size_t links = p.chain.links();
    if (links > max_links) throw bad_input("a spectrum is for 1 to {} links; there are {}", max_links, links);
    require_smooth(p);
    return links <= 2 ? estimates<4>(p, spec, stop) : estimates<2 * max_links>(p, spec, stop);
}

double pair_mismatch(const SpectrumSample& sample) {
    double worst = 0;
    const auto& all = sample.exponents;
    for (std::size_t i = 0; i < all.size() / 2; ++i)
        worst = std::max(worst, std::abs(all[i] + all[all.size() - 1 - i]));
    return worst;
}

}  // namespace doppel
