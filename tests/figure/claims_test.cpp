// The claims of the study (Kao 2022), each measured, and the table of the results in docs/study.md:
//     DOPPEL_UPDATE_STUDY=1 build/release/tests/test_figure --gtest_filter=Claims.*

#include "analysis/difference.hpp"
#include "analysis/exponent.hpp"
#include "analysis/pair_batch.hpp"
#include "base/machine.hpp"
#include "numeric/dual.hpp"
#include "output/fixtures.hpp"
#include "scene/captions.hpp"
#include "scene/scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <utility>

namespace doppel::claims_test {

const std::atomic<bool> never = false;

enum class Verdict { holds, fails, misprinted };
constexpr const char* verdict_words[] = {"holds", "does not hold", "misprinted"};

/// What was measured, in words, and the verdict on the claim.
struct Found {
    Verdict verdict;
    std::string words;
};

// The study's initial conditions, in its units, and the measurements on them.

using SidePair = std::pair<SideSpec, SideSpec>;

/// Unit masses and lengths, released at rest, with the study's Euler steps.
SideSpec side(std::vector<Quad> angle_deg, ModelChoice model = ModelChoice::angles) {
    SideSpec spec;
    spec.set_links(angle_deg.size());
    spec.angle_deg = std::move(angle_deg);
    spec.model = model;
    return spec;
}

/// The same computed by Taylor series in quadruple precision.
SideSpec exactly(SideSpec spec) {
    spec.integrator = "taylor";
    spec.precision = Precision::in_quad;
    spec.tolerance = parse_quad("1e-26");
    return spec;
}

/// A pair whose upper links differ by 0.003°.
SidePair angle_pair(int theta1_deg, int theta2_deg = 0) {
    return {side({theta1_deg, theta2_deg}), side({theta1_deg + parse_quad("0.003"), theta2_deg})};
}

/// A pair of mass ratios `ratio` and `ratio` + 0.01.
SidePair mass_pair(int theta1_deg, int theta2_deg, double ratio) {
    auto twins = std::pair{side({theta1_deg, theta2_deg}), side({theta1_deg, theta2_deg})};
    twins.first.mass_kg[0] = ratio;
    twins.second.mass_kg[0] = ratio + 0.01;
    return twins;
}

/// The same beside the study's droplet.
SideSpec with_droplet(SideSpec spec) {
    spec.model = ModelChoice::mechanism;
    spec.forces.push_back({.kind = PartKind::droplet,
                           .position_m = QuadPair{1609, 0},
                           .mass_kg = parse_quad("0.000034"),
                           .constant_m3_per_kg_s2 = parse_quad("6.674e-11")});
    return spec;
}

/// The distances of a pair at samples 0 … count, up to the first above `enough`.
std::vector<double> distances(const SideSpec& a, const SideSpec& b, long count, double enough = INFINITY) {
    const auto scene = make_scene({.name = "study", .duration_s = *reduced(count, 120), .a = a, .b = b});
    PairRun run(scene);
    std::vector<double> all;
    while (static_cast<long>(all.size()) <= count && (all.empty() || all.back() <= enough))
        all.push_back(run.next(never).distance);
    return all;
}

/// The study's mean distances over 25 s.
std::vector<double> averages(const std::vector<SidePair>& sides, const MotionSpec& method = {}) {
    std::vector<PendulumPair> twins;
    for (const auto& [a, b] : sides) twins.push_back({chain_of(a).cast<double>(), chain_of(b).cast<double>()});
    std::vector<AverageLogRatio> means(twins.size());
    const auto watch = [&](std::size_t pair, long, const Bobs<double>& a, const Bobs<double>& b) {
        means[pair].add(state_space_distance(a, b));
    };
    step_pairs(twins, {.a = method, .b = method, .samples = 3000}, watch, never);
    std::vector<double> found;
    for (const auto& mean : means) found.push_back(mean.value());
    return found;
}

double largest(const std::vector<double>& values) {
    return *std::max_element(values.begin(), values.end());
}

Verdict holds_if(bool holds) {
    return holds ? Verdict::holds : Verdict::fails;
}

Found equations() {
    const auto start = side({120, 30}), rods = side({120, 30}, ModelChoice::constraints);
    return {
        Verdict::misprinted,
        fmt::format("cross terms ω₁ω₂ cancel and a denominator has the wrong unit in print; the program's equations "
                    "agree with particles on rods within {} after 2 s in quad",
                    scientific(largest(distances(exactly(start), exactly(rods), 240))))};
}

Found order_of_update() {
    auto [a, b] = angle_pair(20);
    a.integrator = b.integrator = "semi-implicit-euler";
    AverageLogRatio mean;
    for (const double distance : distances(a, b, 3000)) mean.add(distance);
    const double explicit_euler = averages({angle_pair(20)})[0], velocities_first = mean.value();
    return {holds_if(std::abs(velocities_first - 2.205) < std::abs(explicit_euler - 2.205)),
            fmt::format("the published curve has 2.205 at 20°: explicit Euler, positions by the old velocities, gives "
                        "{:.4f}; velocities first gives {:.4f}",
                        explicit_euler, velocities_first)};
}

Found constraint_row() {
    // ½ (x² + y² − r²) by dual numbers at (3, 4)
    using Variable = Dual<double, 4>;
    const Variable x = Variable::variable(3, 0), y = Variable::variable(4, 1);
    const Variable c = Variable(0.5) * (x * x + y * y - Variable(25.0));
    EXPECT_EQ(c.value, 0);
    return {
        Verdict::misprinted,
        fmt::format("it takes brackets, ½(x² + y² − r²); its row at (3, 4) is ({:g}, {:g}, {:g}, {:g}): (x₁, y₁, 0, 0)",
                    c.tangent[0], c.tangent[1], c.tangent[2], c.tangent[3])};
}

Found positive_means_chaos() {
    const auto average = averages({angle_pair(0), angle_pair(20)});
    const auto exponent = [&](int theta1_deg) {
        return largest_exponent(chain_of(side({theta1_deg, 0})).cast<double>(), {}, never);
    };
    const auto regular = exponent(20), chaotic = exponent(120);
    return {
        holds_if(!(average[1] > 0 && is_regular(regular))),
        fmt::format("the average of ln(d/d₀) is {:.2f} at 0° and {:.2f} at 20°, where the exponent is {:.3f} ± "
                    "{:.3f} 1/s, none; at 120° it is {:.2f} ± {:.2f} 1/s",
                    average[0], average[1], regular.value, regular.uncertainty, chaotic.value, chaotic.uncertainty)};
}

Found course_over_time() {
    const auto d = distances(side({90, 90}), side({parse_quad("90.003"), 90}), 3200);
    double sum = 0;
    for (std::size_t n = 2001; n < d.size(); ++n) sum += std::log(d[n] / d[0]);
    const double from_2001 = sum / static_cast<double>(d.size() - 2001);
    return {holds_if(std::abs(from_2001 - 11.5) < 0.6),
            fmt::format("{:.3f} at sample 501 (λ₅₀₀ of its list, which counts from 0 and begins with sample 1), and "
                        "{:.1f} on average from sample 2001 on",
                        std::log(d[501] / d[0]), from_2001)};
}

Found course_over_angle() {
    std::vector<SidePair> twins{angle_pair(40), angle_pair(80), angle_pair(108)};
    for (int angle = 115; angle < 180; angle += 5) twins.push_back(angle_pair(angle));
    const auto found = averages(twins);
    double sum = 0;
    for (std::size_t i = 3; i < found.size(); ++i) sum += found[i];
    const double from_115 = sum / static_cast<double>(found.size() - 3);
    return {holds_if(std::abs(found[0] - 2.9) < 0.2 && std::abs(found[1] - 4.3) < 1 && found[2] < from_115 - 3 &&
                     from_115 > 8 && from_115 < 10),
            fmt::format("{:.2f} at 40°, {:.1f} at 80°, {:.1f} at 108°, {:.1f} on average from 115° on", found[0],
                        found[1], found[2], from_115)};
}

Found figure3_axis() {
    const auto found = averages({mass_pair(130, 0, 1), mass_pair(150, 0, 1), mass_pair(170, 0, 1)});
    const double beyond_130 = (found[0] + found[1] + found[2]) / 3;
    EXPECT_NEAR(beyond_130, 5.6, 0.1);
    return {Verdict::misprinted,
            fmt::format("{:.1f} in ln, {:.1f} in log₁₀, beyond 130°: figure 3 left was printed in log₁₀", beyond_130,
                        beyond_130 / std::log(10.0))};
}

Found figure3_release() {
    const auto found = averages({mass_pair(90, 0, 0.5), mass_pair(90, 90, 0.5)});
    EXPECT_LT(found[0], found[1]);
    return {
        Verdict::misprinted,
        fmt::format("they come out with θ₂ = 90°; at mass ratio 0.5 the average is {:.1f} there and {:.1f} with θ₂ = 0",
                    found[1], found[0])};
}

Found figure6_release() {
    const auto parted = [&](int angle) {
        return largest(distances(side({angle, 0}), side({angle, 0}, ModelChoice::constraints), 4500));
    };
    const double from_30 = parted(30), from_45 = parted(45);
    return {std::abs(from_30 - 0.633) < 0.01 ? Verdict::holds : Verdict::misprinted,
            fmt::format("its greatest distance, 0.633, is that of 45° ({:.3f}); 30° gives {:.3f}", from_45, from_30)};
}

Found floating_point() {
    const auto parted = [&](const Rational& step) {
        auto a = side({50, 0}), b = side({50, 0}, ModelChoice::constraints);
        a.step_s = b.step_s = step;
        return largest(distances(a, b, 4500));
    };
    const auto a = side({50, 0}), b = side({50, 0}, ModelChoice::constraints);
    const double coarse = parted({1, 30000}), fine = parted({1, 120000});
    return {
        holds_if(fine > coarse / 2),
        fmt::format("a quarter of the step leaves a quarter of the distance, {:.3f} → {:.3f}: Euler's truncation; by "
                    "Taylor series in quad they stay within {} for 5 s",
                    coarse, fine, scientific(largest(distances(exactly(a), exactly(b), 600))))};
}

Found energy_gain() {
    const auto gain = [&](const SideSpec& spec) {
        const auto scene = make_scene({.name = "study", .duration_s = {75, 1}, .a = spec, .b = spec});
        SideRun run(scene, scene.a, 'a');
        Observation seen;
        for (long n = 0; n <= scene.samples; ++n) seen = run.next(never);
        return seen.energy_change;
    };
    auto exact = side({90, 90});
    exact.integrator = "taylor";
    const double euler = gain(side({90, 90})), taylor = gain(exact);
    return {holds_if(euler > 0),
            fmt::format("in 75 s at 90°/90° Euler gains {} J of 58.8; Taylor series, {} J: an error of the method",
                        scientific(euler), scientific(std::abs(taylor)))};
}

/// Greatest distance with and without the droplet within 75 s, and the time when it first exceeds 1, s; 0 = never.
std::pair<double, double> parted_by_droplet(int angle_deg) {
    const auto start = exactly(side({angle_deg, angle_deg}));
    const auto d = distances(with_droplet(start), start, 9000, 1);
    return {largest(d), d.back() > 1 ? static_cast<double>(d.size() - 1) / 120 : 0};
}

Found droplet_79() {
    const auto [parted, seen_s] = parted_by_droplet(79);
    return {holds_if(seen_s > 0), fmt::format("in quad the two stay within {} for 75 s. The study's run felt a force "
                                              "4·10⁷ times too great; double feels none at all",
                                              scientific(parted))};
}

Found droplet_90() {
    const auto [parted, seen_s] = parted_by_droplet(90);
    return {holds_if(seen_s > 0), fmt::format("in quad, from 90°/90°, the two have diverged after {:.0f} s", seen_s)};
}

Found three_links() {
    std::vector<SidePair> twins;
    for (std::size_t i = 0; i < pendulums_together / 2; ++i) {
        const int angle = static_cast<int>(20 * i);
        twins.emplace_back(side({angle, 0, 0}), side({angle + parse_quad("0.003"), 0, 0}));
    }
    const double start = seconds_of(CLOCK_THREAD_CPUTIME_ID);
    averages(twins, {.model = Model::constraints});
    constexpr double all = 181;
    const double figure8_s = (seconds_of(CLOCK_THREAD_CPUTIME_ID) - start) * all / static_cast<double>(twins.size());
    const auto chain = chain_of(side(std::vector<Quad>(16, 90))).cast<double>();
    return {holds_if(figure8_s > 5400),
            fmt::format("{:.1f} s of one core; the exponent of 16 links released level is {:.1f} 1/s", figure8_s,
                        largest_exponent(chain, {.duration_s = 50}, never).value)};
}

struct Claim {
    const char* words;  // short summary
    Found (*measure)();
};
/// In the study's order.
constexpr Claim claims[]{
    {"The accelerations in angles are as printed (eqs. 5, 6)", equations},
    {"Each step updates velocities first, then positions (eq. 7)", order_of_update},
    {"The constraint and the first row of its Jacobian are as printed (eqs. 9, 10)", constraint_row},
    {"λ > 0, hence chaos", positive_means_chaos},
    {"The pair of figure 2 left diverges until ln(d/d₀) saturates near 11.5", course_over_time},
    {"Figure 2 right rises to 2.8 by 40° and 4 by 80°, falls to 3–4 near 108°, then stays at 8–10", course_over_angle},
    {"Figures 3 left and 5 left share their scale", figure3_axis},
    {"Figures 3 and 5 right are released at θ₂ = 0", figure3_release},
    {"The lower curve of figure 6 is released at 30°", figure6_release},
    {"The two formulations diverge because of floating point and π", floating_point},
    {"The energy rises until the simulation fails", energy_gain},
    {"A raindrop a mile away is felt at 79°/79° (figure 7)", droplet_79},
    {"A raindrop a mile away is felt where the motion is chaotic", droplet_90},
    {"Figure 8 takes over an hour and a half, and more than three links are out of reach", three_links}};

/// The text of docs/study.md before and after the table.
constexpr const char* above =
    "# The study's claims\n\nJ. Kao, *Simulating Chaos in Deterministic Systems: The Double Pendulum*, 2022. Each "
    "claim is measured by a "
    "test\n(`tests/figure/claims_test.cpp`), which has made this table.\n\n| the study | measured | verdict "
    "|\n|---|---|---|\n";

TEST(Claims, AreMeasuredAsTheTableSays) {
    const std::string page = DOPPEL_SOURCE_DIR "/docs/study.md";
    const auto kept = test::bytes_of(page);
    std::string made = above;
    for (const auto& [words, measure] : claims) {
        const auto found = measure();
        const std::string verdict = verdict_words[static_cast<int>(found.verdict)];
        made += fmt::format("| {} | {} | {} |\n", words, found.words, verdict);
        const auto row = kept.find(fmt::format("| {} | ", words));
        ASSERT_NE(row, std::string::npos) << words;
        EXPECT_TRUE(kept.substr(row, kept.find('\n', row) - row).ends_with("| " + verdict + " |")) << made;
    }
    if (std::getenv("DOPPEL_UPDATE_STUDY")) test::write_bytes(page, made);
}

}  // namespace doppel::claims_test
