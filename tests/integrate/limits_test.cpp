#include "allocations.hpp"
#include "base/error.hpp"
#include "integrate/methods.hpp"
#include "integrate/support.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string_view>

namespace doppel {
namespace limits_test {

// Closed forms and hard cases that every method meets, by the door that runs go through.

Pendulum<double> simple(double angle, double gravity) {
    return {{1}, {1}, {angle}, {0}, gravity};
}

/// A method at settings that leave it an error of some 1e-6 on motions of about a second.
MotionSpec fine(Model model, const MethodEntry& method, const Pendulum<double>& p, Rational interval) {
    auto spec = stepping(model, method.name, p, 1);
    spec.sample_interval = interval;
    const long rate = method.order == 1 ? 4'000'000 : method.order == 2 ? 20'000 : 1000;
    spec.steps_per_sample = std::max(1L, std::lround(static_cast<double>(rate) * interval.value()));
    spec.tolerance = parse_quad("1e-9");
    return spec;
}

/// Calls visit(model, method) for every method and each of the two models of chains that it serves.
template <class Visit>
void for_each_combination(const Visit& visit) {
    for (const auto& method : methods()) {
        SCOPED_TRACE(method.name);
        if (method.angles) visit(Model::angles, method);
        if (method.constraints) visit(Model::constraints, method);
    }
}

/// Gauss 1799: the period of a pendulum of amplitude A is 2π √(l/g) / agm(1, cos(A/2)).
double gravity_for_period_one(double amplitude) {
    double a = 1, b = std::cos(amplitude / 2);
    for (int i = 0; i < 8; ++i) {
        const double mean = (a + b) / 2;
        b = std::sqrt(a * b);
        a = mean;
    }
    return std::pow(2 * pi / a, 2);
}

/// What was measured of a method at the settings of fine().
struct Measured {
    std::string_view method;
    Model model;
    std::array<double, 3> theta, omega;  // rad, rad/s: after a period from 10°, 90° and 150°
    double fallen;                       // of the inverted state, relative
};

// clang-format off
constexpr auto angles = Model::angles, constraints = Model::constraints;
constexpr Measured measured[]{
    {"euler", angles,                    {8.6e-7,  9.2e-6,  3.3e-5},  {6.5e-8,  5.8e-5,  6.5e-4},  3.8e-6},
    {"euler", constraints,               {8.5e-7,  1.6e-10, 6.8e-5},  {3.2e-7,  1.7e-4,  7.4e-4},  2.4e-6},
    {"semi-implicit-euler", angles,      {1.2e-15, 6.9e-15, 2.3e-14}, {6.5e-13, 7.0e-13, 1.8e-11}, 9.6e-7},
    {"semi-implicit-euler", constraints, {1.5e-8,  1.4e-5,  1.5e-4},  {1.3e-7,  9.3e-10, 2.7e-3},  3.9e-7},
    {"midpoint", angles,                 {4.2e-12, 4.3e-11, 3.9e-10}, {1.1e-7,  6.5e-7,  4.5e-7},  3.9e-8},
    {"midpoint", constraints,            {4.3e-12, 8.2e-11, 1.5e-9},  {1.1e-7,  2.2e-7,  3.5e-6},  2.6e-8},
    {"rk4", angles,                      {7.4e-14, 1.3e-12, 4.0e-11}, {8.9e-11, 6.5e-10, 3.8e-9},  2.5e-8},
    {"rk4", constraints,                 {1.6e-14, 8.7e-9,  5.2e-7},  {9.0e-11, 3.2e-9,  6.6e-6},  4.4e-10},
    {"dopri5", angles,                   {6.5e-10, 3.4e-9,  4.3e-9},  {6.3e-10, 1.4e-8,  8.6e-8},  7.8e-5},
    {"dopri5", constraints,              {8.7e-10, 2.9e-9,  2.7e-8},  {1.8e-9,  1.0e-8,  4.1e-7},  8.6e-5},
    {"dop853", angles,                   {1.6e-11, 1.1e-10, 3.5e-10}, {3.5e-10, 3.7e-10, 6.4e-9},  2.4e-4},
    {"dop853", constraints,              {5.1e-11, 7.0e-10, 8.2e-9},  {1.1e-10, 2.3e-9,  1.1e-7},  8.3e-5},
    {"adams", angles,                    {2.8e-17, 6.7e-16, 9.8e-15}, {1.3e-15, 6.8e-15, 1.6e-13}, 2.5e-8},
    {"adams", constraints,               {2.8e-17, 1.0e-14, 2.5e-14}, {8.7e-16, 1.4e-14, 1.7e-13}, 4.3e-10},
    {"gauss4", angles,                   {8.3e-17, 0,       4.9e-15}, {1.5e-11, 7.7e-11, 7.7e-10}, 3.8e-10},
    {"gauss6", angles,                   {8.3e-17, 0,       4.9e-15}, {8.7e-14, 7.0e-15, 5.6e-12}, 4.3e-10},
    {"taylor", angles,                   {7.9e-12, 2.7e-10, 1.0e-9},  {6.1e-11, 1.9e-9,  1.7e-8},  4.6e-10},
    {"taylor", constraints,              {2.0e-12, 2.4e-11, 1.9e-10}, {1.1e-12, 1.6e-10, 2.1e-9},  4.3e-10},
    {"rattle", constraints,              {2.6e-14, 4.4e-16, 8.5e-14}, {3.0e-8,  1.1e-6,  3.1e-6},  6.8e-9},
    {"rattle6", constraints,             {7.8e-16, 4.4e-15, 2.7e-14}, {1.3e-15, 2.2e-13, 3.1e-12}, 4.3e-10},
};
// clang-format on

const Measured& measured_of(Model model, const MethodEntry& method) {
    const auto row =
        std::ranges::find_if(measured, [&](const Measured& m) { return m.method == method.name && m.model == model; });
    if (row == std::end(measured)) throw std::logic_error("a method without a row: " + std::string(method.name));
    return *row;
}

/// What an error may be: five times the measured one, and no less than some roundings.
double allowed(double error) {
    return std::max(5 * error, 1e-14);
}

TEST(Limits, EveryMethodReturnsAfterTheExactPeriod) {
    constexpr std::array amplitudes_deg{10.0, 90.0, 150.0};
    for (std::size_t i = 0; i < amplitudes_deg.size(); ++i) {
        const double amplitude = radians(amplitudes_deg[i]);
        const auto p = simple(amplitude, gravity_for_period_one(amplitude));
        for_each_combination([&](Model model, const MethodEntry& method) {
            const auto end = Course(fine(model, method, p, {1, 1})).advance(1).bobs[0];
            // a period later the error is second order in the phase; the rate shows it in the first
            const auto& row = measured_of(model, method);
            EXPECT_NEAR(end.theta, amplitude, allowed(row.theta[i])) << amplitudes_deg[i];
            EXPECT_NEAR(end.omega, 0, allowed(row.omega[i])) << amplitudes_deg[i];
        });
    }
}

TEST(Limits, EveryMethodLeavesTheInvertedStateAtItsRate) {
    // θ = π − δ: δ″ = (g/l) δ, so δ(t) = δ0 cosh(√(g/l) t)
    constexpr double start = 1e-7, seconds = 2;
    const auto p = simple(pi - start, 9.8);
    const double expected = start * std::cosh(std::sqrt(9.8) * seconds);
    for_each_combination([&](Model model, const MethodEntry& method) {
        const double fallen = pi - Course(fine(model, method, p, {2, 1})).advance(1).bobs[0].theta;
        // the pairs' tolerance is 1e-9 rad of 1e-7
        EXPECT_NEAR(fallen / expected, 1, allowed(measured_of(model, method).fallen));
    });
}

TEST(Limits, TheExactEquilibriumStaysExactly) {
    for (const std::size_t links : {1u, 2u, 3u, 5u}) {
        Pendulum<double> p{{}, {}, {}, {}, 9.8};
        for (std::size_t i = 0; i < links; ++i) {
            p.mass.push_back(1 + 0.25 * static_cast<double>(i));
            p.length.push_back(1 - 0.125 * static_cast<double>(i));
            p.angle.push_back(0);
            p.rate.push_back(0);
        }
        for_each_combination([&](Model model, const MethodEntry& method) {
            auto spec = fine(model, method, p, {1, 100});
            spec.steps_per_sample = 10;
            Course course(spec);
            const auto start = course.observe(), end = course.advance(200);
            for (std::size_t i = 0; i < links; ++i) {
                EXPECT_EQ(end.bobs[i].x, 0) << links;
                EXPECT_EQ(end.bobs[i].vx, 0) << links;
                // heights are sums of rods, whose rounding may push them; angles know no height
                EXPECT_NEAR(end.bobs[i].y, start.bobs[i].y, model == Model::angles ? 0 : 1e-12)
                    << links;  // measured 2.2e-13
            }
        });
    }
}

/// The roots of the Laguerre polynomial L_N, ascending: the eigenvalues of its Jacobi matrix (Golub & Welsch 1969).
Eigen::VectorXd laguerre_roots(int n) {
    Eigen::MatrixXd jacobi = Eigen::MatrixXd::Zero(n, n);
    for (int i = 0; i < n; ++i) {
        jacobi(i, i) = 2 * i + 1;
        if (i + 1 < n) jacobi(i, i + 1) = jacobi(i + 1, i) = i + 1;
    }
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(jacobi).eigenvalues();
}

TEST(Limits, EqualLinksSwingInTheModesOfLaguerre) {
    // small angles: M θ″ = −K θ with M_ij = N + 1 − max(i, j), K_ii = N + 1 − i (unit masses and lengths, times g):
    // ω² = g · root. A mode of amplitude 1e-6 is back after its period, with an error of amplitude².
    // measured 1.3e-21, 6.1e-20, 3.6e-19, 8.0e-19, 1.2e-18
    for (const auto& [n, most] : {std::pair{1, 1e-20}, {2, 5e-19}, {3, 2e-18}, {6, 5e-18}, {12, 7e-18}}) {
        Eigen::MatrixXd mass(n, n), stiffness = Eigen::MatrixXd::Zero(n, n);
        for (int i = 0; i < n; ++i) {
            stiffness(i, i) = n - i;
            for (int j = 0; j < n; ++j) mass(i, j) = n - std::max(i, j);
        }
        const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(stiffness, mass);
        const auto roots = laguerre_roots(n);
        for (int mode = 0; mode < n; ++mode) {
            EXPECT_NEAR(modes.eigenvalues()[mode] / roots[mode], 1, 5e-14);  // measured 9e-15
            // g such that the period is a second
            Pendulum<double> p{{}, {}, {}, {}, std::pow(2 * pi, 2) / roots[mode]};
            const Eigen::VectorXd shape = 1e-6 * modes.eigenvectors().col(mode).normalized();
            p.mass.assign(static_cast<std::size_t>(n), 1);
            p.length = p.mass;
            p.rate.assign(static_cast<std::size_t>(n), 0);
            p.angle.assign(shape.data(), shape.data() + n);
            for (const auto model : {Model::angles, Model::constraints}) {
                auto spec = stepping(model, "taylor", p, 1);
                spec.tolerance = parse_quad("1e-14");
                const auto end = Course(spec).advance(1);
                for (int i = 0; i < n; ++i)
                    EXPECT_NEAR(end.bobs[static_cast<std::size_t>(i)].theta, shape[i], most) << n << ", " << mode;
            }
        }
    }
}

TEST(Limits, AVanishingUpperMassIsReachedOrRefused) {
    // m1 → 0 with the links aligned: the condition of J M⁻¹ Jᵀ grows like 4 m2/m1, and the motion becomes stiff
    const std::map<std::string_view, double> most{
        {"dopri5", 2e-10}, {"dop853", 2e-10}, {"taylor", 5e-12}};  // m; measured 3.5e-11, 2.8e-11, 8.4e-13
    for (const double m1 : {1e-2, 1e-4, 1e-6}) {
        Pendulum<double> p{{m1, 1}, {0.5, 0.5}, {radians(60), radians(60)}, {0, 0}, 9.8};
        auto spec = stepping(Model::angles, "taylor", p, 1);
        spec.sample_interval = {1, 4};
        spec.tolerance = parse_quad("1e-20");
        spec.precision = Precision::in_quad;
        const auto truth = Course(spec).advance(1);
        for_each_combination([&](Model model, const MethodEntry& method) {
            auto tried = fine(model, method, p, {1, 4});
            try {
                const auto seen = Course(tried).advance(1);
                const double error = std::abs(seen.bobs[1].x - truth.bobs[1].x);
                // right, or so wrong that the watch sees it: no quiet in-between
                const double scale = p.potential_range();
                EXPECT_TRUE(error < 1e-3 || !(std::abs(seen.energy_change) < 1e-4 * scale))
                    << m1 << ": " << error << " m, " << seen.energy_change << " J";
                if (method.adaptive) {
                    EXPECT_LT(error, most.at(method.name)) << m1;
                }
            } catch (const Error& fault) {
                EXPECT_EQ(fault.code(), ExitCode::method_failed) << fault.what();
                EXPECT_FALSE(method.adaptive) << fault.what();
            }
        });
    }
}

TEST(Limits, ToleranceBelowRoundingIsRefusedWithWhatCanBeHad) {
    for (const auto& method : methods()) {
        if (!method.adaptive) continue;
        for (const auto& [precision, digits, finest] :
             {std::tuple{Precision::in_double, "1e-16", "9e-16"}, {Precision::in_quad, "1e-34", "8e-34"}}) {
            auto spec = stepping(Model::angles, method.name, released(90, 90), 1);
            spec.precision = precision;
            spec.tolerance = parse_quad(digits);
            try {
                make_motion(spec);
                ADD_FAILURE() << method.name << " took a tolerance of " << digits;
            } catch (const Error& fault) {
                EXPECT_EQ(fault.code(), ExitCode::bad_input);
                EXPECT_NE(std::string(fault.what()).find(finest), std::string::npos) << fault.what();
            }
        }
    }
}

TEST(Limits, NothingIsAllocatedInTheStepLoop) {
    for_each_combination([&](Model model, const MethodEntry& method) {
        for (const std::size_t links : {2u, 3u, 7u}) {
            Pendulum<double> p{{}, {}, {}, {}, 9.8};
            for (auto* values : {&p.mass, &p.length}) values->assign(links, 1);
            p.angle.assign(links, 1.5);
            p.rate.assign(links, 0);
            // what a sample allocates is the same, however many steps lead to it
            const auto allocated = [&](long steps, const char* tolerance) {
                auto spec = stepping(model, method.name, p, 1000);
                spec.steps_per_sample = steps;
                spec.tolerance = parse_quad(tolerance);
                Course course(spec);
                course.advance(2);
                const long before = allocations();
                course.motion->advance(course.never);
                return allocations() - before;
            };
            EXPECT_EQ(allocated(1, "1e-3"), allocated(50, "1e-12")) << links;
        }
    });
}

}  // namespace limits_test
}  // namespace doppel
