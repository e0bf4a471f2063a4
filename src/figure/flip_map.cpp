#include "figure/kinds.hpp"
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

/// A release drawn at random: the time to its flip in the map, and by the reference, s; infinite for none.
struct CheckRow {
    double time, reference;
};

/// The time to the first flip over all releases θ1 × θ2. A trial is a row of the map; the last trials compare some
/// random releases with a reference ten thousand times finer.
class FlipMap final : public Experiment {
public:
    static constexpr std::string_view table_key = "flip_map";
    FlipMap() = default;
    explicit FlipMap(FigureReader& reader) : release_(reader.release()) {
        auto system = reader.document.table(reader.top, "system");
        if (release_.links() != 2 || system.has("angle_deg"))
            throw system.fault(system.has("angle_deg") ? "angle_deg" : "links",
                               "is not for a flip map, which releases two links at all angles");
        auto table = reader.settings(*this);
        settings_ = fmt::format("{}omega_deg_per_s = {}\n{}", resolved_chain(release_),
                                toml_value(release_.omega_deg_per_s), table.finish());
        pendulum_ = chain_of(release_).cast<double>();
        const bool at_rest = pendulum_.rate[0] == 0 && pendulum_.rate[1] == 0;
        map_trials_ = static_cast<std::size_t>(at_rest ? (rows_ + 1) / 2 : rows_);
    }

