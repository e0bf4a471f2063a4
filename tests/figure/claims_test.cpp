
#include "analysis/exponent.hpp"
#include "base/clock.hpp"
#include "figure/audit.hpp"
#include "numeric/dual.hpp"
#include "scene/captions.hpp"
#include "scene/scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace doppel {
namespace {

double greatest(const std::vector<double>& values) {
    return *std::max_element(values.begin(), values.end());
}

Verdict holds_if(bool holds) {
    return holds ? Verdict::holds : Verdict::fails;
}

/// `measure` comes to an array of doubles, which are the arguments of `judge`.
template <class Measure, class Judge>
Claim claim(std::string_view key, std::string_view words, Measure measure, Judge judge) {
    using Row = std::invoke_result_t<Measure, const std::atomic<bool>&>;
    return {key, words, numbers_in<Row>, [=](const std::atomic<bool>& stop) { return numbers_of(measure(stop)); },
            [=](const TrialNumbers& numbers) { return std::apply(judge, row_of<Row>(numbers)); }};
}

const auto equations = claim(
    "equations", "The accelerations in angles are as printed (eqs. 5, 6)",
    [](const std::atomic<bool>& stop) {
        const auto start = side({120, 30}), rods = side({120, 30}, ModelChoice::constraints);
        return std::array{greatest(distances(exactly(start), exactly(rods), 240, stop))};
    },
    [](double parted) {
        return Judgement{
            Verdict::misprinted,
            fmt::format(
                "cross terms ω₁ω₂ cancel and a denominator has the wrong unit in print; the program's equations "
                "agree with particles on rods within {} after 2 s in quad",
                scientific(parted))};
    });

const auto order_of_update = claim(
    "order_of_update", "Each step updates velocities first, then positions (eq. 7)",
    [](const std::atomic<bool>& stop) {
        auto [a, b] = angle_twins(20);
        a.integrator = b.integrator = "semi-implicit-euler";
        AverageLogRatio velocities_first;
        for (const double distance : distances(a, b, 3000, stop)) velocities_first.add(distance);
        return std::array{averages({angle_twins(20)}, {}, stop)[0], velocities_first.value()};
    },
    [](double explicit_euler, double velocities_first) {
        return Judgement{
            holds_if(std::abs(velocities_first - 2.205) < std::abs(explicit_euler - 2.205)),
            fmt::format("the published curve has 2.205 at 20°: explicit Euler, positions by the old velocities, gives "
                        "{:.4f}; velocities first gives {:.4f}",
                        explicit_euler, velocities_first)};
    });

const auto constraint_row = claim(
    "constraint_row", "The constraint and the first row of its Jacobian are as printed (eqs. 9, 10)",
    [](const std::atomic<bool>&) {
        // ½ (x² + y² − r²) by dual numbers at (3, 4)
        using Variable = Dual<double, 4>;
        const Variable x = Variable::variable(3, 0), y = Variable::variable(4, 1);
        const Variable c = Variable(0.5) * (x * x + y * y - Variable(25.0));
        return std::array{c.value, c.tangent[0], c.tangent[1], c.tangent[2], c.tangent[3]};
    },
    [](double /*value*/, double x1, double y1, double x2, double y2) {
        return Judgement{
            Verdict::misprinted,
            fmt::format(
                "it takes brackets, ½(x² + y² − r²); its row at (3, 4) is ({:g}, {:g}, {:g}, {:g}): (x₁, y₁, 0, 0)", x1,
                y1, x2, y2)};
    });

const auto positive_means_chaos = claim(
    "positive_means_chaos", "λ > 0, hence chaos",
    [](const std::atomic<bool>& stop) {
        const auto average = averages({angle_twins(0), angle_twins(20)}, {}, stop);
        const auto exponent = [&](int theta1_deg) {
            return largest_exponent(chain_of(side({theta1_deg, 0})).cast<double>(), {}, stop);
        };
        const auto regular = exponent(20), chaotic = exponent(120);
        return std::array{average[0],          average[1],    regular.value,
                          regular.uncertainty, chaotic.value, chaotic.uncertainty};
    },
    [](double average_0, double average_20, double regular, double regular_deviation, double chaotic,
       double chaotic_deviation) {
        return Judgement{
            holds_if(!(average_20 > 0 && is_regular({regular, regular_deviation}))),
            fmt::format("the average of ln(d/d₀) is {:.2f} at 0° and {:.2f} at 20°, where the exponent is {:.3f} ± "
                        "{:.3f} 1/s, none; at 120° it is {:.2f} ± {:.2f} 1/s",
                        average_0, average_20, regular, regular_deviation, chaotic, chaotic_deviation)};
    });

const auto course_over_time = claim(
    "course_over_time", "The twins of figure 2 left part until ln(d/d₀) saturates near 11.5",
    [](const std::atomic<bool>& stop) {
        const auto d = distances(side({90, 90}), side({parse_quad("90.003"), 90}), 3200, stop);
        double sum = 0;
        for (std::size_t n = 2001; n < d.size(); ++n) sum += std::log(d[n] / d[0]);
        return std::array{std::log(d[501] / d[0]), sum / static_cast<double>(d.size() - 2001)};
    },
    [](double at_501, double from_2001) {
        return Judgement{
            holds_if(std::abs(from_2001 - 11.5) < 0.6),
            fmt::format("{:.3f} at sample 501, and {:.1f} on average from sample 2001 on", at_501, from_2001)};
    });

const auto course_over_angle = claim(
    "course_over_angle", "Figure 2 right rises to 2.8 by 40° and 4 by 80°, falls to 3–4 near 108°, then stays at 8–10",
    [](const std::atomic<bool>& stop) {
        std::vector<SideTwins> twins{angle_twins(40), angle_twins(80), angle_twins(108)};
        for (int angle = 115; angle < 180; angle += 5) twins.push_back(angle_twins(angle));
        auto found = averages(twins, {}, stop);
        double sum = 0;
        for (std::size_t i = 3; i < found.size(); ++i) sum += found[i];
        return std::array{found[0], found[1], found[2], sum / static_cast<double>(found.size() - 3)};
    },
    [](double at_40, double at_80, double at_108, double from_115) {
        return Judgement{holds_if(std::abs(at_40 - 2.9) < 0.2 && std::abs(at_80 - 4.3) < 1 && at_108 < from_115 - 3 &&
                                  from_115 > 8 && from_115 < 10),
                         fmt::format("{:.2f} at 40°, {:.1f} at 80°, {:.1f} at 108°, {:.1f} on average from 115° on",
                                     at_40, at_80, at_108, from_115)};
    });

const auto figure3_axis = claim(
    "figure3_axis", "Figures 3 left and 5 left share their scale",
    [](const std::atomic<bool>& stop) {
        const auto found = averages({mass_twins(130, 0, 1), mass_twins(150, 0, 1), mass_twins(170, 0, 1)}, {}, stop);
        return std::array{(found[0] + found[1] + found[2]) / 3};
    },
    [](double beyond_130) {
        return Judgement{Verdict::misprinted,
                         fmt::format("{:.1f} in ln, {:.1f} in log₁₀, beyond 130°: figure 3 left was printed in log₁₀",
                                     beyond_130, beyond_130 / std::log(10.0))};
    });

const auto figure3_release = claim(
    "figure3_release", "Figures 3 and 5 right are released at θ₂ = 0",
    [](const std::atomic<bool>& stop) {
        const auto found = averages({mass_twins(90, 0, 0.5), mass_twins(90, 90, 0.5)}, {}, stop);
        return std::array{found[0], found[1]};
    },
    [](double from_0, double from_90) {
        return Judgement{
            Verdict::misprinted,
            fmt::format(
                "they come out with θ₂ = 90°; at mass ratio 0.5 the average is {:.1f} there and {:.1f} with θ₂ = 0",
                from_90, from_0)};
    });

const auto figure6_release = claim(
    "figure6_release", "The lower curve of figure 6 is released at 30°",
    [](const std::atomic<bool>& stop) {
        const auto parted = [&](int angle) {
            return greatest(distances(side({angle, 0}), side({angle, 0}, ModelChoice::constraints), 4500, stop));
        };
        return std::array{parted(30), parted(45)};
    },
    [](double from_30, double from_45) {
        return Judgement{
            std::abs(from_30 - 0.633) < 0.01 ? Verdict::holds : Verdict::misprinted,
            fmt::format("its greatest distance, 0.633, is that of 45° ({:.3f}); 30° gives {:.3f}", from_45, from_30)};
    });

const auto floating_point = claim(
    "floating_point", "The two formulations part because of floating point and π",
    [](const std::atomic<bool>& stop) {
        const auto parted = [&](const Rational& step) {
            auto a = side({50, 0}), b = side({50, 0}, ModelChoice::constraints);
            a.step_s = b.step_s = step;
            return greatest(distances(a, b, 4500, stop));
        };
        const auto a = side({50, 0}), b = side({50, 0}, ModelChoice::constraints);
        return std::array{parted({1, 30000}), parted({1, 120000}),
                          greatest(distances(exactly(a), exactly(b), 600, stop))};
    },
    [](double coarse, double fine, double in_quad) {
        return Judgement{holds_if(fine > coarse / 2),
                         fmt::format("a quarter of the step leaves a quarter of the distance, {:.3f} → {:.3f}: "
                                     "Euler's truncation; by Taylor "
                                     "series in quad they stay within {} for 5 s",
                                     coarse, fine, scientific(in_quad))};
    });

const auto energy_gain = claim(
    "energy", "The energy rises until the simulation breaks down",
    [](const std::atomic<bool>& stop) {
        const auto gain = [&](const SideSpec& spec) {
            const auto scene = make_scene({.name = "audit", .duration_s = {75, 1}, .a = spec, .b = spec});
            SideRun run(scene, scene.a, 'a');
            Observation seen;
            for (long n = 0; n <= scene.samples; ++n) seen = run.next(stop);
            return seen.energy_change;
        };
        auto taylor = side({90, 90});
        taylor.integrator = "taylor";
        return std::array{gain(side({90, 90})), gain(taylor)};
    },
    [](double euler, double taylor) {
        return Judgement{
            holds_if(euler > 0),
            fmt::format("in 75 s at 90°/90° Euler gains {} J of 58.8; Taylor series, {} J: the method's doing",
                        scientific(euler), scientific(std::abs(taylor)))};
    });

/// Greatest distance with and without the droplet within 75 s, and when it is first more than 1, s; 0 = never.
std::array<double, 2> parted_by_droplet(int angle_deg, const std::atomic<bool>& stop) {
    constexpr long samples = 9000;
    const auto start = exactly(side({angle_deg, angle_deg}));
    const auto d = distances(with_droplet(start, true), with_droplet(start, false), samples, stop);
    const auto seen = std::find_if(d.begin(), d.end(), [](double x) { return x > 1; });
    return {greatest(d), seen == d.end() ? 0 : static_cast<double>(seen - d.begin()) / 120};
}

const auto droplet_79 = claim(
    "droplet_79", "A raindrop a mile away is felt at 79°/79° (figure 7)",
    [](const std::atomic<bool>& stop) { return parted_by_droplet(79, stop); },
    [](double parted, double seen_s) {
        return Judgement{holds_if(seen_s > 0), fmt::format("in quad the two stay within {} for 75 s. The study's "
                                                           "run felt a force 4·10⁷ times too great; double "
                                                           "feels none at all",
                                                           scientific(parted))};
    });

const auto droplet_90 = claim(
    "droplet_90", "A raindrop a mile away is felt where the motion is chaotic",
    [](const std::atomic<bool>& stop) { return parted_by_droplet(90, stop); },
    [](double parted, double seen_s) {
        return Judgement{
            holds_if(seen_s > 0),
            seen_s > 0 ? fmt::format("in quad, from 90°/90°, the two are strangers after {:.0f} s", seen_s)
                       : fmt::format("in quad, from 90°/90°, the two stay within {} for 75 s", scientific(parted))};
    });

const auto three_links = claim(
    "three_links", "Figure 8 takes over an hour and a half, and more than three links are out of reach",
    [](const std::atomic<bool>& stop) {
        std::vector<SideTwins> twins;
        for (std::size_t i = 0; i < twins_block() / 2; ++i) {
            const int angle = static_cast<int>(20 * i);
            twins.emplace_back(side({angle, 0, 0}), side({angle + parse_quad("0.003"), 0, 0}));
        }
        const double start = seconds_of(CLOCK_THREAD_CPUTIME_ID);
        averages(twins, {.model = Model::constraints}, stop);
        const double spent = seconds_of(CLOCK_THREAD_CPUTIME_ID) - start;
        constexpr double all = 181;
        const auto chain = chain_of(side(std::vector<Quad>(16, 90))).cast<double>();
        return std::array{spent * all / static_cast<double>(twins.size()),
                          largest_exponent(chain, {.duration_s = 50, .transient_s = 5}, stop).value};
    },
    [](double figure8_s, double exponent_of_16) {
        return Judgement{
            holds_if(figure8_s > 5400),
            fmt::format("{:.2f} s on one core of this machine; the exponent of 16 links released level is {:.1f} 1/s",
                        figure8_s, exponent_of_16)};
    });

}  // namespace

std::span<const Claim> claims() {
    static const std::array all{equations,        order_of_update,   constraint_row, positive_means_chaos,
                                course_over_time, course_over_angle, figure3_axis,   figure3_release,
                                figure6_release,  floating_point,    energy_gain,    droplet_79,
                                droplet_90,       three_links};
    return all;
}

}  // namespace doppel
