#include "analysis/drift.hpp"
#include "analysis/exponent.hpp"
#include "base/error.hpp"
#include "figure/kinds.hpp"
#include "film/pair_table.hpp"
#include "scene/captions.hpp"
#include "scene/certificate.hpp"
#include "scene/side_keys.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace doppel {

/// The quantities of a series: the distance of pairs, as such or as ln(d/d0); all exponents of one motion; the errors
/// of one motion by each method.
enum class SeriesQuantity { distance, log_ratio, exponents, errors };
template <>
inline constexpr auto names_of<SeriesQuantity> = std::to_array<std::string_view>({"distance", "log_ratio", "exponents",
                                                                                  "errors"});

namespace {

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
        const Bounds of_motions = of_errors.applies ? Bounds{.low = 10, .high = 1e8, .is_positive = true} : positive;
        constexpr Bounds tolerances{.low = 1e-14, .high = 1e-2, .is_positive = true},
            costs{.low = 10, .high = 1e6, .is_positive = true};
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
               (may_be_none(trial) || all_finite(numbers));
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
    /// Whether numbers may be missing.
    virtual bool may_be_none(std::size_t /*trial*/) const { return true; }
    virtual std::string caption(std::span<const TrialNumbers> numbers) const = 0;

    /// Quantity k of all trials, at all times.
    std::span<const double> values(std::span<const TrialNumbers> numbers, std::size_t k) const {
        return std::span(numbers[k / each_]).subspan(own_ + k % each_ * times_s_.size(), times_s_.size());
    }

    // set by constructors
    std::vector<double> times_s_;  // ascending
    std::size_t trials_ = 1, own_ = 0, each_ = 1;
    std::size_t shown_ = 0;            // quantities in the table
    std::vector<std::string> labels_;  // of the curves, the first quantities
    Plot axes_;                        // without curves
    std::string none_words_;           // why a logarithmic axis shows nothing
};

struct PairCurve {
    std::string column, label;
    std::optional<std::string> film_column;
    Preset pair;
};

void curve_fields(KeyVisitor& visit, PairCurve& curve) {
    visit({"column", "its name in the CSV", "", {}, must_be_given}, curve.column);
    curve.label = curve.column;
    visit({.key = "label", .help = "its name in the picture", .absent = "the column", .is_drawn = true}, curve.label);
    visit({.key = "film_column", .help = "quantity that is shown", .absent = "that of [series]"}, curve.film_column);
}

/// Columns in place of a film's: the radius of the certified enclosure of side a, with each precision.
constexpr std::array<std::string_view, 3> certified_columns{"radius_double_rad", "radius_quad_rad",
                                                            "radius_256_bits_rad"};

bool is_certified(std::string_view column) {
    return std::ranges::count(certified_columns, column) > 0;
}

/// "θ₁, rad", "energy, J": the label of a column, without the side.
std::string column_words(const std::string& column) {
    if (column == "distance") return "distance in state space, d";
    if (column == "log_ratio") return "ln(d/d₀)";
    if (is_certified(column)) return "radius of the proved enclosure, rad";
    using Words = std::array<std::string_view, 2>;
    constexpr std::array units{Words{"_rad_per_s", "rad/s"}, Words{"_m_per_s", "m/s"}, Words{"_rad", "rad"},
                               Words{"_J", "J"}, Words{"_m", "m"}};
    constexpr std::array letters{Words{"theta", "θ"}, Words{"omega", "ω"}};
    auto name = column.substr(2);
    std::string_view unit;
    for (const auto& [ending, of] : units)
        if (unit.empty() && name.ends_with(ending)) unit = of, name.resize(name.size() - ending.size());
    for (const auto& [latin, greek] : letters)
        if (name.starts_with(latin)) name.replace(0, latin.size(), greek);
    if (const auto digits = name.find_first_of("123456789"); digits != std::string::npos)
        name = name.substr(0, digits) + subscript(std::stoul(name.substr(digits)));
    std::ranges::replace(name, '_', ' ');
    return unit.empty() ? name : fmt::format("{}, {}", name, unit);
}

