#include "analysis/spectrum.hpp"

#include "analysis/exponent.hpp"
#include "analysis/tangent.hpp"
#include "base/error.hpp"
#include "physics/canonical.hpp"

#include <Eigen/Householder>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace doppel {
namespace {

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
