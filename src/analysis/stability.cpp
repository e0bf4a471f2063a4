#include "analysis/stability.hpp"

#include "analysis/watched_motion.hpp"
#include "base/error.hpp"
#include "integrate/adams.hpp"
#include "integrate/batch.hpp"
#include "integrate/methods.hpp"
#include "integrate/rattle.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <complex>

namespace doppel {
namespace {

/// The larger |eigenvalue| of a product of leapfrog steps of γz, each
///     ( 1 − z²/2           z     )
///     ( −z (1 − z²/4)   1 − z²/2 )
/// with γ those of the first half, the middle one that makes their sum 1, and those of the other half.
double leapfrog_growth(std::span<const std::string_view> first_half, double z) {
    Eigen::Matrix2d all = Eigen::Matrix2d::Identity();
    const auto add = [&](double fraction) {
        const double x = fraction * z, turn = 1 - x * x / 2;
        all = (Eigen::Matrix2d() << turn, x, -x * (1 - x * x / 4), turn).finished() * all;
    };
    std::vector<double> half;
    for (const auto fraction : first_half) half.push_back(static_cast<double>(parse_quad(fraction)));
    double middle = 1;
    for (const double fraction : half) middle -= 2 * fraction;
    std::for_each(half.begin(), half.end(), add);
    add(middle);
    std::for_each(half.rbegin(), half.rend(), add);
    const double half_trace = std::abs(all.trace() / 2);  // its determinant is 1
    return half_trace <= 1 ? 1 : half_trace + std::sqrt((half_trace - 1) * (half_trace + 1));
}

constexpr std::size_t adams_order = AdamsWeights::bashforth.size();

/// The amplitude of y′ = iω y after `steps` from exact initial values. The growing roots are not the one that
/// represents the solution; they start at the error of one step. Predict, evaluate, correct, evaluate with the last
/// eight y:
///     p = y_n + iz Σ_j b_j y_{n−j} ,   y_{n+1} = y_n + iz (c_0 p + Σ_{j>0} c_j y_{n+1−j})
double adams_amplitude(double z, long steps) {
    using Power = Eigen::Matrix<std::complex<double>, adams_order, adams_order>;
    const std::complex<double> iz(0, z);
    const auto b = [](std::size_t j) { return value<double>(AdamsWeights::bashforth[j]); };
    const auto c = [](std::size_t j) { return value<double>(AdamsWeights::moulton[j]); };
    Power power = Power::Zero();
    Eigen::Matrix<std::complex<double>, adams_order, 1> past;
    power(0, 0) = 1.0 + iz * c(0);
    for (std::size_t j = 0; j < adams_order; ++j) {
        const auto column = static_cast<Eigen::Index>(j);
        power(0, column) += iz * (iz * c(0) * b(j) + (j + 1 < adams_order ? c(j + 1) : 0.0));
        if (j > 0) power(column, column - 1) = 1;
        past[column] = std::polar(1.0, -z * static_cast<double>(j));
    }
    for (steps -= static_cast<long>(adams_order) - 1; steps > 0; steps /= 2) {
        if (steps % 2) past = power.lazyProduct(past).eval();
        power = power.lazyProduct(power).eval();
    }
    return std::abs(past[0]);
}

/// Updates `greatest` with one error; NaN is kept.
void take(double error, double& largest) {
    largest = error <= failure_error ? std::max(largest, error) : NAN;
}

/// For methods that integrate in SIMD lanes.
std::vector<double> side_by_side(const MotionSpec& spec, std::span<const Pendulum<Quad>> releases, long samples,
                                 const std::atomic<bool>& stop) {
    std::vector<Pendulum<double>> chains;
    for (const auto& release : releases) chains.push_back(release.cast<double>());
    Batch batch(chains, spec.model, spec.method, quotient(spec.sample_interval, {spec.steps_per_sample, 1})->value());
    std::vector<double> start, largest(chains.size(), 0);
    for (long n = 0; n <= samples; ++n) {
        throw_if_set(stop);
        if (n > 0) batch.advance(spec.steps_per_sample);
        for (std::size_t i = 0; i < chains.size(); ++i) {
            const auto& p = chains[i];
            const auto y = batch.state(i);
            const auto bobs = spec.model == Model::angles ? bobs_of_angles(p, y) : bobs_of_particles(p, y);
            const double now = energy(bobs, p.gravity);
            if (n == 0) start.push_back(now);
            take(std::abs(now - start[i]) / released_energy(p), largest[i]);
        }
    }
    return largest;
}

}  // namespace

double largest_real_part(const Eigen::MatrixXd& matrix) {
    constexpr double rounding = 1e-12;  // apparent growth of an undamped oscillation by rounding
    // like Eigen's eigenvalues() without vectors, at half the compile time
    const double scale = matrix.cwiseAbs().maxCoeff();
    const Eigen::HessenbergDecomposition<Eigen::MatrixXd> hessenberg(matrix / scale);
    Eigen::RealSchur<Eigen::MatrixXd> schur(matrix.rows());
    schur.computeFromHessenberg(hessenberg.matrixH(), Eigen::MatrixXd(), false);
    const Eigen::MatrixXd t = schur.matrixT() * scale;
    double maximum = -std::numeric_limits<double>::infinity();
    for (Eigen::Index i = 0; i < t.rows(); ++i) {
        const bool is_pair = i + 1 < t.rows() && t(i + 1, i) != 0;  // of complex eigenvalues
        maximum = std::max(maximum, is_pair ? t(i + 1, i + 1) + 0.5 * (t(i, i) - t(i + 1, i + 1)) : t(i, i));
        i += is_pair;
    }
    return std::abs(maximum) < rounding * scale ? 0 : maximum;
}

double energy_growth(std::string_view method, double z, long steps) {
    if (method.starts_with("gauss")) return 1;
    if (method == "adams") return std::norm(adams_amplitude(z, steps));
    double growth = 1;
    if (method == "rattle6")
        growth = leapfrog_growth(Rattle6::fractions, z);
    else if (method == "rattle" || method == "semi-implicit-euler")
        growth = leapfrog_growth({}, z);
    else {
        std::complex<double> term = 1, sum = 1;
        for (int k = 1; k <= find_method(method)->order; ++k) sum += term *= std::complex<double>(0, z / k);
        growth = std::abs(sum);
    }
    return std::pow(growth, 2 * steps);
}

std::vector<Mode> small_oscillations(const Pendulum<double>& p) {
    const auto n = static_cast<Eigen::Index>(p.links());
    Eigen::VectorXd diagonal(n), below(n - 1);
    double hanging = 0, kappa_below = 0;  // kg, N/m
    for (Eigen::Index i = n - 1; i >= 0; --i) {
        const auto k = static_cast<std::size_t>(i);
        hanging += p.mass[k];
        const double kappa = p.gravity * hanging / p.length[k];
        diagonal[i] = (kappa + kappa_below) / p.mass[k];
        if (i > 0) below[i - 1] = -kappa / std::sqrt(p.mass[k - 1] * p.mass[k]);
        kappa_below = kappa;
    }
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solved(n);
    solved.computeFromTridiagonal(diagonal, below, Eigen::ComputeEigenvectors);
    // each mode is an independent oscillator
    const auto amounts = [&](const std::vector<double>& values) -> Eigen::VectorXd {
        Eigen::VectorXd moved(n);
        double across = 0;
        for (std::size_t i = 0; i < values.size(); ++i) {
            across += p.length[i] * values[i];
            moved[static_cast<Eigen::Index>(i)] = std::sqrt(p.mass[i]) * across;
        }
        return solved.eigenvectors().transpose().lazyProduct(moved);
    };
    const Eigen::VectorXd angle = amounts(p.angle), rate = amounts(p.rate);
    const Eigen::VectorXd energy = solved.eigenvalues().cwiseProduct(angle.cwiseAbs2()) + rate.cwiseAbs2();
    const double total = energy.sum();
    std::vector<Mode> modes;
    for (Eigen::Index i = 0; i < n; ++i)
        modes.push_back({std::sqrt(solved.eigenvalues()[i]), total > 0 ? energy[i] / total : i + 1 == n ? 1.0 : 0.0});
    return modes;
}

std::optional<double> step_limit(std::string_view method, std::span<const Mode> modes, double seconds, double times) {
    const auto grows = [&](double step) {
        double energy = 0;
        for (const auto& [frequency, share] : modes)
            energy += share * energy_growth(method, frequency * step, std::lround(seconds / step));
        return !(energy < times);
    };
    double fastest = 0;
    for (const auto& mode : modes) fastest = std::max(fastest, mode.frequency);
    // increases the step until the error has grown, then bisects
    constexpr double first_z = 1e-3, ratio = 1.04, close = 1e-6;
    double stays = std::min(first_z / fastest, seconds / 2);
    while (grows(stays)) stays /= 2;
    while (!grows(stays * ratio)) {
        stays *= ratio;
        if (!(stays * ratio <= seconds)) return std::nullopt;
    }
    double fails = stays * ratio;
    while (fails > stays * (1 + close)) {
        const double middle = std::sqrt(stays * fails);
        (grows(middle) ? fails : stays) = middle;
    }
    return fails;
}

std::vector<double> max_energy_errors(MotionSpec spec, std::span<const Pendulum<Quad>> releases, long samples,
                                      const std::atomic<bool>& stop) {
    if (!releases.empty() && Batch::supports(spec.method, releases[0].links()))
        return side_by_side(spec, releases, samples, stop);
    std::vector<double> errors;
    for (const auto& release : releases) {
        spec.chain = release;
        const double scale = released_energy(release.cast<double>());
        const auto motion = make_motion(spec);
        auto& largest = errors.emplace_back(0);
        for (long n = 0; n < samples && !std::isnan(largest); ++n)
            take(advanced(*motion, stop) ? std::abs(motion->observe().energy_change) / scale : NAN, largest);
    }
    return errors;
}

}  // namespace doppel
