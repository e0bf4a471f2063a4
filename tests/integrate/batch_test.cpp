#include "integrate/batch.hpp"

#include "errors.hpp"
#include "integrate/batch_kernel.hpp"
#include "integrate/widths.hpp"
#include "physics/angle_chain.hpp"
#include "physics/rod_chain.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace doppel {
namespace batch_test {

constexpr double step = 1.0 / 3000;
constexpr long steps = 300;  // more than the 256 after which Euler computes its sines anew

/// Trials with different numbers; the count is not a multiple of any register width.
std::vector<Pendulum<double>> some_trials(std::size_t links, std::size_t count = 11) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> some(0.5, 2);
    std::vector<Pendulum<double>> trials(count);
    for (auto& p : trials) {
        for (auto* quantity : {&p.mass, &p.length, &p.angle, &p.rate}) {
            quantity->clear();
            for (std::size_t i = 0; i < links; ++i) quantity->push_back(some(random));
        }
        p.gravity = 5 * some(random);
    }
    return trials;
}

template <class Which, class Model>
State<double, Eigen::Dynamic> alone(const Pendulum<double>& p) {
    Model model(p);
    typename Which::template Stepper<Model> stepper(model, Model::start(p), step);
    stepper.advance(steps);
    return stepper.state();
}

template <class Which, class Lone>
void expect_each_trial_as_alone(Model model, std::size_t links) {
    const auto trials = some_trials(links);
    for (const int width : register_widths()) {
        Batch batch(trials, model, Which::method.name, step, width);
        batch.advance(100);
        batch.advance(steps - 100);
        for (std::size_t i = 0; i < trials.size(); ++i)
            EXPECT_EQ(batch.state(i), (alone<Which, Lone>(trials[i])))
                << Which::method.name << ", width " << width << ", trial " << i;
    }
}

template <class Which>
void expect_all_models_as_alone() {
    expect_each_trial_as_alone<Which, DoublePendulum<double>>(Model::angles, 2);
    expect_each_trial_as_alone<Which, AngleChain<double, 3>>(Model::angles, 3);
    expect_each_trial_as_alone<Which, RodChain<double, 2>>(Model::constraints, 2);
    expect_each_trial_as_alone<Which, RodChain<double, 3>>(Model::constraints, 3);
}

TEST(Batch, ResultsEqualThoseOfSinglePendulumsAtEveryWidth) {
    expect_all_models_as_alone<Euler>();
    expect_all_models_as_alone<Rk4>();
}

TEST(Batch, UsesTheWidestRegisters) {
    const auto trials = some_trials(2);
    EXPECT_EQ(Batch(trials, Model::angles, "euler", step).width(), register_widths().back());
    EXPECT_EQ(Batch(trials, Model::angles, "euler", step, 2).width(), 2);
}

template <class Make>
std::string refusal(Make make) {
    const auto [code, said] = test::thrown_by(make);
    EXPECT_EQ(code, ExitCode::bad_input);
    return said;
}

TEST(Batch, RefusesUnsupportedPendulums) {
    const auto trials = some_trials(2);
    EXPECT_EQ(refusal([&] { Batch(trials, Model::angles, "dop853", step); }),
              "a batch needs two or three links and euler or rk4; it has 2 and dop853");
    EXPECT_EQ(refusal([&] { Batch(some_trials(4), Model::angles, "rk4", step); }),
              "a batch needs two or three links and euler or rk4; it has 4 and rk4");
    auto mixed = trials;
    mixed.back() = some_trials(3).back();
    EXPECT_EQ(refusal([&] { Batch(mixed, Model::angles, "euler", step); }),
              "all pendulums of a batch must have the same number of links; they have 2 and 3");
    refusal([&] { Batch({}, Model::angles, "euler", step); });
    refusal([&] { Batch(trials, Model::angles, "euler", step, 3); });
}

}  // namespace batch_test
}  // namespace doppel