/// A quantity of one or more pairs over time. Every pair may be run again at a finer tolerance, to find how long both
/// agree.
class PairSeries final : public Series {
public:
    PairSeries(FigureReader& reader, const TomlReader& table, SeriesKeys& keys)
        : check_tolerance_(keys.check_tolerance) {
        columns_ = {"sample", "time_s"};
        const auto shown = keys.film_column.value_or(std::string(name_of(keys.quantity)));
        auto entries = reader.entries("curve");
        if (entries.empty() || reader.only_keys) curves_.push_back({shown, "", shown, reader.pair()});
        for (auto& entry : entries) {
            auto& curve = curves_.emplace_back();
            curve_fields(entry, curve);
            if (!reader.only_keys) check_column(entry, curve);
            columns_.push_back(curve.column);
            if (!curve.film_column) curve.film_column = shown;
            curve.pair = reader.pair({&entry});
            entry.finish();
        }
        if (reader.only_keys) return;
        if (entries.empty()) columns_.push_back(shown);
        bool differ = false;
        const auto& first = curves_.front().pair;
        SweptKeys swept;
        for (auto& curve : curves_) {
            for (const auto& keys : {differing_keys(first.a, curve.pair.a), differing_keys(first.b, curve.pair.b)})
                for (const auto& key : keys) swept.keys.push_back(fmt::format(".{}", key.any().key));
            curve.pair.energy_columns = true;
            const auto scene = make_scene(curve.pair);  // reports errors now
            times_s_.clear();
            for (long n = 0; n <= scene.samples; ++n) times_s_.push_back(scene.time(n));
            auto known = columns_of(scene);
            known.erase(known.begin(), known.begin() + 2);  // sample and time
            known.insert(known.end(), certified_columns.begin(), certified_columns.end());
            if (is_certified(*curve.film_column)) check_provable(scene);
            if (std::ranges::count(known, *curve.film_column) == 0)
                throw table.error("film_column", "must be one of {}; it is \"{}\"", fmt::join(known, ", "),
                                  *curve.film_column);
            const bool is_ratio = curve.film_column == "log_ratio",
                       is_of_both = is_ratio || curve.film_column == "distance";
            differ |= !is_of_both || !are_one(scene);
            if (is_ratio && have_same_release(curve.pair.a, curve.pair.b))
                throw table.error("quantity",
                                  "\"log_ratio\" needs sides that are released differently: there is no "
                                  "ratio to a distance of 0");
            if (check_tolerance_ && !(curve.pair.a.tolerance && curve.pair.b.tolerance))
                throw table.error("check_tolerance", "needs adaptive methods on both sides");
            labels_.push_back(curve.label);
        }
        if (!differ)
            throw table.error("quantity", "\"{}\" compares the two sides, which are the same; let [b] differ from [a]",
                              shown);
        settings_ = resolved_settings(settings_text(keys));
        unit_ = "pairs";
        subtitle_ = pair_subtitle(make_scene(first), swept);
        shown_ = curves_.size();
        trials_ = shown_ * (check_tolerance_ ? 2 : 1);
        axes_.x = {.label = "time, s", .low = 0, .high = times_s_.back()};
        axes_.y = {.label = shown_words(), .logarithmic = keys.logarithmic};
        none_words_ = "nothing is greater than 0, which a logarithmic axis cannot show; set series.logarithmic = false";
    }

    Json findings(std::span<const TrialNumbers> numbers) const override {
        Json all;
        for (std::size_t i = 0; i < curves_.size(); ++i) {
            const auto maximum =
                std::ranges::max_element(numbers[i], [](double a, double b) { return std::isnan(a) || a < b; });
            all["greatest_" + curves_[i].column] = *maximum;
            all["greatest_at_sample_" + curves_[i].column] = static_cast<double>(maximum - numbers[i].begin());
            if (check_tolerance_) all["agrees_until_s_" + curves_[i].column] = agree_until(numbers, i);
        }
        return all;
    }

private:
    bool may_be_none(std::size_t trial) const override {
        return curves_[trial % curves_.size()].film_column != "distance";
    }

    std::string caption(std::span<const TrialNumbers> numbers) const override {
        if (!check_tolerance_) return "";
        std::string words;
        for (std::size_t i = 0; i < curves_.size(); ++i)
            words += fmt::format("{}{} until {:.1f} s", i == 0 ? ":" : ",",
                                 curves_[i].label.empty() ? "" : " " + curves_[i].label, agree_until(numbers, i));
        const bool are_distances =
            std::ranges::all_of(curves_, [](const auto& c) { return c.film_column == "distance"; });
        return fmt::format("Converged: at tolerance {} the {} are the same within 1 %{}.",
                           number_text(*check_tolerance_), are_distances ? "distances" : "values", words);
    }

