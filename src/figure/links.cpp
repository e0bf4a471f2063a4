#include "analysis/exponent.hpp"
#include "base/clock.hpp"
#include "figure/kinds.hpp"
#include "figure/system_words.hpp"
#include "integrate/motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace doppel {
namespace {

/// CPU time of an Euler step of a chain, ns: one of these for every chain is the first trial.
struct CostRow {
    double angles, constraints;
};
/// The largest exponent of a chain, 1/s: the other trials.
struct ExponentRow {
    double value, uncertainty;
};

/// Chains of more and more links, all released alike: their largest exponent, and what a step costs.
class Links final : public Experiment {
public:
    static constexpr std::string_view table_key = "links";
    Links() = default;
    explicit Links(FigureReader& reader) : release_(reader.release()) {
        auto table = reader.settings(*this);
        if (to_ < from_) throw table.fault("to", "must be at least `from`, {}; it is {}", from_, to_);
        settings_ = resolved_release(release_) + table.finish();
        if (release_.links() != 1)
            throw table.fault("from", "takes a [system] of one link, which all links are like; it has {}",
                              release_.links());
    }

    template <class Visit>
    void fields(Visit& visit) {
        constexpr int most = 1000;
        visit({"from", "links of the shortest chain", "", from_to(1, most)}, from_);
        visit({"to", "links of the longest", "", from_to(1, most)}, to_);
        visit({"duration_s", "of the motion that an exponent is found by", "s", positive}, duration_s_);
    }

    /// The costs, all in one, so that they are measured in turn; then the exponent of each chain.
    std::size_t trials() const override { return chains() + 1; }
    std::string unit() const override { return "chains"; }
    double units(std::size_t trial) const override { return trial == 0 ? 0 : 1; }

    bool fits(std::size_t trial, std::span<const double> numbers) const override {
        return numbers.size() ==
               (trial == 0 ? chains() * numbers_in<CostRow> : numbers_in<ExponentRow>)&&all_finite(numbers);
    }

    std::vector<std::string> columns() const override {
        return {"links", "exponent_per_s", "exponent_uncertainty_per_s", "angles_step_ns", "constraints_step_ns"};
    }

    void write_rows(std::span<const TrialNumbers> numbers, Csv& table) const override {
        const auto costs = rows_of<CostRow>(numbers[0]);
        for (std::size_t i = 0; i < chains(); ++i) {
            const auto exponent = row_of<ExponentRow>(numbers[i + 1]);
            add_row(table, links(i), exponent.value, exponent.uncertainty, costs[i].angles, costs[i].constraints);
        }
    }

    void draw(std::span<const TrialNumbers> numbers, Figure& figure) const override {
        Plot chaos, cost;
        chaos.x = cost.x = {.label = "links"};
        chaos.y = {.label = "largest Lyapunov exponent, 1/s"};
        cost.y = {.label = "CPU time of an Euler step, ns"};
        Curve exponents{.mark = Mark::both};
        Curve angles{.label = "in angles", .hue = 1}, constraints{.label = "in constraints", .hue = 2};
        const auto costs = rows_of<CostRow>(numbers[0]);
        for (std::size_t i = 0; i < chains(); ++i) {
            const auto number = static_cast<double>(links(i));
            const auto exponent = row_of<ExponentRow>(numbers[i + 1]);
            add_point(exponents, number, exponent.value);
            exponents.uncertainty.push_back(exponent.uncertainty);
            add_point(angles, number, costs[i].angles);
            add_point(constraints, number, costs[i].constraints);
        }
        chaos.curves = {std::move(exponents)};
        cost.curves = {std::move(angles), std::move(constraints)};
        figure.panels = {std::move(chaos), std::move(cost)};
    }

    std::string subtitle() const override {
        return fmt::format(
            "chains {}, {}; exponents from {:g} s, in a band for two of three longer runs; Euler at 30 kHz",
            released_words(release_), links_words(release_), duration_s_);
    }

    std::vector<Finding> findings(std::span<const TrialNumbers> numbers) const override {
        return {{"exponent_per_s_of_the_longest", row_of<ExponentRow>(numbers.back()).value},
                {"constraints_step_ns_a_link_of_the_longest", rows_of<CostRow>(numbers[0]).back().constraints / to_}};
    }

private:
    std::size_t chains() const { return static_cast<std::size_t>(to_ - from_) + 1; }
    std::size_t links(std::size_t chain) const { return static_cast<std::size_t>(from_) + chain; }

    TrialNumbers compute_trial(std::size_t trial, const std::atomic<bool>& stop) const override {
        if (trial == 0) return step_costs(stop);
        const auto exponent =
            largest_exponent(chain_of(chain(trial - 1)).cast<double>(), {.duration_s = duration_s_}, stop);
        return numbers_of(ExponentRow{exponent.value, exponent.uncertainty});
    }

    SideSpec chain(std::size_t number) const {
        auto side = release_;
        for (auto* values : {&side.mass_kg, &side.length_m, &side.angle_deg, &side.omega_deg_per_s})
            values->assign(links(number), values->front());
        return side;
    }

    /// A CostRow of each chain: one explicit Euler step at the study's 30 kHz in double, the least of some rounds, so
    /// that other load on the machine does not count.
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
    double duration_s_ = ExponentSpec{}.duration_s;
    int from_ = 2, to_ = 32;
};

}  // namespace

const FigureKind links_kind = kind_of<Links>("links", FigureKind::System::release);

}  // namespace doppel
