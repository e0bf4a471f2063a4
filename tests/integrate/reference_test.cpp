#include "integrate/methods.hpp"
#include "integrate/support.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace doppel::reference_test {

// Every method against a reference confirmed by two formulations: angles and constraints, both by Taylor series in
// quad, which share no equation of motion. Starts, masses and lengths are unequal.

struct Case {
    const char* name;
    Pendulum<double> pendulum;
};

std::vector<Case> cases() {
    return {{"study", {{1, 1}, {1, 1}, {radians(90), radians(90)}, {0, 0}, 9.8}},
            {"unequal", {{1.7, 0.4}, {0.8, 1.3}, {radians(120), radians(-40)}, {0.5, -1}, 9.8}},
            {"light above", {{0.05, 1}, {0.6, 0.9}, {radians(60), radians(20)}, {0, 0}, 9.8}},
            {"moon", {{3, 1}, {2, 0.5}, {radians(170), radians(165)}, {0, 0}, 1.62}},
            {"triple", {{1, 2, 0.5}, {0.5, 0.7, 1.1}, {radians(120), radians(10), radians(-30)}, {0, 1, 0}, 9.8}},
            {"chain of six",
             {{1, 0.8, 0.6, 0.5, 0.4, 0.3},
              {0.3, 0.4, 0.5, 0.3, 0.2, 0.4},
              {1, 0.8, 0.5, 0.2, 0, -0.2},
              {0, 0, 0, 0, 0, 0},
              9.8}}};
}

constexpr long duration = 2;  // s

MotionSpec spec_of(Model model, std::string_view method, const Pendulum<double>& p) {
    auto spec = stepping(model, method, p, 1);
    spec.sample_interval = {duration, 1};
    return spec;
}

std::vector<Quad> exact_angles(const MotionSpec& spec) {
    std::vector<Quad> angles;
    for (const auto& bob : Course(spec).advance(1).exact) angles.push_back(bob.theta);
    return angles;
}

/// The angles at the end, to 27 digits.
std::vector<Quad> certified(const Pendulum<double>& p) {
    auto spec = spec_of(Model::angles, "taylor", p);
    spec.precision = Precision::in_quad;
    spec.tolerance = parse_quad("1e-29");
    const auto reference = exact_angles(spec);
    spec.model = Model::constraints;
    const auto again = exact_angles(spec);
    for (std::size_t i = 0; i < reference.size(); ++i) {
        // particles give their angles only modulo whole turns
        const Quad difference = sin((reference[i] - again[i]) / 2) * 2;
        EXPECT_LT(abs(difference), parse_quad("1e-28")) << "the two formulations differ";  // measured 2e-29
    }
    return reference;
}

/// The settings of a method for these cases.
struct Setting {
    long steps_per_s;  // with fixed steps
    double tolerance;  // of an adaptive method
};

const std::map<std::string_view, Setting> settings{
    {"euler", {100'000, 0}},   {"semi-implicit-euler", {100'000, 0}},
    {"midpoint", {20'000, 0}}, {"rk4", {2'000, 0}},
    {"dopri5", {0, 1e-9}},     {"dop853", {0, 1e-11}},
    {"adams", {4'000, 0}},     {"gauss4", {2'000, 0}},
    {"gauss6", {500, 0}},      {"taylor", {0, 1e-12}},
    {"rattle", {20'000, 0}},   {"rattle6", {1'000, 0}},
};

/// The measured maximum angle errors of a method at its setting, rad, for each case.
struct Measured {
    std::string_view method;
    Model model;
    std::array<double, 6> error;
};