    void check_column(TomlReader& entry, const PairCurve& curve) const {
        if (curve.column.empty()) throw entry.error("column", "is missing; it names the curve in the table");
        if (!entry.has("label")) entry.require_drawable("column", curve.column);  // the column is used as label
        if (std::ranges::count(columns_, curve.column) > 0)
            throw entry.error("column", "must differ from the other columns; it is \"{}\"", curve.column);
    }

    std::string resolved_settings(const std::string& own) const {
        const auto& base = curves_.front().pair;
        auto text = fmt::format("duration_s = \"{}\"\nsample_hz = \"{}\"\n{}", base.duration_s.text(),
                                base.sample_hz.text(), own);
        for (const auto& curve : curves_)
            text += fmt::format("\n[[curve]]\ncolumn = {}\nlabel = {}\nfilm_column = {}\n{}", toml_text(curve.column),
                                toml_text(curve.label), toml_text(*curve.film_column),
                                resolved_sides(curve.pair, "curve."));
        return text;
    }

    /// First the curves, then the same pairs at the finer tolerance.
    TrialNumbers compute_trial(std::size_t trial, const std::atomic<bool>& stop) const override {
        const auto& curve = curves_[trial % curves_.size()];
        auto pair = curve.pair;
        if (trial >= curves_.size()) pair.a.tolerance = pair.b.tolerance = check_tolerance_;
        const auto scene = make_scene(pair);
        const auto& shown = *curve.film_column;
        if (const auto* of = std::ranges::find(certified_columns, shown); of != certified_columns.end())
            return certified_radii(scene, static_cast<std::size_t>(of - certified_columns.begin()), stop);
        const auto names = columns_of(scene);
        const auto column = static_cast<std::size_t>(std::ranges::find(names, shown) - names.begin());
        PairRun run(scene);
        TrialNumbers values;
        double start = 0;
        for (std::size_t n = 0; n < times_s_.size(); ++n) {
            const Snapshot now{run.next(stop), {}};
            if (n == 0) start = now.pair.distance;
            values.push_back(numbers_of(scene, now, start)[column]);
        }
        return values;
    }

    /// The description of the curves.
    std::string shown_words() const {
        const auto side = [](const PairCurve& curve) {
            return curve.film_column->starts_with("a_") ? " (a)" : curve.film_column->starts_with("b_") ? " (b)" : "";
        };
        const std::string_view first = side(curves_.front());
        const bool is_one = std::ranges::all_of(curves_, [&](const auto& curve) { return side(curve) == first; });
        std::vector<std::string> all;
        for (const auto& curve : curves_)
            if (auto words = column_words(*curve.film_column) + (is_one ? "" : side(curve));
                std::ranges::count(all, words) == 0)
                all.push_back(std::move(words));
        return fmt::format("{}{}", fmt::join(all, "; "), is_one ? first : "");
    }

    /// The time up to which both tolerances agree within 1 %, s.
    double agree_until(std::span<const TrialNumbers> numbers, std::size_t curve) const {
        constexpr double allowed = 0.01;
        const auto &one = numbers[curve], &other = numbers[curve + curves_.size()];
        for (std::size_t n = 0; n < one.size(); ++n)
            if (std::abs(one[n] - other[n]) > allowed * std::abs(other[n])) return n == 0 ? 0 : times_s_[n - 1];
        return times_s_.back();
    }

    std::optional<Quad> check_tolerance_;
    std::vector<PairCurve> curves_;
};

/// Convergence of the estimates of all Lyapunov exponents of one motion, and of their sum.
class Spectrum final : public Series {
public:
    Spectrum(FigureReader& reader, const TomlReader& table, SeriesKeys& keys)
        : release_(reader.release(true)), spec_{keys.duration_s, keys.samples, keys.tolerance} {
        if (reader.only_keys) return;
        if (release_.physical.has_coulomb())
            throw reader.document.table(reader.top, "system")
                .error("joint_coulomb_N_m",
                       "is not for Lyapunov exponents, which need a smooth motion: these joints stick and slip");
        constexpr std::size_t max_links = 4;
        if (release_.links() > max_links)
            throw table.error("quantity", "= \"exponents\" is for 1 to {} links; there are {}", max_links,
                              release_.links());
        settings_ = resolved_release(release_) + settings_text(keys);
        unit_ = "spectra";
        columns_ = {"time_s"};
        for (std::size_t i = 1; i <= 2 * release_.links(); ++i) {
            columns_.push_back(fmt::format("exponent{}_per_s", i));
            labels_.push_back("λ" + subscript(i));
        }
        columns_.emplace_back("sum_per_s");
        each_ = shown_ = labels_.size() + 1;
        for (int k = 1; k <= spec_.samples; ++k) times_s_.push_back(spec_.duration_s * k / spec_.samples);
        axes_.x = {.label = "time, s", .logarithmic = true};
        axes_.y = {.label = "running estimates of the exponents, 1/s"};
        axes_.rules.push_back({Rule::Orientation::horizontal, 0, ""});
        subtitle_ = motion_words(release_) + "; tangent equations in canonical variables, dop853";
    }

