#include "analysis/exponent.hpp"
#include "base/clock.hpp"
#include "figure/kinds.hpp"
#include "integrate/motion.hpp"
#include "scene/scene.hpp"
#include "scene/resolved.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace doppel {
namespace {

/// Chains of more and more links, all released alike: their largest exponent, and what a step costs.
class Links final : public FigureWork {
public:
    explicit Links(FigureReader& reader) : release_(reader.release()) {
        auto table = reader.table("links");
        table.read_whole("from", from_, 1, 1000);
        table.read_whole("to", to_, from_, 1000);
        table.read_positive("duration_s", spec_.duration_s);
        spec_.transient_s = spec_.duration_s / 10;
        table.finish();
        if (release_.links() != 1)
            throw table.fault("from", "takes a [system] of one link, which all links are like; it has {}",
                              release_.links());
    }

    /// The costs, all in one, so that they are measured in turn; then the exponent of each chain.
    std::size_t trials() const override { return chains() + 1; }
    std::string unit() const override { return "chains"; }
    double units(std::size_t trial) const override { return trial == 0 ? 0 : 1; }

    void compute(std::size_t first, std::span<TrialNumbers> numbers, const std::atomic<bool>& stop) const override {
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            if (first + i == 0) {
                numbers[i] = step_costs(stop);
                continue;
            }
            const auto exponent = largest_exponent(chain_of(chain(first + i - 1)).cast<double>(), spec_, stop);
            numbers[i] = {exponent.value, exponent.uncertainty};
        }
    }

    bool fits(std::size_t trial, std::span<const double> numbers) const override {
        return numbers.size() == (trial == 0 ? 2 * chains() : 2) && all_finite(numbers);
    }

    std::vector<std::string> columns() const override {
        return {"links", "exponent_per_s", "exponent_uncertainty_per_s", "angles_step_ns", "constraints_step_ns"};
    }

    void write_rows(std::span<const TrialNumbers> numbers, Csv& table) const override {
        for (std::size_t i = 0; i < chains(); ++i) {
            table.add(static_cast<long>(links(i)));
            for (const double x : numbers[i + 1]) table.add(x);
            for (const std::size_t model : {0, 1}) table.add(numbers[0][2 * i + model]);
            table.end_row();
        }
    }

    void draw(std::span<const TrialNumbers> numbers, Figure& figure) const override {
        Plot plot;
        plot.x = {.label = "links"};
        plot.y = {.label = "largest Lyapunov exponent, 1/s", .low = 0};
        plot.right = PlotAxis{.label = "an Euler step, ns", .low = 0};
        Curve exponents{.label = "exponent", .mark = Mark::both};
        std::array<Curve, 2> costs{Curve{.label = "a step in angles", .hue = 1, .right = true},
                                   Curve{.label = "a step in constraints", .hue = 2, .right = true}};
        for (std::size_t i = 0; i < chains(); ++i) {
            for (auto* curve : {&exponents, &costs[0], &costs[1]}) curve->x.push_back(static_cast<double>(links(i)));
            exponents.y.push_back(numbers[i + 1][0]);
            exponents.uncertainty.push_back(numbers[i + 1][1]);
            for (const std::size_t model : {0, 1}) costs[model].y.push_back(numbers[0][2 * i + model]);
        }
        plot.curves = {std::move(exponents), std::move(costs[0]), std::move(costs[1])};
        figure.panels.push_back(std::move(plot));
    }

    std::vector<Finding> findings(std::span<const TrialNumbers> numbers) const override {
        return {{"exponent_per_s_of_the_longest", numbers.back()[0]},
                {"constraints_step_ns_a_link_of_the_longest", numbers[0].back() / to_}};
    }

    std::string resolved() const override {
        return resolved_release(release_) +
               fmt::format("\n[links]\nfrom = {}\nto = {}\nduration_s = {}\n", from_, to_, spec_.duration_s);
    }

private:
    std::size_t chains() const { return static_cast<std::size_t>(to_ - from_) + 1; }
    std::size_t links(std::size_t chain) const { return static_cast<std::size_t>(from_) + chain; }

    SideSpec chain(std::size_t number) const {
        auto side = release_;
        for (auto* values : {&side.mass_kg, &side.length_m, &side.angle_deg, &side.omega_deg_per_s})
            values->assign(links(number), values->front());
        return side;
    }

    /// One explicit Euler step at the study's 30 kHz of every chain, in angles and in constraints, alone in double, ns
    /// of CPU: the least of some rounds, so that what else the machine does leaves no mark.
    TrialNumbers step_costs(const std::atomic<bool>& stop) const {
        constexpr int rounds = 12;
        std::vector<std::unique_ptr<Motion>> motions;
        for (std::size_t i = 0; i < chains(); ++i)
            for (const auto model : {Model::angles, Model::constraints})
                motions.push_back(make_motion({.chain = chain_of(chain(i)), .model = model}));
        TrialNumbers least(motions.size(), std::numeric_limits<double>::max());
        for (int round = 0; round < rounds; ++round)
            for (std::size_t i = 0; i < motions.size(); ++i) {
                const double start = seconds_of(CLOCK_THREAD_CPUTIME_ID);
                motions[i]->advance(stop);
                const double spent = seconds_of(CLOCK_THREAD_CPUTIME_ID) - start;
                least[i] = std::min(least[i], 1e9 * spent / static_cast<double>(MotionSpec().steps_per_sample));
            }
        return least;
    }

    SideSpec release_;
    ExponentSpec spec_;
    int from_ = 2, to_ = 32;
};

}  // namespace

std::shared_ptr<const FigureWork> read_links(FigureReader& reader) {
    return std::make_shared<Links>(reader);
}

}  // namespace doppel
