#include "scene/certificate.hpp"

#include "analysis/difference.hpp"
#include "analysis/enclosure.hpp"
#include "base/error.hpp"
#include "base/threads.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <mutex>
#include <numeric>
#include <string>
#include <string_view>

namespace doppel {
namespace {

Ball<Wide> decimal(const Quad& number) {
    return ball_of_decimal(text_of(number));
}
std::vector<Ball<Wide>> decimals(const std::vector<Quad>& numbers, const Ball<Wide>& unit = 1) {
    std::vector<Ball<Wide>> all;
    for (const auto& x : numbers) all.push_back(x == 0 ? Ball<Wide>(0) : decimal(x) * unit);
    return all;
}

/// Throws if a key or an entry excludes a proof.
void require_ideal(SideSpec spec) {
    const auto fail = [](std::string_view key, const std::string& found, std::optional<std::size_t> entry = {}) {
        throw PlacedError(
            bad_input("a proof needs two ideal links: no friction, drive, track or further constraint, and no force "
                      "but gravity and droplets; the side has {}",
                      found),
            std::string(key), entry);
    };
    if (!spec.track.is_none()) fail("track", fmt::format("track.file = {}", toml_text(spec.track.file)));
    std::map<std::string_view, std::size_t> counts;  // entries of each table
    for (const auto& entry : entries_of(spec))
        if (const auto number = counts[entry.table]++; entry.kind != "droplet")
            fail(entry.table, fmt::format("a {}{}", entry.kind, entry.name.empty() ? "" : " " + toml_text(entry.name)),
                 number);
    if (spec.links() != 2) fail("links", fmt::format("links = {}", spec.links()));
    const auto& physical = spec.physical;
    for (const auto& property : PhysicalSpec::properties)
        if (physical.has(property))
            fail(property.key, fmt::format("{} = {}", property.key, toml_value(physical.*property.member)));
    if (!physical.is_none())
        fail("pivot", fmt::format("pivot.amplitude_m = {}", toml_value(physical.pivot.amplitude_m)));
}

EnclosedSystem system_of(const SideSpec& spec) {
    require_ideal(spec);
    const auto degree = pi_ball<Ball<Wide>>() / Ball<Wide>(180);
    EnclosedSystem all{{decimals(spec.mass_kg), decimals(spec.length_m), decimals(spec.angle_deg, degree),
                        decimals(spec.omega_deg_per_s, degree), decimal(spec.gravity_m_per_s2)}};
    for (const auto& force : spec.forces)
        all.droplets.push_back({{decimal((*force.position_m)[0]), decimal((*force.position_m)[1])},
                                decimal(force.mass_kg),
                                decimal(force.constant_m3_per_kg_s2.value_or(newton_constant<Quad>()))});
    return all;
}

std::vector<EnclosedSystem> systems_of(const Scene& scene) {
    std::vector<EnclosedSystem> all;
    for (const char letter : scene.letters())
        all.push_back(
            for_side(scene.preset, letter, [&] { return system_of(letter == 'a' ? scene.preset.a : scene.preset.b); }));
    return all;
}

constexpr double sufficient_radius = 1e-6, lost_radius = 0.5;  // of angles and rates: rad, rad/s

using Rows = std::vector<Certificate::Row>;
using Report = std::function<void(long done, long total)>;  // of samples; may throw

template <class Scalar>
Rows rows_of(const std::vector<EnclosedSystem>& sides, const Scene& scene, double largest_radius, int jobs,
             const Report& report) {
    const EnclosureSpec spec{
        .interval = scene.a.motion.sample_interval, .samples = scene.samples, .largest_radius = largest_radius};
    const bool are_same = sides.front() == sides.back();
    std::vector<std::vector<EnclosedState<Scalar>>> motions(are_same ? 1 : sides.size());
    std::vector<long> done(motions.size());
    std::mutex reporting;
    parallel_for(motions.size(), jobs, [&](std::size_t i) {
        motions[i] = enclosures<Scalar>(sides[i], spec, [&](long samples) {
            const std::lock_guard lock(reporting);
            done[i] = samples;
            report(std::accumulate(done.begin(), done.end(), 0L), static_cast<long>(done.size()) * (scene.samples + 1));
        });
    });
    std::vector<Pendulum<Ball<Scalar>>> chains;
    for (const auto& side : sides) chains.push_back(side.chain.cast<Ball<Scalar>>());
    Rows rows(std::min(motions.front().size(), motions.back().size()));
    for (std::size_t n = 0; n < rows.size(); ++n) {
        auto& row = rows[n];
        for (std::size_t i = 0; i < sides.size(); ++i) {
            const auto& state = motions[are_same ? 0 : i][n];
            for (const auto& number : state) row.bounds.push_back({number.low(), number.high()});
            row.radius = std::max({row.radius, state[0].radius, state[1].radius});
        }
        if (sides.size() < 2) continue;
        auto& distance = row.bounds.emplace_back();
        if (are_same) continue;
        const auto between =
            state_space_distance(bobs_of_angles(chains[0], motions[0][n]), bobs_of_angles(chains[1], motions[1][n]));
        distance = {std::max(0.0, between.low()), between.high()};
    }
    return rows;
}

struct Arithmetic {
    int bits;
    const char* words;
    Rows (*rows)(const std::vector<EnclosedSystem>&, const Scene&, double, int, const Report&);
};
constexpr std::array arithmetics{Arithmetic{53, "double", rows_of<double>}, Arithmetic{113, "quad", rows_of<Quad>},
                                 Arithmetic{256, "256 bits", rows_of<Wide>}};

/// Whether the distance of a pair is known to 1 % at all samples but the first, where it may be 0.
bool is_sharp(const Rows& rows) {
    return std::all_of(rows.begin() + 1, rows.end(), [](const Certificate::Row& row) {
        const auto [low, high] = row.bounds.back();
        return high - low <= 0.01 * high;
    });
}

/// Bounds of the error of a run, of the angle with the largest one. `proved`: θ1, θ2
Interval error_of(const Observation& seen, const Interval* proved) {
    Interval error;
    for (std::size_t i = 0; i < 2; ++i) {
        const double angle = seen.bobs[i].theta, rounding = 0x1p-52 * std::abs(angle);
        const auto [low, high] = proved[i];
        error.low = std::max({error.low, low - angle - rounding, angle - high - rounding});
        error.high = std::max({error.high, high - angle + rounding, angle - low + rounding});
    }
    return {error.low * (1 - 0x1p-50), widened(error.high)};
}

void follow_runs(const Scene& scene, Certificate& proved, const std::atomic<bool>& stop) {
    proved.runs.resize(scene.letters().size());
    std::vector<bool> has_left(proved.runs.size());
    PairRun run(scene);
    try {
        for (const auto& row : proved.rows) {
            const auto state = run.next(stop);
            for (std::size_t i = 0; i < proved.runs.size(); ++i) {
                const auto error = error_of(i == 0 ? state.a : state.b, &row.bounds[4 * i]);
                auto& [until, beyond] = proved.runs[i];
                has_left[i] = has_left[i] || !(error.high <= proved.run_radius);
                if (!has_left[i]) until = scene.time(state.sample);
                if (!beyond && error.low > proved.run_radius) beyond = scene.time(state.sample);
            }
        }
    } catch (const RunFailure&) {  // the run ends there
    }
}

/// A pair of larger distances diverges no later.
std::optional<Interval> divergence_of(const Scene& scene, const Certificate& proved) {
    Divergence earliest, latest;
    for (std::size_t n = 0; !scene.is_single() && n < proved.rows.size(); ++n) {
        const double time = scene.time(static_cast<long>(n));
        const auto [low, high] = proved.rows[n].bounds.back();
        earliest.add(time, high);
        latest.add(time, low);
    }
    if (!earliest.since() || !latest.since()) return std::nullopt;
    return Interval{*earliest.since(), *latest.since()};
}

double largest_radius(const Certificate& proved) {
    return std::ranges::max_element(proved.rows, {}, &Certificate::Row::radius)->radius;
}

enum class Rounding { down, up };
/// A number with so many significant digits, rounded in this direction.
std::string bound_text(double number, int digits, Rounding rounding) {
    const bool is_up = rounding == Rounding::up;
    const double share = (is_up ? 0.5 : -0.5) * std::abs(number) * std::pow(10.0, 1 - digits);
    for (double shifted = number;; shifted += share) {
        const auto text = fmt::format("{:.{}g}", shifted, digits);
        const double written = std::strtod(text.c_str(), nullptr);
        if (!(is_up ? written < number : written > number)) return text;
    }
}
std::string time_text(double time_s, Rounding rounding = Rounding::down) {
    return bound_text(time_s, 6, rounding);
}

}  // namespace

void check_provable(const Scene& scene) {
    systems_of(scene);
}

Certificate certificate_of(const Scene& scene, double radius, int jobs, const std::atomic<bool>& stop,
                           const ProofReport& report) {
    const auto sides = systems_of(scene);
    Certificate all{.run_radius = radius};
    const auto watch = [&](long done, long total) {
        throw_if_set(stop);
        if (report) report(done, total, arithmetics[all.precision].words);
    };
    for (;; ++all.precision) {
        const bool is_last = all.precision + 1 == arithmetics.size();
        all.rows =
            arithmetics[all.precision].rows(sides, scene, is_last ? lost_radius : sufficient_radius, jobs, watch);
        if (is_last || (all.last() == scene.samples && (scene.is_single() || is_sharp(all.rows)))) break;
    }
    follow_runs(scene, all, stop);
    all.diverged_s = divergence_of(scene, all);
    return all;
}

std::vector<double> certified_radii(const Scene& scene, std::size_t precision, const std::atomic<bool>& stop) {
    const auto watch = [&](long, long) { throw_if_set(stop); };
    std::vector<double> radii;
    for (const auto& row : arithmetics[precision].rows({systems_of(scene).front()}, scene, lost_radius, 1, watch))
        radii.push_back(row.radius);
    radii.resize(static_cast<std::size_t>(scene.samples) + 1, NAN);
    return radii;
}

double Certificate::run_until_s() const {
    double least = INFINITY;
    for (const auto& run : runs) least = std::min(least, run.until_s.value_or(0));
    return least;
}

std::vector<std::string> certificate_words(const Scene& scene, const Certificate& proved) {
    const double end = scene.time(proved.last());
    std::vector<std::string> all{fmt::format("the true motion is proved until {} s in {}: angles within {} rad",
                                             time_text(end), arithmetics[proved.precision].words,
                                             bound_text(largest_radius(proved), 2, Rounding::up))};
    for (std::size_t i = 0; i < proved.runs.size(); ++i) {
        const auto& run = proved.runs[i];
        auto words = run.until_s ? fmt::format("proved within {:g} rad of the true motion until {} s",
                                               proved.run_radius, time_text(*run.until_s))
                                 : fmt::format("not proved within {:g} rad of the true motion", proved.run_radius);
        if (run.beyond_s) words += fmt::format(", and farther from it at {} s", time_text(*run.beyond_s, Rounding::up));
        all.push_back(fmt::format("side {}: its run is {}", scene.letters()[i], words));
    }
    const auto& distance = proved.rows.back().bounds.back();
    if (!scene.is_single())
        all.push_back(fmt::format("the true distance at {:.6g} s is between {} and {}", end,
                                  bound_text(distance.low, 10, Rounding::down),
                                  bound_text(distance.high, 10, Rounding::up)));
    if (const auto& time = proved.diverged_s)
        all.push_back(fmt::format("the true motions diverge at {} s{}", time_text(time->low),
                                  time->low == time->high ? "" : " to " + time_text(time->high, Rounding::up) + " s"));
    return all;
}

Json certificate_json(const Scene& scene, const Certificate& proved) {
    const auto number = [](const std::optional<double>& x) { return x ? Json(*x) : Json(nullptr); };
    const auto interval = [](const Interval& x) { return Json{x.low, x.high}; };
    Json json{{"bits", arithmetics[proved.precision].bits},
              {"until_s", scene.time(proved.last())},
              {"to_the_end", proved.last() == scene.samples},
              {"largest_radius_rad", largest_radius(proved)},
              {"run_radius_rad", proved.run_radius}};
    for (std::size_t i = 0; i < proved.runs.size(); ++i)
        json[std::string(1, scene.letters()[i])] = {{"run_proved_until_s", number(proved.runs[i].until_s)},
                                                    {"run_proved_beyond_s", number(proved.runs[i].beyond_s)}};
    json["distance"] = scene.is_single() ? Json(nullptr) : interval(proved.rows.back().bounds.back());
    json["diverged_s"] = proved.diverged_s ? interval(*proved.diverged_s) : Json(nullptr);
    return json;
}

}  // namespace doppel
