#include "figure/series.hpp"

#include "base/error.hpp"
#include "film/pair_table.hpp"
#include "scene/captions.hpp"
#include "scene/certificate.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace doppel {
namespace {

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

bool is_of_both(std::string_view film_column) {
    return film_column == "distance" || film_column == "log_ratio";
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
class PairSeries final : public Experiment {
public:
    PairSeries(FigureReader& reader, const TomlReader& table, SeriesKeys& keys)
        : logarithmic_(keys.logarithmic), check_tolerance_(keys.check_tolerance) {
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
        unit_ = "pairs";
        bool differ = false;
        for (auto& curve : curves_) {
            curve.pair.energy_columns = true;
            const auto scene = make_scene(curve.pair);  // reports errors now
            samples_ = scene.samples;
            auto known = columns_of(scene);
            known.erase(known.begin(), known.begin() + 2);  // sample and time
            known.insert(known.end(), certified_columns.begin(), certified_columns.end());
            if (is_certified(*curve.film_column)) check_provable(scene);
            if (std::ranges::count(known, *curve.film_column) == 0)
                throw table.error("film_column", "must be one of {}; it is \"{}\"", fmt::join(known, ", "),
                                  *curve.film_column);
            differ |= !is_of_both(*curve.film_column) || !are_one(scene);
            if (curve.film_column == "log_ratio" && have_same_release(curve.pair.a, curve.pair.b))
                throw table.error("quantity",
                                  "\"log_ratio\" needs sides that are released differently: there is no "
                                  "ratio to a distance of 0");
            if (check_tolerance_ && !(curve.pair.a.tolerance && curve.pair.b.tolerance))
                throw table.error("check_tolerance", "needs adaptive methods on both sides");
        }
        if (!differ)
            throw table.error("quantity", "\"{}\" compares the two sides, which are the same; let [b] differ from [a]",
                              shown);
        settings_ = resolved_settings(settings_text(keys));
    }

    std::size_t trials() const override { return curves_.size() * (check_tolerance_ ? 2 : 1); }

    bool fits(std::size_t trial, std::span<const double> numbers) const override {
        const bool is_distance = curves_[trial % curves_.size()].film_column == "distance";
        return numbers.size() == static_cast<std::size_t>(samples_) + 1 &&
               (is_distance ? all_finite(numbers) : finite_or_none(numbers));
    }

    void write_rows(std::span<const TrialNumbers> numbers, Csv& table) const override {
        for (long n = 0; n <= samples_; ++n) {
            table.add(n);
            table.add(time(n));
            for (std::size_t i = 0; i < curves_.size(); ++i)
                table.add_or_empty(numbers[i][static_cast<std::size_t>(n)]);
            table.end_row();
        }
    }

    void draw(std::span<const TrialNumbers> numbers, Figure& figure) const override {
        Plot plot;
        plot.x = {.label = "time, s", .low = 0, .high = time(samples_)};
        plot.y = {.label = shown_words(), .logarithmic = logarithmic_};
        for (std::size_t i = 0; i < curves_.size(); ++i) {
            Curve curve{.label = curves_[i].label, .y = numbers[i], .hue = static_cast<int>(i)};
            for (long n = 0; n <= samples_; ++n) curve.x.push_back(time(n));
            plot.curves.push_back(std::move(curve));
        }
        figure.panels.push_back(std::move(plot));
        if (!check_tolerance_) return;
        std::string words;
        for (std::size_t i = 0; i < curves_.size(); ++i)
            words += fmt::format("{}{} until {:.1f} s", i == 0 ? ":" : ",",
                                 curves_[i].label.empty() ? "" : " " + curves_[i].label, agree_until(numbers, i));
        const bool are_distances =
            std::ranges::all_of(curves_, [](const auto& c) { return c.film_column == "distance"; });
        figure.captions.push_back(fmt::format("Converged: at tolerance {} the {} are the same within 1 %{}.",
                                              number_text(*check_tolerance_), are_distances ? "distances" : "values",
                                              words));
    }

    std::optional<std::string> nothing_to_draw(std::span<const TrialNumbers> numbers) const override {
        if (!logarithmic_) return std::nullopt;
        for (const auto& trial : numbers.first(curves_.size()))
            if (std::ranges::any_of(trial, [](double x) { return x > 0; })) return std::nullopt;
        return "nothing is greater than 0, which a logarithmic axis cannot show; set series.logarithmic = false";
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

    TrialNumbers compute_trial(std::size_t trial, const std::atomic<bool>& stop) const override {
        const auto scene = make_scene(pair_of(trial));
        const auto& shown = *curves_[trial % curves_.size()].film_column;
        if (const auto* of = std::ranges::find(certified_columns, shown); of != certified_columns.end())
            return certified_radii(scene, static_cast<std::size_t>(of - certified_columns.begin()), stop);
        const auto names = columns_of(scene);
        const auto column = static_cast<std::size_t>(std::ranges::find(names, shown) - names.begin());
        PairRun run(scene);
        TrialNumbers values;
        double start = 0;
        for (long n = 0; n <= samples_; ++n) {
            const Snapshot now{run.next(stop), {}};
            if (n == 0) start = now.pair.distance;
            values.push_back(numbers_of(scene, now, start)[column]);
        }
        return values;
    }

    /// The description of the curves.
    std::string shown_words() const {
        std::vector<std::string> all;
        bool of_a = true, of_b = true;
        for (const auto& curve : curves_) {
            of_a &= curve.film_column->starts_with("a_");
            of_b &= curve.film_column->starts_with("b_");
            if (auto words = column_words(*curve.film_column); std::ranges::count(all, words) == 0)
                all.push_back(std::move(words));
        }
        return fmt::format("{}{}", fmt::join(all, "; "), of_a ? " (a)" : of_b ? " (b)" : "");
    }

    double time(long sample) const {
        const auto& rate = curves_.front().pair.sample_hz;
        return static_cast<double>(sample) * static_cast<double>(rate.denominator) /
               static_cast<double>(rate.numerator);
    }

    /// First the curves, then the same pairs at the finer tolerance.
    Preset pair_of(std::size_t trial) const {
        auto pair = curves_[trial % curves_.size()].pair;
        if (trial >= curves_.size()) pair.a.tolerance = pair.b.tolerance = check_tolerance_;
        return pair;
    }

    /// The time up to which both tolerances agree within 1 %, s.
    double agree_until(std::span<const TrialNumbers> numbers, std::size_t curve) const {
        constexpr double allowed = 0.01;
        const auto &one = numbers[curve], &other = numbers[curve + curves_.size()];
        for (std::size_t n = 0; n < one.size(); ++n)
            if (std::abs(one[n] - other[n]) > allowed * std::abs(other[n]))
                return n == 0 ? 0 : time(static_cast<long>(n) - 1);
        return time(samples_);
    }

    bool logarithmic_;
    std::optional<Quad> check_tolerance_;
    std::vector<PairCurve> curves_;
    long samples_ = 0;
};

/// Convergence of the estimates of all Lyapunov exponents of one motion.
class Spectrum final : public Experiment {
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
        for (std::size_t i = 1; i <= exponents(); ++i) columns_.push_back(fmt::format("exponent{}_per_s", i));
        columns_.emplace_back("sum_per_s");
        subtitle_ = motion_words(release_) + "; tangent equations in canonical variables, dop853";
    }

    std::size_t trials() const override { return 1; }

    bool fits(std::size_t /*trial*/, std::span<const double> numbers) const override {
        return numbers.size() == static_cast<std::size_t>(spec_.samples) * (exponents() + 1) && all_finite(numbers);
    }

    void write_rows(std::span<const TrialNumbers> numbers, Csv& table) const override {
        for (const auto& sample : samples_of(numbers)) {
            table.add(sample.time_s);
            for (const double exponent : sample.exponents) table.add(exponent);
            add_row(table, sum(sample));
        }
    }

    void draw(std::span<const TrialNumbers> numbers, Figure& figure) const override {
        Plot plot;
        plot.x = {.label = "time, s", .logarithmic = true};
        plot.y = {.label = "running estimates of the exponents, 1/s"};
        const auto samples = samples_of(numbers);
        for (std::size_t i = 0; i < exponents(); ++i) {
            Curve curve{.label = "λ" + subscript(i + 1), .hue = static_cast<int>(i)};
            for (const auto& sample : samples) add_point(curve, sample.time_s, sample.exponents[i]);
            plot.curves.push_back(std::move(curve));
        }
        plot.rules.push_back({Rule::Orientation::horizontal, 0, ""});
        figure.panels.push_back(std::move(plot));
        std::string words;
        const auto& last = samples.back();
        for (const double exponent : last.exponents)
            words += fmt::format("{}{}{:.4f}", words.empty() ? "" : ", ", exponent < 0 ? "−" : "+", std::abs(exponent));
        const auto of_them =
            preserves_volume()
                ? fmt::format("Their sum is 0 within {}, and the pairs are ± within {} 1/s.",
                              scientific(std::abs(sum(last))), scientific(pair_mismatch(last)))
                : fmt::format("Their sum is −{:.4f} 1/s, the mean rate at which friction contracts phase-space volume.",
                              std::abs(sum(last)));
        figure.captions.push_back(fmt::format("After {} s: {} 1/s. {}", spec_.duration_s, words, of_them));
    }

    Json findings(std::span<const TrialNumbers> numbers) const override {
        Json all;
        const auto last = samples_of(numbers).back();
        for (std::size_t i = 0; i < exponents(); ++i) all[fmt::format("exponent{}_per_s", i + 1)] = last.exponents[i];
        all["sum_per_s"] = sum(last);
        if (preserves_volume()) all["pair_mismatch_per_s"] = pair_mismatch(last);
        return all;
    }

private:
    std::size_t exponents() const { return 2 * release_.links(); }

    bool preserves_volume() const { return physical_of(release_).friction.is_none(); }

    TrialNumbers compute_trial(std::size_t, const std::atomic<bool>& stop) const override {
        TrialNumbers numbers;
        const auto samples = lyapunov_spectrum(physical_of(release_).cast<double>(), spec_, stop);
        for (const auto& sample : samples) {
            numbers.push_back(sample.time_s);
            numbers.insert(numbers.end(), sample.exponents.begin(), sample.exponents.end());
        }
        return numbers;
    }
    /// The numbers of each sample: its time, then the exponents.
    std::vector<SpectrumSample> samples_of(std::span<const TrialNumbers> numbers) const {
        std::vector<SpectrumSample> samples;
        const auto each = static_cast<std::ptrdiff_t>(exponents()) + 1;
        for (auto at = numbers[0].begin(); at != numbers[0].end(); at += each)
            samples.push_back({*at, {at + 1, at + each}});
        return samples;
    }
    static double sum(const SpectrumSample& sample) {
        return std::accumulate(sample.exponents.begin(), sample.exponents.end(), 0.0);
    }

    SideSpec release_;
    SpectrumSpec spec_;
};

std::shared_ptr<const Experiment> read_series(FigureReader& reader) {
    SeriesKeys keys;
    const auto table = reader.settings(keys);
    if (keys.is_of_pairs()) return std::make_shared<PairSeries>(reader, table, keys);
    return keys.quantity == SeriesQuantity::errors ? make_drift(reader, table, keys)
                                                   : std::make_shared<Spectrum>(reader, table, keys);
}

void list_tables(KeyVisitor& visit) {
    SeriesKeys keys;
    PairCurve curve;
    visit.table(SeriesKeys::table_key, [&](KeyVisitor& table) { keys.fields(table); });
    visit.table("curve", [&](KeyVisitor& table) { curve_fields(table, curve); });
}

}  // namespace

void SeriesKeys::fields(KeyVisitor& visit) {
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
    visit({"check_tolerance", "runs every pair again at this tolerance, to see how long both agree", "", positive, "",
           of_pairs},
          check_tolerance);
    visit({"duration_s", "of the motion", "s", of_motions, "",
           Condition{!is_of_pairs(), "is for one motion; pairs use that of [scene]"}},
          duration_s);
    visit(
        {"samples", "of the exponents, equally spaced, the last at the end", "", from_to(2, 100'000), "", of_exponents},
        samples);
    visit({"tolerance", "relative error of a step of dop853, of the motion and of its tangents", "", tolerances, "",
           of_exponents},
          tolerance);
    visit({"points_per_decade", "of the curves, from 1 s on", "", from_to(1, 100), "", of_errors}, points_per_decade);
    visit({"evaluations_per_s", "evaluations of the right-hand side a second of motion, the same for all methods", "",
           costs, "", of_errors},
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

const FigureKind series_kind{"series", read_series, list_tables};

}  // namespace doppel