    Json findings(std::span<const TrialNumbers> numbers) const override {
        Json all;
        for (std::size_t k = 0; k < each_; ++k) all[columns_[k + 1]] = values(numbers, k).back();
        if (preserves_volume()) all["pair_mismatch_per_s"] = pair_mismatch(last(numbers));
        return all;
    }

private:
    bool may_be_none(std::size_t /*trial*/) const override { return false; }
    bool preserves_volume() const { return physical_of(release_).friction.is_none(); }

    /// The exponents at the end.
    SpectrumSample last(std::span<const TrialNumbers> numbers) const {
        SpectrumSample sample{times_s_.back(), {}};
        for (std::size_t i = 0; i < labels_.size(); ++i) sample.exponents.push_back(values(numbers, i).back());
        return sample;
    }

    std::string caption(std::span<const TrialNumbers> numbers) const override {
        std::string words;
        for (const double exponent : last(numbers).exponents)
            words += fmt::format("{}{}{:.4f}", words.empty() ? "" : ", ", exponent < 0 ? "−" : "+", std::abs(exponent));
        const double sum = std::abs(values(numbers, labels_.size()).back());
        const auto of_them =
            preserves_volume()
                ? fmt::format("Their sum is 0 within {}, and the pairs are ± within {} 1/s.", scientific(sum),
                              scientific(pair_mismatch(last(numbers))))
                : fmt::format("Their sum is −{:.4f} 1/s, the mean rate at which friction contracts phase-space volume.",
                              sum);
        return fmt::format("After {} s: {} 1/s. {}", spec_.duration_s, words, of_them);
    }

    TrialNumbers compute_trial(std::size_t, const std::atomic<bool>& stop) const override {
        const auto samples = lyapunov_spectrum(physical_of(release_).cast<double>(), spec_, stop);
        TrialNumbers numbers;
        for (std::size_t i = 0; i < labels_.size(); ++i)
            for (const auto& sample : samples) numbers.push_back(sample.exponents[i]);
        for (const auto& [time_s, all] : samples) numbers.push_back(std::accumulate(all.begin(), all.end(), 0.0));
        return numbers;
    }

    SideSpec release_;
    SpectrumSpec spec_;
};

/// The name of a law of growth, and the hue of its curves; in the order of Growth::Kind.
struct GrowthStyle {
    std::string_view words, law;
    int hue;
};
constexpr std::array styles{GrowthStyle{"stays bounded", "", 1}, GrowthStyle{"grows like √t", " ∝ √t", 2},
                            GrowthStyle{"grows linearly", " ∝ t", 0}, GrowthStyle{"grows like t²", " ∝ t²", 3},
                            GrowthStyle{"fails", "", 6}};

const GrowthStyle& style_of(const Growth& growth) {
    return styles.at(static_cast<std::size_t>(growth.kind));
}