    template <class Visit>
    void fields(Visit& visit) {
        constexpr auto cells = from_to(2, 20'000);
        visit({"columns", "angles of the upper link, from −180° to 180°", "", cells}, columns_);
        visit({"rows", "angles of the lower link", "", cells}, rows_);
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

    std::size_t trials() const override {
        return map_trials_ + static_cast<std::size_t>((checked_ + a_check - 1) / a_check);
    }
    std::string unit() const override { return "releases"; }
    double units(std::size_t trial) const override {
        return trial < map_trials_ ? columns_ * (is_mirrored(trial) ? 2 : 1) : 0;
    }

    bool fits(std::size_t trial, std::span<const double> numbers) const override {
        // a time, or infinity for no flip
        const auto count = trial < map_trials_ ? static_cast<std::size_t>(columns_)
                                               : checks_of(trial - map_trials_) * numbers_in<CheckRow>;
        return numbers.size() == count && std::all_of(numbers.begin(), numbers.end(), [](double t) { return t >= 0; });
    }

    std::vector<std::string> columns() const override { return {"theta1_deg", "theta2_deg", "flip_time_s"}; }

    void write_rows(std::span<const TrialNumbers> numbers, Csv& table) const override {
        for (int r = 0; r < rows_; ++r)
            for (int c = 0; c < columns_; ++c) {
                const double time = at(numbers, r, c);
                add_row(table, angle_deg(c, columns_), angle_deg(r, rows_), std::isfinite(time) ? time : NAN);
            }
    }

    void draw(std::span<const TrialNumbers> numbers, Figure& figure) const override {
        Plot plot;
        plot.x = {.label = "release angle θ₁, °", .low = -180, .high = 180, .every = 45};
        plot.y = {.label = "release angle θ₂, °", .low = -180, .high = 180, .every = 45};
        plot.square = true;
        HeatMap map{.columns = static_cast<std::size_t>(columns_),
                    .rows = static_cast<std::size_t>(rows_),
                    .x_low = -180,
                    .x_high = 180,
                    .y_low = -180,
                    .y_high = 180,
                    .label = "time to the first flip, s",
                    .none_label = fmt::format("no flip within {} s", spec_.duration),
                    .high = spec_.duration,
                    .logarithmic = true};
        for (int r = 0; r < rows_; ++r)
            for (int c = 0; c < columns_; ++c) {
                const double time = at(numbers, r, c);
                map.values.push_back(static_cast<float>(std::isfinite(time) ? time : NAN));
            }
        plot.map = std::move(map);
        plot.curves.push_back(forbidden_outline());
        figure.panels.push_back(std::move(plot));
        const auto found = check_findings(numbers);
        figure.captions.push_back(fmt::format(
            "{} × {} releases from rest. Inside the line no rod has the energy to flip. Taylor series of order 16 in "
            "SIMD lanes at tolerance {}: of {} releases drawn by lot, {} flip within 0.01 s of a reference at 10⁻¹⁴ "
            "(so of all, with 95 % confidence, {:.1f} % at least), half of them within {} s.",
            columns_, rows_, scientific(spec_.tolerance), checked_, found.agreeing,
            100 * share_at_least(found.agreeing, checked_), scientific(found.median)));
    }

    std::vector<Finding> findings(std::span<const TrialNumbers> numbers) const override {
        double flipped = 0, forbidden = 0;
        for (int r = 0; r < rows_; ++r)
            for (int c = 0; c < columns_; ++c) {
                flipped += std::isfinite(at(numbers, r, c));
                forbidden += flip_is_forbidden(released(angle_deg(c, columns_), angle_deg(r, rows_)));
            }
        const double all = static_cast<double>(rows_) * columns_;
        const auto found = check_findings(numbers);
        return {{"share_that_flips", flipped / all},
                {"share_forbidden_by_energy", forbidden / all},
                {"checked_releases", static_cast<double>(checked_)},
                {"checked_within_10_ms", checked_ == 0 ? 1 : static_cast<double>(found.agreeing) / checked_},
                {"within_10_ms_at_least", share_at_least(found.agreeing, checked_)},
                {"checked_median_error_s", found.median}};
    }

private:
    static constexpr int a_check = 10;  // releases to a trial of checks

    /// The middle of a cell; mirror images have exactly opposite angles.
    static double angle_deg(int cell, int cells) { return 180.0 * (2 * cell + 1 - cells) / cells; }

    Pendulum<double> released(double theta1_deg, double theta2_deg) const {
        auto p = pendulum_;
        p.angle = {radians(theta1_deg), radians(theta2_deg)};
        return p;
    }

    /// Whether a trial's row stands for its mirror image at (−θ1, −θ2) too.
    bool is_mirrored(std::size_t trial) const {
        return map_trials_ < static_cast<std::size_t>(rows_) &&
               static_cast<int>(trial) != rows_ - 1 - static_cast<int>(trial);
    }

    TrialNumbers compute_trial(std::size_t trial, const std::atomic<bool>& stop) const override {
        return trial < map_trials_ ? row(trial, stop) : checks(trial - map_trials_, stop);
    }

    TrialNumbers row(std::size_t trial, const std::atomic<bool>& stop) const {
        std::vector<Release> releases;
        const double theta2 = radians(angle_deg(static_cast<int>(trial), rows_));
        for (int c = 0; c < columns_; ++c) releases.push_back({radians(angle_deg(c, columns_)), theta2});
        TrialNumbers times(releases.size());
        first_flips(pendulum_, releases, spec_, times, stop);
        return times;
    }

    double at(std::span<const TrialNumbers> numbers, int r, int c) const {
        const bool below = static_cast<std::size_t>(r) < map_trials_;
        return below ? numbers[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)]
                     : numbers[static_cast<std::size_t>(rows_ - 1 - r)][static_cast<std::size_t>(columns_ - 1 - c)];
    }

    /// How many releases the trial of checks follows.
    std::size_t checks_of(std::size_t trial) const {
        return static_cast<std::size_t>(std::min(a_check, checked_ - static_cast<int>(trial) * a_check));
    }

    /// CheckRows of random releases with the energy to flip.
    TrialNumbers checks(std::size_t trial, const std::atomic<bool>& stop) const {
        std::mt19937_64 random(trial);
        const auto drawn = [&] { return 360.0 * (static_cast<double>(random() >> 11) * 0x1p-53) - 180; };
        TrialNumbers numbers;
        for (auto left = checks_of(trial); left > 0;) {
            const auto p = released(drawn(), drawn());
            if (flip_is_forbidden(p)) continue;
            throw_if_set(stop);
            const std::array releases{Release{p.angle[0], p.angle[1]}};
            std::array<double, 1> time;
            first_flips(pendulum_, releases, spec_, time, stop);
            constexpr double finer = 1e-14;
            append(numbers, CheckRow{time[0], reference_flip(p, spec_.duration, finer)});
            --left;
        }
        return numbers;
    }

    struct CheckFindings {
        int agreeing = 0;   // of the checked: within 10 ms of the reference, or no flip in both
        double median = 0;  // s, of those that flip in both
    };
    CheckFindings check_findings(std::span<const TrialNumbers> numbers) const {
        constexpr double near = 0.01;
        std::vector<double> errors;
        int agreeing = 0;
        for (std::size_t trial = map_trials_; trial < numbers.size(); ++trial)
            for (const auto& [ours, reference] : rows_of<CheckRow>(numbers[trial])) {
                const bool both = std::isfinite(ours) && std::isfinite(reference);
                if (both) errors.push_back(std::abs(ours - reference));
                agreeing += both ? errors.back() <= near : std::isfinite(ours) == std::isfinite(reference);
            }
        if (errors.empty()) return {agreeing, 0};
        std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2), errors.end());
        return {agreeing, errors[errors.size() / 2]};
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
    int columns_ = 1000, rows_ = 1000, checked_ = 500;
    std::size_t map_trials_ = 0;
};

}  // namespace

const FigureKind flip_map_kind = kind_of<FlipMap>("flip-map", FigureKind::System::release);

}  // namespace doppel
