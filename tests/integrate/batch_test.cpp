#include "integrate/batch.hpp"

#include "errors.hpp"
#include "integrate/batch_kernel.hpp"
#include "integrate/flow.hpp"
#include "integrate/motion_batch.hpp"
#include "integrate/support.hpp"
#include "integrate/widths.hpp"
#include "physics/angle_chain.hpp"
#include "physics/pendulums.hpp"
#include "physics/rod_chain.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace doppel::batch_test {

constexpr double step = 1.0 / 3000;  // Euler uses series for some links' rotations, and sines for the faster ones
constexpr long steps = 300;          // more than the 256 after which Euler computes its sines anew

/// Trials with different numbers; the count is not a multiple of any register width.
std::vector<Pendulum<double>> some_trials(std::size_t links, std::size_t count = 11) {
    std::mt19937 random(7);
    std::vector<Pendulum<double>> trials;
    while (trials.size() < count) trials.push_back(random_pendulum(random, links));
    return trials;
}

template <class Which, class Lone>
void expect_each_trial_as_alone(Model model, std::size_t links) {
    const auto trials = some_trials(links);
    for (const int width : register_widths()) {
        Batch batch(trials, model, Which::method.name, step, width);
        batch.advance(100);
        batch.advance(steps - 100);
        for (std::size_t i = 0; i < trials.size(); ++i)
            EXPECT_EQ(batch.state(i), (after<Which, Lone>(trials[i], Lone::start(trials[i]), step, steps)))
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

/// Chains with releases one degree apart.
std::vector<MotionSpec> fan(Model model, std::string_view method, std::size_t links, std::size_t count) {
    std::vector<MotionSpec> specs;
    for (std::size_t k = 0; k < count; ++k) {
        Pendulum<double> p;
        p.mass.assign(links, 1.25);
        p.length.assign(links, 0.75);
        p.angle.assign(links, radians(170 - static_cast<double>(k)));
        p.rate.assign(links, 3.5);
        specs.push_back(stepping(model, method, p, 120));
        specs.back().steps_per_sample = 250;
        specs.back().tolerance = parse_quad("1e-10");
    }
    return specs;
}

/// Each motion equals its run alone, at the start and after many samples.
void expect_each_as_alone(const std::vector<MotionSpec>& specs, int jobs, int width, long samples = 6) {
    MotionBatch batch(specs, jobs);
    std::atomic<bool> never = false;
    ASSERT_EQ(batch.size(), specs.size());
    EXPECT_EQ(batch.width(), width);
    for (std::size_t k = 0; k < specs.size(); k += 5) EXPECT_EQ(batch.bobs(k), Course(specs[k]).observe().bobs);
    for (long n = 0; n < samples; ++n) batch.advance(never);
    for (std::size_t k = 0; k < specs.size(); k += 5) {
        SCOPED_TRACE(specs[k].method + ", motion " + std::to_string(k));
        EXPECT_EQ(batch.bobs(k), Course(specs[k]).advance(samples).bobs);
    }
}

TEST(MotionBatch, EachMotionEqualsThatAlone) {
    const int wide = register_widths().back();
    for (const auto model : {Model::angles, Model::constraints})
        for (const std::size_t links : {1u, 2u, 3u, 4u})
            expect_each_as_alone(fan(model, "euler", links, 70), 2, links == 2 || links == 3 ? wide : 1);
    expect_each_as_alone(fan(Model::angles, "rk4", 2, 70), 2, wide);
    expect_each_as_alone(fan(Model::constraints, "rk4", 2, 130), 3, wide);
    expect_each_as_alone(fan(Model::angles, "taylor", 2, 70), 2, 1);
    expect_each_as_alone(fan(Model::constraints, "rattle", 2, 70), 1, 1);
}

TEST(MotionBatch, CountsTurns) {
    // fast enough for full turns in both directions; the turns of single motions are tested against angles
    auto specs = fan(Model::constraints, "euler", 2, 30);
    for (std::size_t k = 0; k < specs.size(); ++k) specs[k].chain->rate = {Quad(15 - static_cast<int>(k)), Quad(0)};
    expect_each_as_alone(specs, 1, register_widths().back(), 200);
    for (auto& spec : specs) spec.follows_turns = false;
    expect_each_as_alone(specs, 1, register_widths().back(), 200);
}

TEST(MotionBatch, StepsOneByOneWhatIsNotSteppedAlike) {
    const auto specs = fan(Model::constraints, "euler", 2, 20);
    const auto expect_alone = [&](auto change) {
        auto changed = specs;
        change(changed[7]);
        expect_each_as_alone(changed, 2, 1, 3);
    };
    expect_alone([](MotionSpec& spec) { spec.model = Model::angles; });
    expect_alone([](MotionSpec& spec) { spec.method = "rk4"; });
    expect_alone([](MotionSpec& spec) { spec.precision = Precision::in_quad; });
    expect_alone([](MotionSpec& spec) { spec.stabilise = Stabilise::projection; });
    expect_alone([](MotionSpec& spec) { spec.steps_per_sample = 100; });
    expect_alone([](MotionSpec& spec) { spec.sample_interval = {1, 60}; });
    expect_alone([](MotionSpec& spec) { spec.follows_turns = false; });
    expect_alone([&](MotionSpec& spec) { spec.chain = fan(Model::constraints, "euler", 3, 1)[0].chain; });
}

TEST(MotionBatch, NamesTheFailedMotion) {
    // two of them fail in the same sample, in different groups: the error always names the first
    auto specs = fan(Model::constraints, "rattle", 2, 200);
    for (auto& spec : specs) spec.steps_per_sample = 1;
    for (const std::size_t k : {100u, 180u}) specs[k].chain->rate = {Quad(4000), Quad(-4000)};
    std::atomic<bool> stop = false;
    for (const int jobs : {1, 4}) {
        MotionBatch batch(specs, jobs);
        const auto [code, words] = test::thrown_by([&] { batch.advance(stop); });
        EXPECT_EQ(code, ExitCode::method_failed);
        EXPECT_EQ(words.find("pendulum 101 of 200: rattle: "), 0u) << words;
    }
    specs[50].method = "ruler";
    EXPECT_EQ(test::thrown_by([&] { MotionBatch(specs, 2); }),
              test::Thrown(ExitCode::bad_input, "pendulum 51 of 200: there is no method \"ruler\""));
    EXPECT_EQ(test::thrown_by([&] { MotionBatch({}, 2); }).first, ExitCode::bad_input);
}

TEST(MotionBatch, StopsWhenAsked) {
    std::atomic<bool> stop = true;
    for (const char* method : {"euler", "taylor"}) {
        MotionBatch batch(fan(Model::angles, method, 2, 10), 1);
        EXPECT_EQ(test::thrown_by([&] { batch.advance(stop); }), test::Thrown(ExitCode::interrupted, "interrupted"));
    }
}

}  // namespace doppel::batch_test