/// Long-term errors of energy and rod lengths, every method at the same cost. A trial is a run of a method.
class Drift final : public Series {
public:
    Drift(FigureReader& reader, const TomlReader& table, SeriesKeys& keys)
        : release_(reader.release()), evaluations_per_s_(keys.evaluations_per_s) {
        if (reader.only_keys) return;
        if (keys.methods.empty()) throw table.error("methods", "must name at least one");
        for (const auto model : {Model::angles, Model::constraints})
            for (const auto& name : methods_of(model, keys.methods)) add_run(name, model);
        for (const auto& name : keys.projected) {
            if (!find_method(name)->constraints)
                throw table.error("projected", "needs methods that integrate constraints; \"{}\" does not", name);
            add_run(name, Model::constraints, true);
        }
        check_distinct(table, "methods", keys.methods);
        check_distinct(table, "projected", keys.projected);
        // from 1 s on, rounded to three digits
        for (int i = 0; times_s_.empty() || times_s_.back() < keys.duration_s; ++i) {
            const int decade = i / keys.points_per_decade;
            const double part = std::pow(10, static_cast<double>(i % keys.points_per_decade) / keys.points_per_decade);
            times_s_.push_back(std::fmin(std::round(100 * part) / 100 * std::pow(10, decade), keys.duration_s));
        }
        trials_ = runs_.size();
        own_ = numbers_in<DriftCost>;
        each_ = 2;  // errors of the energy, and of the rods
        shown_ = each_ * trials_;
        settings_ = resolved_release(release_) + settings_text(keys);
        unit_ = "motions";
        columns_ = {"method", "model", "setting", "time_s", "energy_error", "length_error_m"};
        subtitle_ = fmt::format("{}; every method at some {:g} evaluations a second of motion", motion_words(release_),
                                evaluations_per_s_);
        // leaves room for names after the end
        axes_.x = {.label = "time, s", .low = 1, .high = 9 * times_s_.back(), .logarithmic = true};
        axes_.y = {.label = "maximum relative error of the energy to date", .high = 10, .logarithmic = true};
        none_words_ =
            fmt::format("no method has an error, or none reached {} s, the first point; use more evaluations_per_s",
                        times_s_.front());
    }

    void write_rows(std::span<const TrialNumbers> numbers, Csv& table) const override {
        for (std::size_t r = 0; r < runs_.size(); ++r) {
            const auto energy = values(numbers, each_ * r), rods = values(numbers, each_ * r + 1);
            const auto cost = row_of<DriftCost>(numbers[r]);
            for (std::size_t i = 0; i < times_s_.size(); ++i)
                if (!std::isnan(energy[i]))
                    add_row(table, runs_[r].motion.method, runs_[r].model, cost.setting,
                            std::fmin(times_s_[i], cost.failed_at_s), energy[i], rods[i]);
        }
    }

    void draw(std::span<const TrialNumbers> numbers, Figure& figure) const override {
        for (const bool of_rods : {false, true}) {
            auto plot = axes_;
            if (of_rods) plot.y.label = "maximum error of a rod to date, m, with constraints";
            for (const std::size_t run : longest_first(numbers))
                if (of_rods ? has_rods(run) : runs_[run].shows_energy) add_curves(numbers, run, of_rods, plot);
            if (!plot.curves.empty()) figure.panels.push_back(std::move(plot));
        }
        figure.captions.push_back(caption(numbers));
    }

    Json findings(std::span<const TrialNumbers> numbers) const override {
        Json all;
        for (std::size_t r = 0; r < runs_.size(); ++r) {
            const auto cost = row_of<DriftCost>(numbers[r]);
            const bool fails = cost.failed_at_s > 0;
            auto name = fmt::format("{}_{}", runs_[r].motion.method, runs_[r].model);
            std::ranges::replace(name, ' ', '_');
            all[name + "_setting"] = cost.setting;
            all[name + "_evaluations_per_s"] = cost.evaluations_per_s;
            all[name + "_cpu_s"] = cost.cpu_s;
            for (const bool of_rods : {false, true}) {
                if (of_rods && !has_rods(r)) continue;
                const auto found = growth(numbers, r, of_rods);
                const auto quantity = name + (of_rods ? "_rods_" : "_energy_");
                all[quantity + "growth"] = std::string(style_of(found).words);
                all[quantity + "exponent"] = found.exponent;
                if (fails) all[quantity + "doubling_s"] = found.doubling_s;
            }
            if (fails) all[name + "_broken_at_s"] = cost.failed_at_s;
        }
        return all;
    }

private:
    struct Run {
        MotionSpec motion;
        std::string model, label;  // in the table; of the curve
        bool shows_energy;         // the energy is shown for the best model of a method
    };

    void add_run(const std::string& method, Model model, bool is_projected = false) {
        runs_.push_back({{.chain = chain_of(release_),
                          .model = model,
                          .method = method,
                          .stabilise = is_projected ? Stabilise::projection : Stabilise::none},
                         is_projected ? "projected constraints" : std::string(name_of(model)),
                         method + (is_projected ? " projected" : ""),
                         model == Model::angles || (!is_projected && !find_method(method)->angles)});
    }
    bool has_rods(std::size_t run) const { return runs_[run].motion.model == Model::constraints; }

