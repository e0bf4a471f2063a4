#include "integrate/methods.hpp"
#include "integrate/support.hpp"

#include <cmath>
#include <map>

namespace doppel {
namespace {

// Every method against a reference that two formulations certify: angles and constraints, both by Taylor series in
// quad, which share no equation of motion. Starts, masses and lengths are unequal ones.

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
        // particles know their angles up to whole turns
        const Quad difference = sin((reference[i] - again[i]) / 2) * 2;
        EXPECT_LT(abs(difference), parse_quad("1e-27")) << "the two formulations differ";  // measured 2e-29
    }
    return reference;
}

/// How a method is set for these cases, and the angle error it may make at most, rad.
struct Setting {
    long steps_per_s;  // of a fixed step
    double tolerance;  // of an adaptive method
    double most;       // about three times the worst measured
};

const std::map<std::string_view, Setting> settings{
    {"euler", {100'000, 0, 1.5e-2}},                // measured 3.6e-5 … 4.7e-3
    {"semi-implicit-euler", {100'000, 0, 4.5e-2}},  // 3.0e-6 … 1.5e-2
    {"midpoint", {20'000, 0, 1.5e-5}},              // 4.6e-9 … 5.0e-6
    {"rk4", {2'000, 0, 3e-7}},                      // 2.7e-14 … 1.0e-7
    {"dopri5", {0, 1e-9, 1e-6}},                    // 1.1e-9 … 3.6e-7
    {"dop853", {0, 1e-11, 1e-10}},                  // 1.3e-13 … 3.3e-11
    {"adams", {4'000, 0, 1e-12}},                   // 1.1e-14 … 3.7e-13
    {"gauss4", {2'000, 0, 2.5e-9}},                 // 5.1e-15 … 7.6e-10
    {"gauss6", {500, 0, 7e-10}},                    // 3.9e-16 … 2.4e-10
    {"taylor", {0, 1e-12, 5e-11}},                  // 6.8e-14 … 1.6e-11
    {"rattle", {20'000, 0, 4.5e-6}},                // 1.8e-10 … 1.4e-6
    {"rattle6", {1'000, 0, 1.2e-10}},               // 3.6e-15 … 3.8e-11
};

TEST(Reference, EveryMethodComesAsNearAsItShould) {
    for (const auto& [name, pendulum] : cases()) {
        const auto reference = certified(pendulum);
        for (const auto& method : methods()) {
            ASSERT_TRUE(settings.contains(method.name)) << "a method without a row: " << method.name;
            const auto& setting = settings.at(method.name);
            for (const auto& [model, serves] :
                 {std::pair{Model::angles, method.angles}, {Model::constraints, method.constraints}}) {
                if (!serves) continue;
                auto spec = spec_of(model, method.name, pendulum);
                spec.steps_per_sample = duration * setting.steps_per_s;
                spec.tolerance = setting.tolerance;
                const auto seen = Course(spec).advance(1);
                double error = 0;
                for (std::size_t i = 0; i < reference.size(); ++i)
                    error = std::max(error, std::abs(seen.bobs[i].theta - static_cast<double>(reference[i])));
                EXPECT_LT(error, setting.most) << name << ", " << method.name;
            }
        }
    }
}

}  // namespace
}  // namespace doppel
