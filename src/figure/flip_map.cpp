#include "figure/kinds.hpp"
#include "figure/map_figure.hpp"
#include "integrate/flips.hpp"
#include "scene/captions.hpp"

#include <boost/math/distributions/binomial.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace doppel {
namespace {

/// The share that at least so many of all have, with 95 % confidence, where `hits` of `trials` drawn by lot do
/// (Clopper & Pearson 1934).
double share_at_least(int hits, int trials) {
    return trials == 0 ? 0 : boost::math::binomial_distribution<>::find_lower_bound_on_p(trials, hits, 0.05);
}

/// A release drawn at random: the time to its flip in the map, and by the reference, s; infinite for none, NaN where the
/// motion broke down.
struct CheckRow {
    double time, reference;
};

/// The time to the first flip over all releases θ1 × θ2. The trials after those of the map compare some random releases
/// with a reference ten thousand times finer.
class FlipMap final : public MapFigure {
public:
    static constexpr std::string_view table_key = "flip_map";
    FlipMap() { frame_.x.count = frame_.y.count = 1000; }
    explicit FlipMap(FigureReader& reader) : FlipMap() {
        release_ = reader.release();
        auto system = reader.document.table(reader.top, "system");
        if (release_.links() != 2 || system.has("angle_deg"))
            throw system.fault(system.has("angle_deg") ? "angle_deg" : "links",
                               "is not for a flip map, which releases two links at all angles");
        auto table = reader.settings(*this);
        settings_ = fmt::format("{}omega_deg_per_s = {}\n{}", resolved_chain(release_),
                                toml_value(release_.omega_deg_per_s), table.finish());
        pendulum_ = chain_of(release_).cast<double>();
        make_frame();
    }