    TrialNumbers compute_trial(std::size_t trial, const std::atomic<bool>& stop) const override {
        const auto run = drift(runs_[trial].motion, evaluations_per_s_, times_s_, stop);
        TrialNumbers numbers;
        append<DriftCost>(numbers, run);
        numbers.insert(numbers.end(), run.errors.begin(), run.errors.end());
        return numbers;
    }

    /// The maximum error to date; NaN is kept.
    std::vector<double> maximum(std::span<const TrialNumbers> numbers, std::size_t run, bool of_rods) const {
        const auto errors = values(numbers, each_ * run + (of_rods ? 1 : 0));
        std::vector<double> worst(errors.begin(), errors.end());
        for (std::size_t i = 1; i < worst.size(); ++i)
            if (!std::isnan(worst[i])) worst[i] = std::fmax(worst[i], worst[i - 1]);
        return worst;
    }
    Growth growth(std::span<const TrialNumbers> numbers, std::size_t run, bool of_rods) const {
        return growth_of(times_s_, maximum(numbers, run, of_rods), row_of<DriftCost>(numbers[run]).failed_at_s);
    }

    /// Curves that end early are drawn last, so that their labels are at their ends.
    std::vector<std::size_t> longest_first(std::span<const TrialNumbers> numbers) const {
        std::vector<std::size_t> order(runs_.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::ranges::stable_sort(order, std::ranges::greater(), [&](std::size_t r) {
            return std::fmin(times_s_.back(), row_of<DriftCost>(numbers[r]).failed_at_s);
        });
        return order;
    }

    /// Adds a line, with a mark if the run fails.
    void add_curves(std::span<const TrialNumbers> numbers, std::size_t run, bool of_rods, Plot& plot) const {
        const auto found = growth(numbers, run, of_rods);
        const auto& style = style_of(found);
        Curve curve{.label = runs_[run].label, .hue = style.hue};
        curve.label += style.law;
        const auto errors = maximum(numbers, run, of_rods);
        const double end_s = row_of<DriftCost>(numbers[run]).failed_at_s;
        for (std::size_t i = 0; i < errors.size(); ++i)
            if (errors[i] > 0) add_point(curve, std::fmin(times_s_[i], end_s), errors[i]);
        if (curve.x.empty()) return;
        if (found.kind == Growth::Kind::failed)
            plot.curves.push_back(
                {.x = {curve.x.back()}, .y = {curve.y.back()}, .mark = Mark::points, .hue = curve.hue});
        plot.curves.push_back(std::move(curve));
    }

    /// The final energy errors, and how to read the curves.
    std::string caption(std::span<const TrialNumbers> numbers) const override {
        std::vector<std::string> bounded;
        bool breaks = false, grow = false;
        for (std::size_t run = 0; run < runs_.size(); ++run) {
            const auto found = growth(numbers, run, false);
            breaks |= found.kind == Growth::Kind::failed;
            grow |=
                !style_of(found).law.empty() || (has_rods(run) && !style_of(growth(numbers, run, true)).law.empty());
            if (runs_[run].shows_energy && found.kind == Growth::Kind::bounded) bounded.push_back(runs_[run].label);
        }
        return fmt::format("{}{}{}.",
                           bounded.empty()
                               ? "No method keeps the error of the energy bounded"
                               : fmt::format("The error of the energy stays bounded with {}", fmt::join(bounded, ", ")),
                           grow ? "; ∝ tells how the others grow" : "",
                           breaks ? fmt::format("{} a dot marks a failed run", grow ? "," : ";") : "");
    }

    SideSpec release_;
    double evaluations_per_s_;
    std::vector<Run> runs_;
};

std::shared_ptr<const Experiment> read_series(FigureReader& reader) {
    SeriesKeys keys;
    const auto table = reader.settings(keys);
    if (keys.is_of_pairs()) return std::make_shared<PairSeries>(reader, table, keys);
    if (keys.quantity == SeriesQuantity::errors) return std::make_shared<Drift>(reader, table, keys);
    return std::make_shared<Spectrum>(reader, table, keys);
}

void list_tables(KeyVisitor& visit) {
    SeriesKeys keys;
    PairCurve curve;
    visit.table(SeriesKeys::table_key, [&](KeyVisitor& table) { keys.fields(table); });
    visit.table("curve", [&](KeyVisitor& table) { curve_fields(table, curve); });
}

}  // namespace

const FigureKind series_kind{"series", read_series, list_tables};

}  // namespace doppel
