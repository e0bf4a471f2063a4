#include "analysis/exponent.hpp"
#include "analysis/tangent_series.hpp"
#include "base/error.hpp"
#include "integrate/taylor.hpp"
#include "physics/canonical.hpp"

#include <Eigen/Householder>

#include <algorithm>
#include <cmath>
#include <optional>

namespace doppel {
namespace {

/// frame = QR becomes Q, by Householder's reflections; returns |R_ii|. (Eigen's own QR by blocks, for large matrices, takes
/// seconds to compile.)
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

/// All tangents to a motion, kept upright: now and then their frame is turned into an orthonormal one, and what it has
/// stretched by is told in logarithms. Frames are canonical, (δθ, δp), where the flow keeps the volume: the logarithms
/// sum to 0 at any time.
/// Source  Shimada & Nagashima 1979, Progress of Theoretical Physics 61:1605; Benettin et al. 1980, Meccanica 15:21.
template <class Model, int N>
class Frame {
public:
    static constexpr int size = 2 * N;
    using Matrix = Eigen::MatrixXd;
    using Column = Eigen::VectorXd;

    Frame(const Pendulum<double>& p, double tolerance, const NaturalUnits& units)
        : model_(p.cast<Number>()), canonical_(model_), chain_{p} {
        double mass = 0;
        for (const double m : p.mass) mass += m;
        unit_.setOnes(size);
        unit_.tail(N).setConstant(mass * units.length * units.length / units.time);
        canonical_.momenta(Model::start(p.cast<Number>()), z_);
        motion_.emplace(chain_, tangents(Matrix::Identity(size, size)), tolerance);
    }

    /// What ln|δ_i| grow by in so many seconds.
    Column advance(double seconds) {
        motion_->advance(seconds);
        TangentFlow<Model>::to_dual(motion_->state(), y_);
        canonical_.momenta(y_, z_);
        Matrix frame(size, size);
        for (int i = 0; i < size; ++i) frame.row(i) = z_[i].tangent.transpose() / unit_[i];
        const Column stretched = orthonormalise(frame);
        motion_->reset(tangents(frame));
        return stretched.unaryExpr([](double factor) { return portable_log(factor); });
    }

private:
    using Number = typename Model::Scalar;

    using Chain = TangentChain<N>;

    /// The values of z with the frame's columns for tangents; angles without whole turns.
    typename Chain::State tangents(const Matrix& frame) {
        for (int i = 0; i < size; ++i) z_[i].tangent = unit_[i] * frame.row(i).transpose();
        canonical_.velocities(z_, y_);
        typename Chain::State all;
        TangentFlow<Model>::from_dual(y_, all);
        for (int i = 0; i < N; ++i) all[i] = std::remainder(all[i], 2 * pi);
        return all;
    }

    Model model_;
    Canonical<Model> canonical_;
    Chain chain_;
    std::optional<Taylor::Stepper<Chain>> motion_;
    Column unit_;  // of angles and momenta: 1 and N m s
    typename Model::State y_, z_;
};

template <class Model, int N>
std::vector<SpectrumSample> estimates(const Pendulum<double>& p, const SpectrumSpec& spec,
                                      const std::atomic<bool>& stop) {
    const NaturalUnits units(p);
    Frame<Model, N> frame(p, spec.tolerance, units);
    const double interval = spec.duration_s / spec.samples;
    const long parts = parts_of(interval, units);
    typename Frame<Model, N>::Column sum = Frame<Model, N>::Column::Zero(2 * N);
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

template <int N>
using DualChain = AngleChain<Dual<double, 2 * N>, N>;

}  // namespace

std::vector<SpectrumSample> lyapunov_spectrum(const Pendulum<double>& p, const SpectrumSpec& spec,
                                              const std::atomic<bool>& stop) {
    if (!(spec.duration_s > 0) || spec.samples < 1)
        throw bad_input("a spectrum takes a duration > 0 s and at least one sample; they are {} s and {}",
                        spec.duration_s, spec.samples);
    switch (p.links()) {
        case 1:
            return estimates<DualChain<1>, 1>(p, spec, stop);
        case 2:
            return estimates<DoublePendulum<Dual<double, 4>>, 2>(p, spec, stop);
        case 3:
            return estimates<DualChain<3>, 3>(p, spec, stop);
        case 4:
            return estimates<DualChain<4>, 4>(p, spec, stop);
        default:
            throw bad_input("a spectrum is for 1 to 4 links; there are {}", p.links());
    }
}

double pair_mismatch(const SpectrumSample& sample) {
    double worst = 0;
    const auto& all = sample.exponents;
    for (std::size_t i = 0; i < all.size() / 2; ++i)
        worst = std::max(worst, std::abs(all[i] + all[all.size() - 1 - i]));
    return worst;
}

}  // namespace doppel
