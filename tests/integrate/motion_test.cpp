#include "integrate/motion.hpp"

#include "errors.hpp"
#include "integrate/methods.hpp"
#include "integrate/registry.hpp"
#include "integrate/stabilise.hpp"
#include "integrate/support.hpp"
#include "physics/mechanism.hpp"
#include "physics/rod_chain.hpp"

#include <cmath>

namespace doppel::motion_test {

TEST(Methods, AreListedFromTheRegistry) {
    for (const auto& method : methods()) {
        for (const auto& [model, supports] :
             {std::pair{Model::angles, method.angles}, {Model::constraints, method.constraints}})
            for (const auto precision : {Precision::in_double, Precision::in_quad}) {
                auto spec = stepping(model, method.name, released(40, 70), 1000);
                spec.precision = precision;
                spec.tolerance = 1e-8;
                if (supports)
                    EXPECT_NEAR(Course(spec).advance(100).bobs[0].theta, 0.67993, 5e-4) << method.name;
                else
                    EXPECT_THROW(make_motion(spec), Error) << method.name;
            }
        EXPECT_EQ(find_method(method.name)->title, method.title);
    }
    EXPECT_THROW(make_motion(stepping(Model::angles, "ruler", released(40, 70), 1000)), Error);
    EXPECT_EQ(find_method("ruler"), nullptr);
}

TEST(RungeKutta4, KeepsAngularMomentumWithoutGravity) {
    for (const auto model : {Model::angles, Model::constraints}) {
        auto p = released(30, 100);
        p.mass = {1.5, 0.7};
        p.rate = {2, -3};
        p.gravity = 0;
        Course run(stepping(model, "rk4", p, 1000));
        // about the pivot, kg m²/s
        const auto momentum = [](const Observation& seen) {
            double sum = 0;
            for (const auto& bob : seen.bobs) sum += bob.mass * (bob.x * bob.vy - bob.y * bob.vx);
            return sum;
        };
        const double start = momentum(run.observe());
        EXPECT_NEAR(momentum(run.advance(10'000)), start, 5e-12);  // measured 3e-13, 8e-13
    }
}

TEST(Euler, LetsTheRodsDriftAsMuchAsWasMeasured) {
    // P1 of the study's scheme after 10 s: maximum rod error 3.8e-3 m, energy error 1.4e-3 J
    auto spec = stepping(Model::constraints, "euler", released(90, 90), 120);
    spec.steps_per_sample = 250;
    Course run(spec);
    double rod = 0;
    for (int sample = 0; sample < 1200; ++sample) rod = std::max(rod, run.advance(1).length_error);
    EXPECT_NEAR(rod, 3.8e-3, 0.1e-3);  // measured 3.82e-3
}

TEST(Motion, MirrorImageStaysTheMirrorImage) {
    for (const auto* method : {"euler", "rk4"})
        for (const auto model : {Model::angles, Model::constraints}) {
            const auto left = Course(stepping(model, method, released(-120, 35), 3000)).advance(15'000),
                       right = Course(stepping(model, method, released(120, -35), 3000)).advance(15'000);
            for (std::size_t link = 0; link < 2; ++link) {
                EXPECT_EQ(left.bobs[link].x, -right.bobs[link].x);
                EXPECT_EQ(left.bobs[link].y, right.bobs[link].y);
            }
        }
}

TEST(Motion, DoesNotDependOnHowAdvanceIsDivided) {
    for_each_combination([](Model model, const MethodEntry& method) {
        for (const auto& degrees : {std::vector{90.0, 90.0}, {90.0, -20.0, 50.0}, {60.0, 0.0, 10.0, 40.0}}) {
            if (method.adaptive) continue;
            auto spec = stepping(model, method.name, from_rest(degrees), 1024);  // 1/1024 is a double
            const auto often = Course(spec).advance(1024);
            spec.sample_interval = {1, 1};
            spec.steps_per_sample = 1024;
            const auto once = Course(spec).advance(1);
            for (std::size_t link = 0; link < degrees.size(); ++link) {
                EXPECT_EQ(once.bobs[link].x, often.bobs[link].x);
                EXPECT_EQ(once.bobs[link].omega, often.bobs[link].omega);
            }
        }
    });
}

/// One link, one turn ahead at the start, that rotates fast for `seconds`, in double or quad.
Observation whirl(Model model, std::string_view method, double degrees_a_second, Precision precision,
                  Rational seconds) {
    const Pendulum<double> p{{1}, {1}, {0.5 + 2 * pi}, {radians(degrees_a_second)}, 9.8};
    auto spec = stepping(model, method, p, 120);
    if (model == Model::mechanism) spec.parts = parts_of(*spec.chain);
    spec.precision = precision;
    spec.tolerance = parse_quad(precision == Precision::in_quad ? "1e-28" : "1e-13");
    spec.sample_interval = seconds;
    spec.steps_per_sample = product(seconds, {200'000, 1})->numerator;
    return Course(spec).advance(1);
}

TEST(Motion, CountsTurnsHoweverFastAndHoweverSeldomSampled) {
    for (const double rate : {95'000.0, -150'000.0, 400'000.0}) {
        const double truth = whirl(Model::angles, "taylor", rate, Precision::in_double, {1, 1}).bobs[0].theta;
        EXPECT_GT(std::abs(truth), 1500);
        for (const auto model : {Model::constraints, Model::mechanism})
            for (const auto method : {"taylor", "dop853", "rattle6"})
                EXPECT_NEAR(whirl(model, method, rate, Precision::in_double, {1, 1}).bobs[0].theta, truth, 1e-2)
                    << method << ", " << rate;  // measured 4e-3 for rattle6 at 400 000°/s
    }
}

TEST(Motion, CountsTurnsToAllDigitsOfQuad) {
    const auto truth = whirl(Model::angles, "taylor", 150'000, Precision::in_quad, {1, 50});
    for (const auto model : {Model::constraints, Model::mechanism}) {
        const auto seen = whirl(model, "taylor", 150'000, Precision::in_quad, {1, 50});
        const Quad apart = seen.exact[0].theta - truth.exact[0].theta;
        EXPECT_GT(seen.exact[0].theta, 50);
        EXPECT_LT(abs(apart), 1e-24);
        EXPECT_EQ(seen.bobs[0].theta, static_cast<double>(seen.exact[0].theta));
    }
}

TEST(Motion, RefusesStabilisationWithoutEffect) {
    using Chain = RodChain<double, 2>;
    static_assert(supports<Rattle, Chain> && supports<Rk4, Projected<Chain>> && supports<Rk4, Baumgarte<Chain>>);
    static_assert(!supports<Rattle, Projected<Chain>> && !supports<Rattle6, Baumgarte<Chain>>);
    const auto error = [](Model model, std::string_view method, Stabilise stabilise) {
        auto spec = stepping(model, method, released(40, 70), 1000);
        if (model == Model::mechanism) spec.parts = parts_of(*spec.chain);
        spec.stabilise = stabilise;
        return test::thrown_by([&] { make_motion(spec); });
    };
    const auto bad = [](const char* words) { return test::Thrown(ExitCode::bad_input, words); };
    for (const auto stabilise : {Stabilise::baumgarte, Stabilise::projection}) {
        for (const auto model : {Model::constraints, Model::mechanism}) {
            EXPECT_EQ(error(model, "rattle", stabilise),
                      bad("the method \"rattle\" keeps the constraints itself; there is nothing to stabilise"));
            EXPECT_EQ(error(model, "rk4", stabilise).first, ExitCode::done);
        }
        EXPECT_EQ(error(Model::angles, "rk4", stabilise),
                  bad("with angles as coordinates the rods have constant length; there is nothing to stabilise"));
    }
}

TEST(Motion, ProjectionKeepsTheRodsByEveryExplicitMethod) {
    for (const char* method : {"euler", "semi-implicit-euler", "midpoint", "rk4", "adams"}) {
        auto spec = stepping(Model::constraints, method, released(50, 20), 200);
        spec.stabilise = Stabilise::projection;
        EXPECT_LT(Course(spec).advance(200).length_error, 1e-15) << method;  // measured 1.1e-16
    }
}

TEST(Motion, CountsItsSteps) {
    Course run(stepping(Model::constraints, "rk4", released(50, 0), 100));
    run.advance(30);
    EXPECT_EQ(run.motion->effort().steps, 30);
    EXPECT_EQ(run.motion->effort().evaluations, 120);
    EXPECT_DOUBLE_EQ(run.motion->effort().smallest_step, 0.01);
}

/// The tension of the first of two rods, N: physics/angle_chain.hpp by elimination.
double at_release(const Pendulum<double>& p) {
    const double D = p.angle[1] - p.angle[0], c = std::cos(D), m = p.mass[0] + p.mass[1];
    const double pull1 = p.length[0] * p.rate[0] * p.rate[0] + p.gravity * std::cos(p.angle[0]);
    const double pull2 = p.length[1] * p.rate[1] * p.rate[1];
    return p.mass[0] * (m * pull1 + p.mass[1] * c * pull2) / (m - p.mass[1] * c * c);
}

TEST(Motion, ObservesRodTensionsOnRequest) {
    // one motion by three models, in two precisions, with and without projection; tensions of physics/rod_chain.hpp
    auto p = released(90, -20);
    p.mass = {1, 2.5};
    p.rate = {2, -3};
    std::vector<double> expected;
    for (const auto model : {Model::angles, Model::constraints, Model::mechanism})
        for (const auto precision : {Precision::in_double, Precision::in_quad})
            for (const auto stabilise : {Stabilise::none, Stabilise::projection}) {
                if (model == Model::angles && stabilise != Stabilise::none) continue;
                auto spec = stepping(model, "rk4", p, 1000);
                spec.precision = precision;
                spec.stabilise = stabilise;
                if (model == Model::mechanism) spec.parts = parts_of(p.cast<Quad>());
                EXPECT_TRUE(Course(spec).observe().tension.empty());
                spec.wants_tension = true;
                Course run(spec);
                EXPECT_NEAR(run.observe().tension[0], at_release(p), 5e-15);  // measured 7e-16
                const auto forces = run.advance(100).tension;
                if (expected.empty()) expected = forces;
                ASSERT_EQ(forces.size(), 2u);
                for (std::size_t k = 0; k < 2; ++k)
                    EXPECT_NEAR(forces[k], expected[k], 7e-10);  // measured 1.2e-10, the error of the steps
            }
}

TEST(Motion, InQuadKeepsWhatDoubleRoundsAway) {
    // two starts that are equal in double
    auto spec = stepping(Model::constraints, "rk4", released(50, 0), 1000);
    spec.precision = Precision::in_quad;
    auto twin = spec;
    twin.chain->angle[0] += parse_quad("1e-25");
    const auto a = Course(spec).advance(100), b = Course(twin).advance(100);
    EXPECT_EQ(a.bobs[0].x, b.bobs[0].x);
    const Quad apart = a.exact[0].x - b.exact[0].x;
    EXPECT_GT(abs(apart), 1e-26);
    EXPECT_LT(abs(apart), 5e-25);  // measured 6.7e-26
}

}  // namespace doppel::motion_test
