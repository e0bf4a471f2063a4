#include "analysis/stability.hpp"
#include "analysis/tangent.hpp"
#include "base/error.hpp"
#include "integrate/adams.hpp"
#include "integrate/methods.hpp"
#include "integrate/rattle.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace doppel {
namespace {

/// The larger eigenvalue in size of a matrix of determinant 1 and trace 2 · `half_trace`.
double unimodular_growth(double half_trace) {
    const double a = std::abs(half_trace);
    return a <= 1 ? 1 : a + std::sqrt((a - 1) * (a + 1));
}

using Eigenproblem = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;

/// The small oscillations of a chain about an equilibrium, where rod i has the cosine c_i = ±1: in the displacements of
/// the masses across the rods, times √m_k, they are those of masses on a string, with
///     κ_i = g c_i Σ_{j≥i} m_j / l_i ,   diagonal (κ_i + κ_{i+1}) / m_i ,   off it −κ_{i+1} / √(m_i m_{i+1}) .
Eigenproblem oscillations(const Pendulum<double>& p, const Eigen::VectorXd& cosine, int what) {
    const auto n = static_cast<Eigen::Index>(p.links());
    Eigen::VectorXd diagonal(n), below(n - 1);
    double hanging = 0, kappa_below = 0;  // kg, N/m
    for (Eigen::Index i = n - 1; i >= 0; --i) {
        const auto k = static_cast<std::size_t>(i);
        hanging += p.mass[k];
        const double kappa = p.gravity * cosine[i] * hanging / p.length[k];
        diagonal[i] = (kappa + kappa_below) / p.mass[k];
        if (i > 0) below[i - 1] = -kappa / std::sqrt(p.mass[k - 1] * p.mass[k]);
        kappa_below = kappa;
    }
    Eigenproblem problem(n);
    problem.computeFromTridiagonal(diagonal, below, what);
    return problem;
}

constexpr std::size_t adams_order = AdamsWeights::bashforth.size();
using Companion = Eigen::Matrix<std::complex<double>, adams_order, adams_order>;

/// Predict, evaluate, correct, evaluate on y′ = iω y, over the last eight y:
///     p = y_n + iz Σ_j b_j y_{n−j} ,   y_{n+1} = y_n + iz (c_0 p + Σ_{j>0} c_j y_{n+1−j})
Companion adams_step(double z) {
    const std::complex<double> iz(0, z);
    const auto b = [](std::size_t j) { return value<double>(AdamsWeights::bashforth[j]); };
    const auto c = [](std::size_t j) { return value<double>(AdamsWeights::moulton[j]); };
    Companion step = Companion::Zero();
    step(0, 0) = 1.0 + iz * c(0);
    for (std::size_t j = 0; j < adams_order; ++j) {
        const auto column = static_cast<Eigen::Index>(j);
        step(0, column) += iz * (iz * c(0) * b(j) + (j + 1 < adams_order ? c(j + 1) : 0.0));
        if (j > 0) step(column, column - 1) = 1;
    }
    return step;
}

/// The spectral radius, lim |Aⁿ|^(1/n) (Gelfand 1941), by squaring: what is left out shrinks like 2⁻ᵏ.
double adams_growth(double z) {
    Companion power = adams_step(z);
    double logarithm = 0;
    for (double share = 1; share > 1e-17; share /= 2) {
        const double norm = power.norm();
        logarithm += share * std::log(norm);
        power /= norm;
        power = power.lazyProduct(power).eval();
    }
    return std::exp(logarithm);
}

/// What is left of the amplitude after `steps` from the true motion: the roots that grow are not those that carry it,
/// and begin at the error of one step.
double adams_amplitude(double z, long steps) {
    Eigen::Matrix<std::complex<double>, adams_order, 1> past;
    for (std::size_t j = 0; j < adams_order; ++j)
        past[static_cast<Eigen::Index>(j)] = std::polar(1.0, -z * static_cast<double>(j));
    Companion power = adams_step(z);
    for (steps -= static_cast<long>(adams_order) - 1; steps > 0; steps /= 2) {
        if (steps % 2) past = power.lazyProduct(past).eval();
        power = power.lazyProduct(power).eval();
    }
    return std::abs(past[0]);
}

/// Leapfrogs of γz, one after another, each
///     ( 1 − z²/2           z     )
///     ( −z (1 − z²/4)   1 − z²/2 )
double composed_growth(double z) {
    const auto& half = Rattle6::fractions;
    std::array<double, 2 * half.size() + 1> part{};
    part[half.size()] = 1;
    for (std::size_t i = 0; i < half.size(); ++i) {
        part[i] = part[2 * half.size() - i] = static_cast<double>(parse_quad(half[i]));
        part[half.size()] -= 2 * part[i];
    }
    Eigen::Matrix2d all = Eigen::Matrix2d::Identity();
    for (const double fraction : part) {
        const double x = fraction * z, turn = 1 - x * x / 2;
        all = (Eigen::Matrix2d() << turn, x, -x * (1 - x * x / 4), turn).finished() * all;
    }
    return unimodular_growth(all.trace() / 2);
}

double leapfrog_growth(double z) {
    return unimodular_growth(1 - z * z / 2);
}
double stable(double) {
    return 1;
}

struct Growth {
    std::string_view method;
    double (*of)(double z);
    double (*amplitude)(double z, long steps) = nullptr;  // where it is not growth^steps

