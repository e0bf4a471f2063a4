#include "figure/series.hpp"

#include "base/error.hpp"
#include "film/pair_table.hpp"
#include "scene/captions.hpp"
#include "scene/certificate.hpp"
#include "scene/side_keys.hpp"

#include <fmt/ranges.h>

#include <cmath>
#include <numeric>

namespace doppel {
namespace {

struct PairCurve {
    std::string column, label;
    std::optional<std::string> film_column;
    Preset pair;
    std::optional<Scene> scene = {};  // made once: an accuracy takes trial runs
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
        auto entries = reader.top.entries("curve");
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
        for (std::size_t i = 0; i < curves_.size(); ++i) {
            auto& curve = curves_[i];
            for (const auto& keys : {differing_keys(first.a, curve.pair.a), differing_keys(first.b, curve.pair.b)})
                for (const auto& key : keys) swept.keys.push_back(fmt::format(".{}", key.any().key));
            curve.pair.energy_columns = true;
            const auto& scene = curve.scene.emplace(make_scene(curve.pair));  // reports errors now
            times_s_.clear();
            for (long n = 0; n <= scene.samples; ++n) times_s_.push_back(scene.time(n));
            auto known = columns_of(scene);
            known.erase(known.begin(), known.begin() + 2);  // sample and time
            known.insert(known.end(), certified_columns.begin(), certified_columns.end());
            if (is_certified(*curve.film_column)) check_provable(scene);
            if (std::ranges::count(known, *curve.film_column) == 0)
                throw(!entries.empty() && entries[i].has("film_column") ? entries[i] : table)
                    .error("film_column", "must be one of {}; it is \"{}\"", fmt::join(known, ", "),
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
            are_finite_.push_back(curve.film_column == "distance");
        }
        if (!differ)
            throw table.error("quantity", "\"{}\" compares the two sides, which are the same; let [b] differ from [a]",
                              shown);
        settings_ = resolved_settings(settings_text(keys));
        unit_ = "pairs";
        subtitle_ = pair_subtitle(*curves_.front().scene, swept);
        shown_ = curves_.size();
        trials_ = shown_ * (check_tolerance_ ? 2 : 1);
        axes_.x = {.label = "time, s", .low = 0, .high = times_s_.back()};
        axes_.y = {.label = shown_words(), .logarithmic = keys.logarithmic};
        none_words_ = "nothing is greater than 0, which a logarithmic axis cannot show; set series.logarithmic = false";
    }

    std::optional<Part> part(double share) const override {
        return cut(*this, share, [](double time_s) { return time_s; });
    }

private:
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
        auto text =
            fmt::format("duration_s = \"{}\"\nsample_hz = \"{}\"\n", base.duration_s.text(), base.sample_hz.text());
        for (const auto& curve : curves_)
            text += fmt::format("\n[[curve]]\ncolumn = {}\nlabel = {}\nfilm_column = {}\n{}", toml_text(curve.column),
                                toml_text(curve.label), toml_text(*curve.film_column),
                                resolved_sides(curve.pair, "curve."));
        return text + own;
    }

    /// First the curves, then the same pairs at the finer tolerance.
    TrialNumbers compute(std::size_t trial, const std::atomic<bool>& stop) const override {
        const auto& curve = curves_[trial % curves_.size()];
        auto scene = *curve.scene;
        if (trial >= curves_.size()) {
            auto pair = curve.pair;
            pair.a.tolerance = pair.b.tolerance = check_tolerance_;
            scene = make_scene(pair);
        }
        scene.samples = static_cast<long>(times_s_.size()) - 1;  // fewer in a part()
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
            throw reader.top.inner("system").error(
                "joint_coulomb_N_m",
                "is not for Lyapunov exponents, which need a smooth motion: these joints stick and slip");
        constexpr std::size_t max_links = 4;
        if (release_.links() > max_links)
            throw table.error("quantity", "= \"exponents\" is for 1 to {} links; there are {}", max_links,
                              release_.links());
        settings_ = resolved_release(release_) + settings_text(keys);
        unit_ = "spectra";
        are_finite_ = {true};
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
        subtitle_ = motion_words(release_) + "; tangent equations by Dormand–Prince 8(5,3)";
    }

private:
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

    TrialNumbers compute(std::size_t, const std::atomic<bool>& stop) const override {
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

std::shared_ptr<const Experiment> read_series(FigureReader& reader) {
    SeriesKeys keys;
    const auto table = reader.settings(keys);
    if (keys.is_of_pairs()) return std::make_shared<PairSeries>(reader, table, keys);
    if (keys.quantity == SeriesQuantity::errors) return drift_series(reader, table, keys);
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
