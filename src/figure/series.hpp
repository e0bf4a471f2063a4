#pragma once

#include "analysis/exponent.hpp"
#include "figure/kinds.hpp"

#include <algorithm>

namespace doppel {

/// The quantities of a series: the distance of pairs, as such or as ln(d/d0); all exponents of one motion; the errors
/// of one motion by each method.
enum class SeriesQuantity { distance, log_ratio, exponents, errors };
template <>
inline constexpr auto names_of<SeriesQuantity> = std::to_array<std::string_view>({"distance", "log_ratio", "exponents",
                                                                                  "errors"});

/// The keys of [series].
struct SeriesKeys {
    static constexpr std::string_view table_key = "series";
    SeriesQuantity quantity = SeriesQuantity::distance;
    bool logarithmic = false;
    std::optional<std::string> film_column;
    std::optional<Quad> check_tolerance;
    double duration_s = 500;
    int samples = 500, points_per_decade = 10;
    double tolerance = SpectrumSpec{}.tolerance, evaluations_per_s = 500;
    std::vector<std::string> methods{names_of_methods().begin(), names_of_methods().end()}, projected;

    bool is_of_pairs() const { return quantity <= SeriesQuantity::log_ratio; }

    void fields(KeyVisitor& visit) {
        visit({"quantity",
               "the distance of pairs in state space, or ln(d/d₀); all Lyapunov exponents of one motion, as their "
               "estimates settle; or the errors of its energy and rods by each method at the same cost"},
              quantity);
        const Condition of_pairs{is_of_pairs(), "is only for pairs"};
        visit({.key = "film_column",
               .help = "in place of `quantity`: a column of the table that a film of the pair has",
               .only = of_pairs,
               .is_drawn = true},
              film_column);
        const Condition of_exponents{quantity == SeriesQuantity::exponents, "is only for exponents"};
        const Condition of_errors{quantity == SeriesQuantity::errors, "is only for errors"};
        const Bounds of_motions = of_errors.applies ? from_to(10, 1e8) : positive;
        constexpr Bounds tolerances = from_to(1e-14, 1e-2), costs = from_to(10, 1e6);
        visit({"logarithmic", "the axis", "", {}, "", of_pairs}, logarithmic);
        visit({"check_tolerance", "runs every pair again at this tolerance, to see how long both agree", "", positive,
               "", of_pairs},
              check_tolerance);
        visit({"duration_s", "of the motion", "s", of_motions, "",
               Condition{!is_of_pairs(), "is for one motion; pairs use that of [scene]"}},
              duration_s);
        visit({"samples", "of the exponents, equally spaced, the last at the end", "", from_to(2, 100'000), "",
               of_exponents},
              samples);
        visit({"tolerance", "relative error of a step of dop853, of the motion and of its tangents", "", tolerances, "",
               of_exponents},
              tolerance);
        visit({"points_per_decade", "of the curves, from 1 s on", "", from_to(1, 100), "", of_errors},
              points_per_decade);
        visit({"evaluations_per_s", "evaluations of the right-hand side a second of motion, the same for all methods",
               "", costs, "", of_errors},
              evaluations_per_s);
        visit({.key = "methods",
               .help = "names of methods",
               .absent = "all that step chains",
               .only = of_errors,
               .names = names_of_methods()},
              methods);
        visit({.key = "projected",
               .help = "methods that are also shown with projection onto the constraints",
               .only = of_errors,
               .names = names_of_methods()},
              projected);
    }
};

/// Quantities over time. A trial gives `own_` numbers, then `each_` quantities at all times, one quantity after the other.
class Series : public Experiment {
public:
    std::size_t trials() const override { return trials_; }

    bool fits(std::size_t trial, std::span<const double> numbers) const override {
        return numbers.size() == own_ + each_ * times_s_.size() && finite_or_none(numbers) &&
               (!are_finite_[trial % are_finite_.size()] || all_finite(numbers));
    }

    /// A row for each time, with all quantities.
    void write_rows(std::span<const TrialNumbers> numbers, Csv& table) const override {
        for (std::size_t n = 0; n < times_s_.size(); ++n) {
            if (columns_.front() == "sample") table.add(static_cast<long>(n));
            table.add(times_s_[n]);
            for (std::size_t k = 0; k < shown_; ++k) table.add_or_empty(values(numbers, k)[n]);
            table.end_row();
        }
    }

    void draw(std::span<const TrialNumbers> numbers, Figure& figure) const override {
        auto& plot = figure.panels.emplace_back(axes_);
        for (std::size_t i = 0; i < labels_.size(); ++i) {
            const auto y = values(numbers, i);
            plot.curves.push_back(
                {.label = labels_[i], .x = times_s_, .y = {y.begin(), y.end()}, .hue = static_cast<int>(i)});
        }
        if (auto words = caption(numbers); !words.empty()) figure.captions.push_back(std::move(words));
    }

    std::optional<std::string> nothing_to_draw(std::span<const TrialNumbers> numbers) const override {
        for (std::size_t k = 0; k < shown_ && axes_.y.logarithmic; ++k)
            if (std::ranges::any_of(values(numbers, k), [](double x) { return x > 0; })) return std::nullopt;
        return axes_.y.logarithmic ? std::optional(none_words_) : std::nullopt;
    }

protected:
    virtual std::string caption(std::span<const TrialNumbers> numbers) const = 0;

    /// Quantity k of all trials, at all times.
    std::span<const double> values(std::span<const TrialNumbers> numbers, std::size_t k) const {
        return std::span(numbers[k / each_]).subspan(own_ + k % each_ * times_s_.size(), times_s_.size());
    }

    /// part() of this series, as a copy with the first of its times. cost(time) = how long the computing takes.
    template <class Kind, class Cost>
    static Part cut(const Kind& series, double share, const Cost& cost) {
        auto copy = std::make_shared<Kind>(series);
        auto& times = copy->times_s_;
        const double end = times.back();
        const auto count = std::ranges::upper_bound(times, share * end) - times.begin();
        times.resize(std::max<std::size_t>(2, static_cast<std::size_t>(count)));
        const auto numbers = series.own_ + series.each_ * series.times_s_.size();
        return {copy, cost(times.back()) / cost(end), series.trials_ * numbers};
    }

    // set by constructors
    std::vector<double> times_s_;  // ascending, at least two
    std::size_t trials_ = 1, own_ = 0, each_ = 1;
    std::vector<bool> are_finite_;     // of each curve: no number may be missing
    std::size_t shown_ = 0;            // quantities in the table
    std::vector<std::string> labels_;  // of the curves, the first quantities
    Plot axes_;                        // without curves
    std::string none_words_;           // why a logarithmic axis shows nothing
};

/// Long-term errors of energy and rod lengths, every method at the same cost: the series of `errors`. Throws Error
/// (exit 2).
std::shared_ptr<const Experiment> drift_series(FigureReader& reader, const TomlReader& table, SeriesKeys& keys);

}  // namespace doppel