    double energy(double z, long steps) const {
        const double left = amplitude ? amplitude(z, steps) : std::pow(of(z), steps);
        return left * left;
    }
};

const std::array growths{Growth{"euler", [](double z) { return std::hypot(1, z); }},
                         Growth{"semi-implicit-euler", leapfrog_growth},
                         Growth{"midpoint", [](double z) { return std::hypot(1, z * z / 2); }},
                         Growth{"rk4",
                                [](double z) {
                                    const double z2 = z * z;
                                    return std::hypot(1 - z2 / 2 + z2 * z2 / 24, z - z * z2 / 6);
                                }},
                         Growth{"adams", adams_growth, adams_amplitude},
                         Growth{"gauss4", stable},
                         Growth{"gauss6", stable},
                         Growth{"rattle", leapfrog_growth},
                         Growth{"rattle6", composed_growth}};

const Growth& growth_of(std::string_view method) {
    const auto found = std::find_if(growths.begin(), growths.end(), [&](const auto& g) { return g.method == method; });
    if (found == growths.end()) throw bad_input("\"{}\" is not the name of a method with a fixed step", method);
    return *found;
}

}  // namespace

double growth(std::string_view method, double z) {
    return growth_of(method).of(z);
}

std::vector<Mode> small_oscillations(const Pendulum<double>& pendulum) {
    const auto n = static_cast<Eigen::Index>(pendulum.links());
    const auto solved = oscillations(pendulum, Eigen::VectorXd::Ones(n), Eigen::ComputeEigenvectors);
    // each mode is an oscillator by itself
    const auto amounts = [&](const std::vector<double>& values) -> Eigen::VectorXd {
        Eigen::VectorXd moved(n);
        double across = 0;
        for (std::size_t i = 0; i < values.size(); ++i) {
            across += pendulum.length[i] * values[i];
            moved[static_cast<Eigen::Index>(i)] = std::sqrt(pendulum.mass[i]) * across;
        }
        return solved.eigenvectors().transpose().lazyProduct(moved);
    };
    const Eigen::VectorXd angle = amounts(pendulum.angle), rate = amounts(pendulum.rate);
    const Eigen::VectorXd energy = solved.eigenvalues().cwiseProduct(angle.cwiseAbs2()) + rate.cwiseAbs2();
    const double total = energy.sum();
    std::vector<Mode> modes;
    for (Eigen::Index i = 0; i < n; ++i)
        modes.push_back({std::sqrt(solved.eigenvalues()[i]), total > 0 ? energy[i] / total : i + 1 == n ? 1.0 : 0.0});
    return modes;
}