// clang-format off
constexpr auto angles = Model::angles, constraints = Model::constraints;
constexpr Measured measured[]{
    //                                   study    unequal  light    moon     triple   six
    {"euler", angles,                   {2.1e-4,  1.2e-3,  1.9e-3,  3.6e-5,  1.2e-3,  4.6e-3}},
    {"euler", constraints,              {2.8e-4,  1.0e-3,  2.1e-3,  4.8e-5,  1.5e-3,  4.7e-3}},
    {"semi-implicit-euler", angles,     {2.1e-5,  5.5e-4,  3.1e-3,  1.3e-5,  6.5e-4,  3.0e-3}},
    {"semi-implicit-euler", constraints,{9.8e-5,  1.3e-3,  3.0e-3,  3.0e-6,  1.0e-3,  1.5e-2}},
    {"midpoint", angles,                {4.3e-8,  8.4e-8,  1.7e-7,  4.6e-9,  1.3e-7,  5.0e-6}},
    {"midpoint", constraints,           {3.2e-8,  1.4e-7,  2.0e-7,  6.1e-9,  1.8e-7,  5.0e-6}},
    {"rk4", angles,                     {3.2e-12, 2.8e-12, 8.0e-9,  2.7e-14, 4.7e-10, 2.1e-9}},
    {"rk4", constraints,                {2.1e-11, 3.9e-10, 1.0e-7,  6.9e-14, 7.3e-9,  4.8e-8}},
    {"dopri5", angles,                  {4.0e-9,  1.1e-9,  1.4e-8,  4.0e-9,  2.5e-9,  5.4e-8}},
    {"dopri5", constraints,             {3.9e-9,  2.4e-8,  6.6e-8,  7.0e-9,  2.6e-8,  3.6e-7}},
    {"dop853", angles,                  {1.4e-12, 1.7e-12, 9.0e-12, 2.4e-11, 7.1e-12, 2.8e-11}},
    {"dop853", constraints,             {1.3e-13, 3.7e-12, 8.2e-12, 3.3e-11, 4.1e-12, 1.2e-11}},
    {"adams", angles,                   {1.5e-14, 3.0e-14, 1.3e-14, 6.5e-14, 1.5e-14, 4.4e-14}},
    {"adams", constraints,              {1.9e-14, 8.6e-14, 2.8e-14, 1.0e-13, 1.8e-14, 9.9e-13}},
    {"gauss4", angles,                  {3.9e-13, 3.0e-12, 7.6e-10, 5.1e-15, 2.9e-11, 3.0e-10}},
    {"gauss6", angles,                  {3.9e-16, 1.4e-14, 2.4e-10, 1.1e-14, 8.2e-13, 3.4e-11}},
    {"taylor", angles,                  {1.2e-13, 1.4e-12, 9.0e-13, 1.5e-13, 3.5e-13, 2.0e-12}},
    {"taylor", constraints,             {8.0e-14, 2.9e-12, 1.3e-12, 6.8e-14, 3.5e-13, 1.6e-11}},
    {"rattle", constraints,             {3.7e-8,  7.7e-8,  2.2e-7,  1.8e-10, 1.3e-7,  1.4e-6}},
    {"rattle6", constraints,            {3.6e-13, 7.1e-13, 3.8e-11, 3.6e-15, 1.7e-13, 4.6e-12}},
};
// clang-format on

/// The allowed error: five times the measured one, and at least a few round-off errors of an angle.
double allowed(double error) {
    return std::max(5 * error, 5e-15);
}

TEST(Reference, EveryMethodReachesItsExpectedError) {
    for (std::size_t number = 0; number < cases().size(); ++number) {
        const auto reference = certified(cases()[number].pendulum);
        std::size_t rows = 0;
        for_each_combination([&](Model model, const MethodEntry& method) {
            const auto row = std::ranges::find_if(
                measured, [&](const Measured& m) { return m.method == method.name && m.model == model; });
            ASSERT_NE(row, std::end(measured)) << "a method without a row: " << method.name;
            ++rows;
            const auto& setting = settings.at(method.name);
            auto spec = spec_of(model, method.name, cases()[number].pendulum);
            spec.steps_per_sample = duration * setting.steps_per_s;
            spec.tolerance = setting.tolerance;
            const auto seen = Course(spec).advance(1);
            double error = 0;
            for (std::size_t i = 0; i < reference.size(); ++i)
                error = std::max(error, std::abs(seen.bobs[i].theta - static_cast<double>(reference[i])));
            EXPECT_LT(error, allowed(row->error[number])) << cases()[number].name;
        });
        EXPECT_EQ(rows, std::size(measured));
    }
}

}  // namespace doppel::reference_test
