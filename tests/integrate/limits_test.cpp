#include "allocations.hpp"
#include "errors.hpp"
#include "integrate/methods.hpp"
#include "integrate/support.hpp"
#include "physics/mechanisms.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

namespace doppel::limits_test {

// Closed forms and hard cases for every method, through the same interface as runs.

/// A method with settings for an error of about 1e-6 on motions of about a second.
MotionSpec fine(Model model, const MethodEntry& method, const Pendulum<double>& p, Rational interval) {
    auto spec = stepping(model, method.name, p, 1);
    spec.sample_interval = interval;
    const long rate = method.order == 1 ? 4'000'000 : method.order == 2 ? 20'000 : 1000;
    spec.steps_per_sample = std::max(1L, std::lround(static_cast<double>(rate) * interval.value()));
    spec.tolerance = parse_quad("1e-9");
    return spec;
}

TEST(Limits, TheExactEquilibriumStaysExactly) {
    for (const std::size_t links : {1u, 2u, 3u, 5u}) {
        auto p = uneven(links);
        p.angle.assign(links, 0);
        p.rate.assign(links, 0);
        for_each_combination([&](Model model, const MethodEntry& method) {
            auto spec = fine(model, method, p, {1, 100});
            spec.steps_per_sample = 10;
            Course course(spec);
            const auto start = course.observe(), end = course.advance(200);
            for (std::size_t i = 0; i < links; ++i) {
                EXPECT_EQ(end.bobs[i].x, 0) << links;
                EXPECT_EQ(end.bobs[i].vx, 0) << links;
                // heights are sums of rods, where round-off may cause motion; angles are independent of the heights
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
    for (const auto& [n, maximum] : {std::pair{1, 1e-20}, {2, 5e-19}, {3, 2e-18}, {6, 5e-18}, {12, 7e-18}}) {
        Eigen::MatrixXd mass(n, n), stiffness = Eigen::MatrixXd::Zero(n, n);
        for (int i = 0; i < n; ++i) {
            stiffness(i, i) = n - i;
            for (int j = 0; j < n; ++j) mass(i, j) = n - std::max(i, j);
        }
        const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(stiffness, mass);
        const auto roots = laguerre_roots(n);
        for (int mode = 0; mode < n; ++mode) {
            EXPECT_NEAR(modes.eigenvalues()[mode] / roots[mode], 1, 5e-14);  // measured 9e-15
            // g for a period of one second
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
                    EXPECT_NEAR(end.bobs[static_cast<std::size_t>(i)].theta, shape[i], maximum) << n << ", " << mode;
            }
        }
    }
}

TEST(Limits, AVanishingUpperMassIsSimulatedOrRefused) {
    // m1 → 0 with aligned links: the condition number of J M⁻¹ Jᵀ grows as 4 m2/m1, and the motion becomes stiff
    const std::map<std::string_view, double> maximum{
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
                // either accurate, or so wrong that the checks detect it
                const double scale = p.potential_range();
                EXPECT_TRUE(error < 1e-3 || !(std::abs(seen.energy_change) < 1e-4 * scale))
                    << m1 << ": " << error << " m, " << seen.energy_change << " J";
                if (method.adaptive) {
                    EXPECT_LT(error, maximum.at(method.name)) << m1;
                }
            } catch (const Error& error) {
                EXPECT_EQ(error.code(), ExitCode::method_failed) << error.what();
                EXPECT_FALSE(method.adaptive) << error.what();
            }
        });
    }
}

TEST(Limits, ToleranceBelowRoundingIsRefusedWithWhatCanBeHad) {
    for (const auto& method : methods()) {
        if (!method.adaptive) continue;
        const auto refusal = [&](Precision precision, const Quad& tolerance) {
            auto spec = stepping(Model::angles, method.name, released(90, 90), 1);
            spec.precision = precision;
            spec.tolerance = tolerance;
            return test::thrown_by([&] { make_motion(spec); });
        };
        for (const auto& [precision, tolerance, words] :
             {std::tuple{Precision::in_double, "1e-16", "1e-16 is too small for 16 digits; it must be at least 9e-16"},
              {Precision::in_quad, "1e-34", "1e-34 is too small for 34 digits; it must be at least 8e-34"}})
            EXPECT_EQ(refusal(precision, parse_quad(tolerance)),
                      test::Thrown(ExitCode::bad_input, fmt::format("{}: tolerance = {}", method.name, words)));
        for (const double tolerance : {1e-17, 0.0, -1.0, std::nan("")})
            EXPECT_EQ(refusal(Precision::in_double, tolerance).first, ExitCode::bad_input) << method.name << tolerance;
        EXPECT_EQ(refusal(Precision::in_quad, 1e-32).first, ExitCode::done) << method.name;
    }
}

TEST(Limits, NothingIsAllocatedInTheStepLoop) {
    // the allocations per sample are independent of the number of steps
    const auto expect_none = [](MotionSpec spec) {
        const auto allocated = [&](long steps, const char* tolerance) {
            spec.steps_per_sample = steps;
            spec.tolerance = parse_quad(tolerance);
            Course course(spec);
            course.advance(2);
            const long before = allocations();
            course.motion->advance(course.never);
            return allocations() - before;
        };
        EXPECT_EQ(allocated(1, "1e-3"), allocated(50, "1e-12"));
    };
    for_each_combination([&](Model model, const MethodEntry& method) {
        for (const std::size_t links : {2u, 3u, 7u})  // with many steps in a sample also if they are chosen
            expect_none(stepping(model, method.name, from_rest(std::vector(links, 86.0)), method.adaptive ? 1 : 1000));
        auto spec = stepping(model, method.name, from_rest({20}), 1000);
        for (const auto precision : {Precision::in_double, Precision::in_quad}) {
            spec.precision = precision;
            if (model == Model::angles) {
                spec.physical = driven_bodies<Quad>(4);
                spec.chain = spec.physical->chain;
            } else if (method.mechanism) {
                spec.model = Model::mechanism;
                spec.chain.reset();
                spec.parts = of_everything().cast<Quad>();
            }
            expect_none(spec);
        }
    });
}

}  // namespace doppel::limits_test