    template <class Visit>
    void fields(Visit& visit) {
        constexpr auto cells = from_to(2, most_cells_across);
        visit({"columns", "angles of the upper link", "", cells}, frame_.x.count);
        visit({"rows", "angles of the lower link", "", cells}, frame_.y.count);
        visit({"theta1_range_deg", "of the upper link, [lowest, highest]", "deg", from_to(-180, 180)}, theta1_);
        visit({"theta2_range_deg", "of the lower link", "deg", from_to(-180, 180)}, theta2_);
        visit({"duration_s", "how long a flip is waited for", "s", positive}, spec_.duration);
        spec_.tolerance = flip_tolerance(spec_.duration);
        visit({"tolerance",
               "of the Taylor series: what the last terms of a step may amount to",
               "rad/s",
               {.low = 1e-15, .is_positive = true},
               "1e-8 up to 20 s, for longer times less"},
              spec_.tolerance);
        visit({"checked", "random releases that are compared with a reference", "", from_to(0, 100'000)}, checked_);
    }

    std::string unit() const override { return "releases"; }

    void find(int row, int column, std::span<TrialNumbers> cells, const std::atomic<bool>& stop) const override {
        std::vector<Pendulum<double>> releases;
        for (std::size_t i = 0; i < cells.size(); ++i)
            releases.push_back(released(frame_.x.middle(column + static_cast<int>(i)), frame_.y.middle(row)));
        std::vector<double> times(cells.size());
        first_flips(releases, spec_, times, stop);
        for (std::size_t i = 0; i < cells.size(); ++i) cells[i] = {times[i]};
    }
    /// A time, infinity for no flip, or NaN.
    bool fits_cell(std::span<const double> numbers) const override { return numbers.size() == 1 && !(numbers[0] < 0); }

    void draw(std::span<const TrialNumbers> numbers, Figure& figure) const override {
        MapFigure::draw(numbers, figure);
        auto& plot = figure.panels.back();
        plot.square = true;
        if (has_outline()) plot.curves.push_back(forbidden_outline());
        figure.captions.push_back(
            fmt::format("{} × {} releases{}.{} Taylor series of order 16 in SIMD lanes at tolerance {}{}.",
                        frame_.x.count, frame_.y.count, is_at_rest() ? " from rest" : "",
                        has_outline() ? " Inside the line no rod has the energy to flip." : "",
                        scientific(spec_.tolerance), check_words(check_findings(numbers))));
        if (const auto broken = broken_words(numbers); !broken.empty()) {
            plot.map->none_label += ", or broken down";
            figure.captions.push_back(broken + ": their cells are empty, as those without a flip.");
        }
    }

    std::optional<std::string> nothing_to_draw(std::span<const TrialNumbers> numbers) const override {
        for (std::size_t row = 0; row < row_trials(); ++row)
            if (std::any_of(numbers[row].begin(), numbers[row].end(), [](double time) { return std::isfinite(time); }))
                return std::nullopt;
        const auto broken = broken_words(numbers);
        return fmt::format("none of the {} × {} releases flips within {} s{}: there is no time to draw", frame_.x.count,
                           frame_.y.count, spec_.duration, broken.empty() ? "" : "; " + broken);
    }

    std::vector<Finding> findings(std::span<const TrialNumbers> numbers) const override {
        double flipped = 0, forbidden = 0;
        for (int row = 0; row < frame_.y.count; ++row)
            for (int column = 0; column < frame_.x.count; ++column) {
                flipped += std::isfinite(at(numbers, row, column));
                forbidden += flip_is_forbidden(released(frame_.x.middle(column), frame_.y.middle(row)));
            }
        const double all = static_cast<double>(frame_.x.count) * frame_.y.count;
        const auto found = check_findings(numbers);
        return {{"share_that_flips", flipped / all},
                {"share_forbidden_by_energy", forbidden / all},
                {"checked_releases", static_cast<double>(checked_)},
                {"checked_that_flip", static_cast<double>(found.flip)},
                {"checked_within_10_ms", found.flip == 0 ? NAN : static_cast<double>(found.agreeing) / found.flip},
                {"within_10_ms_at_least", share_at_least(found.agreeing, found.flip)},
                {"checked_median_error_s", found.median}};
    }

private:
    static constexpr int a_check = 10;  // releases to a trial of checks

    void make_frame() {
        frame_.x.from = theta1_.low, frame_.x.to = theta1_.high;
        frame_.y.from = theta2_.low, frame_.y.to = theta2_.high;
        frame_.x_axis = {.label = "release angle θ₁, °"};
        frame_.y_axis = {.label = "release angle θ₂, °"};
        constexpr double many = 90;  // degrees
        if (theta1_.high - theta1_.low > many) frame_.x_axis.every = 45;
        if (theta2_.high - theta2_.low > many) frame_.y_axis.every = 45;
        frame_.columns = {"theta1_deg", "theta2_deg", "flip_time_s"};
        frame_.look = {.label = "time to the first flip, s",
                       .none_label = fmt::format("no flip within {} s", spec_.duration),
                       .high = spec_.duration,
                       .logarithmic = true};
        frame_.is_mirrored = is_at_rest() && theta1_.low == -theta1_.high && theta2_.low == -theta2_.high;
    }

    /// "3 of the releases broke down …"; empty where none did.
    std::string broken_words(std::span<const TrialNumbers> numbers) const {
        long broken = 0;
        for (std::size_t row = 0; row < row_trials(); ++row)
            broken += std::count_if(numbers[row].begin(), numbers[row].end(), [](double t) { return std::isnan(t); });
        if (broken == 0) return "";
        return fmt::format("{} of the releases broke down (no step of 10⁻⁹ s met the tolerance)", broken);
    }

    bool is_at_rest() const { return pendulum_.rate[0] == 0 && pendulum_.rate[1] == 0; }
    /// Whether the map shows releases with and without the energy to flip, by a line.
    bool has_outline() const {
        if (!is_at_rest()) return false;
        const auto line = forbidden_outline();
        for (std::size_t i = 0; i < line.x.size(); ++i)
            if (line.x[i] > theta1_.low && line.x[i] < theta1_.high && line.y[i] > theta2_.low &&
                line.y[i] < theta2_.high)
                return true;
        return false;
    }

    Pendulum<double> released(double theta1_deg, double theta2_deg) const {
        auto p = pendulum_;
        p.angle = {radians(theta1_deg), radians(theta2_deg)};
        return p;
    }

    std::size_t other_trials() const override { return static_cast<std::size_t>((checked_ + a_check - 1) / a_check); }
    TrialNumbers compute_other(std::size_t trial, const std::atomic<bool>& stop) const override {
        return checks(trial, stop);
    }
    bool fits_other(std::size_t trial, std::span<const double> numbers) const override {
        return numbers.size() == checks_of(trial) * numbers_in<CheckRow> &&
               std::none_of(numbers.begin(), numbers.end(), [](double t) { return t < 0; });
    }

    /// How many releases the trial of checks follows.
    std::size_t checks_of(std::size_t trial) const {
        return static_cast<std::size_t>(std::min(a_check, checked_ - static_cast<int>(trial) * a_check));
    }

    /// CheckRows of random releases with the energy to flip.
    TrialNumbers checks(std::size_t trial, const std::atomic<bool>& stop) const {
        std::mt19937_64 random(trial);
        const auto drawn = [&](const Range& range) {
            return (range.high - range.low) * (static_cast<double>(random() >> 11) * 0x1p-53) + range.low;
        };
        TrialNumbers numbers;
        int tries = 1000;
        for (auto left = checks_of(trial); left > 0;) {
            throw_if_set(stop);
            const double theta2 = drawn(theta2_);
            const auto p = released(drawn(theta1_), theta2);
            // a part of the map may have no other releases
            if (flip_is_forbidden(p) && --tries > 0) continue;
            std::array<double, 1> time;
            first_flips(std::span(&p, 1), spec_, time, stop);
            constexpr double finer = 1e-14;
            double reference = NAN;
            try {
                reference = reference_flip(p, spec_.duration, finer);
            } catch (const Error& error) {
                if (error.code() != ExitCode::method_failed) throw;
            }
            append(numbers, CheckRow{time[0], reference});
            --left;
        }
        return numbers;
    }

    struct CheckFindings {
        int flip = 0;         // of the checked: in the map, by the reference, or both
        int agreeing = 0;     // of these: within 10 ms of the reference
        double median = NAN;  // s, of those that flip in both
    };
    CheckFindings check_findings(std::span<const TrialNumbers> numbers) const {
        constexpr double near = 0.01;
        std::vector<double> errors;
        CheckFindings found;
        for (std::size_t trial = row_trials(); trial < numbers.size(); ++trial)
            for (const auto& [ours, reference] : rows_of<CheckRow>(numbers[trial])) {
                if (std::isnan(ours) || std::isnan(reference)) continue;
                const bool both = std::isfinite(ours) && std::isfinite(reference);
                if (both) errors.push_back(std::abs(ours - reference));
                found.flip += std::isfinite(ours) || std::isfinite(reference);
                found.agreeing += both && errors.back() <= near;
            }
        if (errors.empty()) return found;
        std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2), errors.end());
        found.median = errors[errors.size() / 2];
        return found;
    }

    /// What a caption says of them, after the tolerance.
    std::string check_words(const CheckFindings& found) const {
        if (checked_ == 0) return "";
        const auto drawn = fmt::format(": of {} releases drawn by lot, ", checked_);
        if (found.flip == 0)
            return drawn + fmt::format("none flips within {} s, nor by a reference at 10⁻¹⁴", spec_.duration);
        return drawn +
               fmt::format(
                   "{} flip, {} of them within 0.01 s of a reference at 10⁻¹⁴ (so of all that flip, with "
                   "95 % confidence, {:.1f} % at least){}",
                   found.flip, found.agreeing, 100 * share_at_least(found.agreeing, found.flip),
                   std::isnan(found.median) ? "" : fmt::format(", half of them within {} s", scientific(found.median)));
    }

    /// Where the release has just the energy for a flip: Σ W_i cosθ_i = Σ W_i − 2 min W_i (integrate/flips.hpp), by θ1.
    Curve forbidden_outline() const {
        const double w1 = pendulum_.gravity * pendulum_.length[0] * (pendulum_.mass[0] + pendulum_.mass[1]);
        const double w2 = pendulum_.gravity * pendulum_.length[1] * pendulum_.mass[1];
        const double bound = w1 + w2 - 2 * std::min(w1, w2);
        std::vector<std::pair<double, double>> half;  // θ2 ≥ 0
        constexpr int points = 2000;
        for (int i = -points; i <= points; ++i) {
            const double theta1 = 180.0 * i / points, cosine = (bound - w1 * std::cos(radians(theta1))) / w2;
            if (std::abs(cosine) <= 1) half.emplace_back(theta1, std::acos(cosine) / radians(1.0));
        }
        Curve outline;
        const auto add = [&](double theta1, double theta2) {
            outline.x.push_back(theta1);
            outline.y.push_back(theta2);
        };
        for (const auto& [theta1, theta2] : half) add(theta1, theta2);
        for (auto at = half.rbegin(); at != half.rend(); ++at) add(at->first, -at->second);
        if (!half.empty()) add(half.front().first, half.front().second);
        return outline;
    }

    SideSpec release_;
    Pendulum<double> pendulum_;
    FlipSpec spec_;
    Range theta1_{-180, 180}, theta2_{-180, 180};
    int checked_ = 500;
};

}  // namespace

const FigureKind flip_map_kind = kind_of<FlipMap>("flip-map", FigureKind::System::release);

}  // namespace doppel