double largest_frequency(const Pendulum<double>& pendulum) {
    return small_oscillations(pendulum).back().frequency;
}

std::optional<double> step_limit(std::string_view method, std::span<const Mode> modes, double seconds, double times) {
    const auto& growth = growth_of(method);
    const auto grows = [&](double step) {
        double energy = 0;
        for (const auto& [frequency, share] : modes)
            energy += share * growth.energy(frequency * step, std::lround(seconds / step));
        return !(energy < times);
    };
    double fastest = 0;
    for (const auto& mode : modes) fastest = std::max(fastest, mode.frequency);
    // from a step at which nothing has grown to one at which it has; then between them
    constexpr double first_z = 1e-3, ratio = 1.04;
    double stays = std::min(first_z / fastest, seconds / 2);
    while (grows(stays)) stays /= 2;
    while (!grows(stays * ratio)) {
        stays *= ratio;
        if (!(stays * ratio <= seconds)) return std::nullopt;
    }
    double fails = stays * ratio;
    constexpr double close = 1e-6;
    while (fails > stays * (1 + close)) {
        const double middle = std::sqrt(stays * fails);
        (grows(middle) ? fails : stays) = middle;
    }
    return fails;
}

namespace {

/// Of the links, where all are at rest, and upright or hanging to rounding (or g = 0).
std::optional<Eigen::VectorXd> equilibrium_cosines(const Pendulum<double>& p) {
    Eigen::VectorXd cosine(static_cast<Eigen::Index>(p.links()));
    for (std::size_t i = 0; i < p.links(); ++i) {
        const SinCos<double> turn(p.angle[i]);
        constexpr double rounding = 1e-14;
        if (p.rate[i] != 0 || (p.gravity != 0 && std::abs(turn.sin) > rounding)) return std::nullopt;
        cosine[static_cast<Eigen::Index>(i)] = turn.cos;
    }
    return cosine;
}

/// ∂(θ′, ω′)/∂(θ, ω) at the release of what is not driven.
Eigen::MatrixXd jacobian(const PhysicalPendulum<double>& p) {
    using Number = Dual<double, 1>;
    ChainWithoutWork<Number> chain(p.cast<Number>());
    auto y = chain.start(p.cast<Number>()), rate = y;
    Eigen::MatrixXd matrix(y.size(), y.size());
    for (Eigen::Index j = 0; j < y.size(); ++j) {
        y[j].tangent[0] = 1;
        chain.rate(y, rate);
        y[j].tangent[0] = 0;
        for (Eigen::Index i = 0; i < y.size(); ++i) matrix(i, j) = rate[i].tangent[0];
    }
    return matrix;
}

}  // namespace

/// √−κ for the least eigenvalue κ, or 0.
std::optional<double> equilibrium_exponent(const Pendulum<double>& p) {
    const auto cosine = equilibrium_cosines(p);
    if (!cosine) return std::nullopt;
    if (p.gravity == 0) return 0.0;
    return std::sqrt(std::max(0.0, -oscillations(p, *cosine, Eigen::EigenvaluesOnly).eigenvalues()[0]));
}

std::optional<double> equilibrium_exponent(const PhysicalPendulum<double>& p) {
    if (p.is_driven() || !equilibrium_cosines(p.chain)) return std::nullopt;
    if (p.chain.gravity == 0) return 0.0;
    const Eigen::VectorXcd values = jacobian(p).eigenvalues();
    const double most = values.real().maxCoeff();
    constexpr double rounding = 1e-12;  // what an oscillation without friction may seem to grow by
    return std::abs(most) < rounding * values.cwiseAbs().maxCoeff() ? 0 : most;
}

}  // namespace doppel
