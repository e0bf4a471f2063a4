#include "peers.hpp"

#include "allocations.hpp"
#include "chain_rate.hpp"
#include "errors.hpp"
#include "integrate/flow.hpp"
#include "integrate/taylor.hpp"
#include "numeric/quad.hpp"
#include "physics/oracles.hpp"
#include "physics/pendulums.hpp"

#include <gtest/gtest.h>

// The methods of other libraries solve the same problem as ours, and meet the conditions of the comparison: identical
// runs, no allocations, and every evaluation counted.

namespace doppel {
namespace {

struct Problem {
    Pendulum<double> chain;
    double seconds;
};

const std::vector<Problem>& problems() {
    static const std::vector<Problem> all{
        {from_rest({90, 90}), 10}, {from_rest({30, 0}), 60}, {from_rest({150, 90}), 5}, {from_rest({120, 0, 0}), 5}};
    return all;
}

/// All numbers of the state at the end, by the Taylor method.
std::vector<double> truth(const Problem& problem) {
    using Chain = AngleChain<double, Eigen::Dynamic>;
    const auto end = end_of<Taylor, Chain>(problem.chain, problem.seconds, 1e-15);
    return {end.begin(), end.end()};
}

const std::atomic<bool> never = false;

/// Angles, then rates.
std::vector<double> state_of(const Motion& motion) {
    std::vector<double> state;
    const auto seen = motion.observe();
    for (const auto& bob : seen.bobs) state.push_back(bob.theta);
    for (const auto& bob : seen.bobs) state.push_back(bob.omega);
    return state;
}

double angle_error(const std::vector<double>& state, const std::vector<double>& truth) {
    double worst = 0;
    for (std::size_t i = 0; i < truth.size() / 2; ++i) worst = greater(worst, std::abs(state[i] - truth[i]));
    return worst;
}

double next_setting(const ExternalMethod& peer, double setting) {
    return setting * (peer.adaptive ? std::sqrt(0.1) : std::sqrt(0.5));
}

ExternalMethod peer_named(std::string_view name) {
    for (const auto& peer : all_peers())
        if (peer.name == name) return peer;
    throw bad_input("there is no peer {}", name);
}

/// The error for decreasing settings, until it is below `wanted`; otherwise the smallest one.
double converged(const ExternalMethod& peer, const Problem& problem, double wanted) {
    const auto exact = truth(problem);
    double minimum = pi;
    for (double setting = peer.maximum; setting >= 0.99 * peer.minimum; setting = next_setting(peer, setting)) {
        const auto code = test::thrown_by([&] {
                              const auto solver = peer.make(problem.chain, problem.seconds, setting);
                              solver->advance(never);
                              minimum = std::min(minimum, angle_error(state_of(*solver), exact));
                          }).first;
        EXPECT_TRUE(code == ExitCode::done || code == ExitCode::method_failed) << peer.name;
        if (minimum <= wanted) break;
    }
    return minimum;
}

TEST(Peers, ConvergeToOurs) {
    for (const auto& peer : all_peers())
        for (std::size_t i = 0; i < problems().size(); ++i)
            EXPECT_LE(converged(peer, problems()[i], 1e-9), 1e-9) << peer.name << ", P" << i + 1;
}

TEST(Peers, StepChainsOfAnyLength) {
    for (const auto& peer : all_peers())
        for (const auto& degrees : {std::vector<double>{100}, {60, 50, 40, 30}})
            EXPECT_LE(converged(peer, {from_rest(degrees), 2}, 1e-9), 1e-9) << peer.name << ", " << degrees.size();
}

TEST(Peers, RepeatARunToTheBitWithoutAllocating) {
    for (const auto& peer : all_peers())
        for (const auto& problem : problems()) {
            const auto solver = peer.make(problem.chain, 5, peer.adaptive ? 1e-8 : 0.01);
            solver->advance(never);
            const auto first = state_of(*solver);
            const auto [steps, evaluations, smallest] = solver->effort();
            EXPECT_GT(steps, 0) << peer.name;
            EXPECT_GT(evaluations, steps) << peer.name;
            const long before = allocations();
            solver->advance(never);
            const bool allocates = peer.name == "odeint bulirsch_stoer";  // try_step() allocates two vectors each time
            EXPECT_TRUE(allocates || allocations() == before) << peer.name;
            EXPECT_EQ(state_of(*solver), first) << peer.name;
            EXPECT_EQ(solver->effort().evaluations, evaluations) << peer.name;
            EXPECT_EQ(solver->effort().steps, steps) << peer.name;
        }
}

TEST(Peers, CountWhatTheyAskFor) {
    // the stages of the pair times the steps, plus some rejected steps: at most 5, measured
    const auto& problem = problems()[1];
    for (const auto& [name, stages] : {std::pair("odeint rkf78", 13), {"odeint dopri5", 6}, {"GSL rkf45", 6}}) {
        const auto solver = peer_named(name).make(problem.chain, 1, 1e-6);
        solver->advance(never);
        const auto [steps, evaluations, smallest] = solver->effort();
        EXPECT_GE(evaluations, stages * steps) << name;
        EXPECT_LE(evaluations, stages * (steps + 8)) << name;
    }
}

TEST(Peers, ReportWhereTheyFail) {
    for (const auto& [name, setting] : {std::pair("odeint adams 8", 0.1), {"GSL rkf45", 0.1}}) {
        const auto solver = peer_named(name).make(problems()[2].chain, 5, setting);
        EXPECT_EQ(test::thrown_by([&] { solver->advance(never); }).first, ExitCode::method_failed) << name;
    }
}

/// The error of the right-hand side of `p` against quad.
template <int N>
double rate_error(const Pendulum<double>& p) {
    using Exact = AngleChain<Quad, Eigen::Dynamic>;
    const auto wanted = rate_at_start<Exact>(p.cast<Quad>());

    const auto start = released_in_angles<double, Eigen::Dynamic>(p);
    std::vector<double> slope(start.size());
    ChainRate<N> rate(p);
    rate(start.data(), slope.data());
    EXPECT_EQ(rate.evaluations, 1);
    double worst = 0, scale = 0;
    for (std::size_t i = 0; i < slope.size(); ++i) {
        const auto want = static_cast<double>(wanted[static_cast<Eigen::Index>(i)]);
        worst = greater(worst, std::abs(slope[i] - want));
        scale = std::max(scale, std::abs(want));
    }
    return worst / scale;
}

TEST(ChainRate, IsTheMotionOfTheChain) {
    EXPECT_LE(rate_error<2>(uneven(2)), 1e-15);  // measured 5e-17, 5e-17, 1.2e-16
    EXPECT_LE(rate_error<3>(uneven(3)), 1e-15);
    EXPECT_LE(rate_error<Eigen::Dynamic>(uneven(5)), 1e-15);
}

}  // namespace
}  // namespace doppel
