#include "scene/certificate.hpp"

#include "analysis/difference.hpp"
#include "base/error.hpp"
#include "numeric/ball.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

std::array<std::string, 2> decimals(const std::vector<Quad>& numbers) {
    return {text_of(numbers[0]), text_of(numbers[1])};
}

DecimalPendulum decimals_of(const SideSpec& spec) {
    const auto is_droplet = [](const PartSpec& force) { return force.kind == PartKind::droplet; };
    if (!spec.particles.empty() || spec.links() != 2 || !spec.physical.is_none() || !spec.track.is_none() ||
        !spec.constraints.empty() || !std::all_of(spec.forces.begin(), spec.forces.end(), is_droplet))
        throw bad_input(
            "a proof needs two ideal links: no friction, drive, track or further constraint, and no force "
            "but gravity and droplets");
    DecimalPendulum all{decimals(spec.mass_kg), decimals(spec.length_m), decimals(spec.angle_deg),
                        decimals(spec.omega_deg_per_s), text_of(spec.gravity_m_per_s2)};
    for (const auto& force : spec.forces)
        all.droplets.push_back({text_of(force.constant_m3_per_kg_s2.value_or(newton_constant<Quad>())),
                                text_of(force.mass_kg),
                                {text_of((*force.position_m)[0]), text_of((*force.position_m)[1])}});
    return all;
}

/// Follows the run of a side by its own method.
class RunFollower {
public:
    explicit RunFollower(double radius) : radius_(radius) {}

    void add(double time, const Observation& seen, const std::array<Interval, 4>& proved) {
        Interval error;  // of the angle with the largest one
        for (std::size_t i = 0; i < 2; ++i) {
            const double angle = seen.bobs[i].theta, rounding = 0x1p-52 * std::abs(angle);
            const auto [low, high] = proved[i];
            error.low = std::max({error.low, low - angle - rounding, angle - high - rounding});
            error.high = std::max({error.high, high - angle + rounding, angle - low + rounding});
        }
        if (is_within_ && widened(error.high) <= radius_)
            result_.until_s = time;
        else
            is_within_ = false;
        if (!result_.beyond_s && error.low * (1 - 0x1p-50) > radius_) result_.beyond_s = time;
    }
    const Certificate::OfRun& result() const { return result_; }

private:
    double radius_;
    bool is_within_ = true;
    Certificate::OfRun result_;
};

std::vector<Certificate::OfRun> followed_runs(const Scene& scene, const CertifiedPair& pair, double radius,
                                              const std::atomic<bool>& stop) {
    std::vector<RunFollower> sides(pair.sides.size(), RunFollower(radius));
    PairRun run(scene);
    try {
        for (std::size_t n = 0; n < pair.samples(); ++n) {
            const auto state = run.next(stop);
            const double time = scene.time(state.sample);
            for (std::size_t i = 0; i < sides.size(); ++i)
                sides[i].add(time, i == 0 ? state.a : state.b, pair.sides[i][n]);
        }
    } catch (const RunFailure&) {  // the run ends there
    }
    std::vector<Certificate::OfRun> all;
    for (const auto& side : sides) all.push_back(side.result());
    return all;
}

/// A pair of larger distances diverges no later.
std::optional<Interval> divergence_of(const Scene& scene, const std::vector<Interval>& distance) {
    Divergence earliest, latest;
    for (std::size_t n = 0; n < distance.size(); ++n) {
        const double time = scene.time(static_cast<long>(n));
        earliest.add(time, distance[n].high);
        latest.add(time, distance[n].low);
    }
    if (!earliest.since() || !latest.since()) return std::nullopt;
    return Interval{*earliest.since(), *latest.since()};
}

std::string bits_words(int bits) {
    return bits == certified_bits[0] ? "double" : bits == certified_bits[1] ? "quad" : fmt::format("{} bits", bits);
}

double largest_radius(const CertifiedPair& pair) {
    double largest = 0;
    for (const auto& side : pair.radius) largest = std::max(largest, side.back());
    return largest;
}

}  // namespace

CertifiedPairSpec certified_spec(const Scene& scene) {
    CertifiedPairSpec spec;
    for (const char letter : scene.letters())
        spec.sides.push_back(for_side(scene.preset, letter,
                                      [&] { return decimals_of(letter == 'a' ? scene.preset.a : scene.preset.b); }));
    spec.interval = scene.a.motion.sample_interval;
    spec.samples = scene.samples;
    return spec;
}

Certificate certificate_of(const Scene& scene, double radius, int jobs, const std::atomic<bool>& stop,
                           const CertifiedReport& report) {
    auto spec = certified_spec(scene);
    spec.jobs = jobs;
    Certificate all{certified_pair(spec,
                                   [&](long done, long total) {
                                       throw_if_set(stop);
                                       if (report) report(done, total);
                                   }),
                    radius,
                    {}};
    all.runs = followed_runs(scene, all.pair, radius, stop);
    all.diverged_s = divergence_of(scene, all.pair.distance);
    return all;
}

double Certificate::run_until_s() const {
    double least = runs.front().until_s.value_or(0);
    for (const auto& run : runs) least = std::min(least, run.until_s.value_or(0));
    return least;
}

std::vector<std::string> certificate_words(const Scene& scene, const Certificate& proved) {
    std::vector<std::string> all{fmt::format("the true motion is proved until {:.6g} s in {}: angles within {:.1e} rad",
                                             scene.time(proved.last()), bits_words(proved.pair.bits),
                                             largest_radius(proved.pair))};
    for (std::size_t i = 0; i < proved.runs.size(); ++i) {
        const auto& run = proved.runs[i];
        auto words = run.until_s ? fmt::format("proved within {:g} rad of the true motion until {:.6g} s",
                                               proved.radius, *run.until_s)
                                 : fmt::format("not proved within {:g} rad of the true motion", proved.radius);
        if (run.beyond_s) words += fmt::format(", and farther from it at {:.6g} s", *run.beyond_s);
        all.push_back(fmt::format("side {}: its run is {}", scene.letters()[i], words));
    }
    if (!proved.pair.distance.empty())
        all.push_back(fmt::format("the true distance at {:.6g} s is between {:.10g} and {:.10g}",
                                  scene.time(proved.last()), proved.pair.distance.back().low,
                                  proved.pair.distance.back().high));
    if (const auto& time = proved.diverged_s)
        all.push_back(fmt::format("the true motions diverge at {:.6g} s{}", time->low,
                                  time->low == time->high ? "" : fmt::format(" to {:.6g} s", time->high)));
    return all;
}

Json certificate_json(const Scene& scene, const Certificate& proved) {
    const auto number = [](const std::optional<double>& x) { return x ? Json(*x) : Json(nullptr); };
    const auto interval = [](const Interval& x) { return Json{x.low, x.high}; };
    Json json{{"bits", proved.pair.bits},
              {"until_s", scene.time(proved.last())},
              {"to_the_end", proved.last() == scene.samples},
              {"largest_radius_rad", largest_radius(proved.pair)},
              {"run_radius_rad", proved.radius}};
    for (std::size_t i = 0; i < proved.runs.size(); ++i)
        json[std::string(1, scene.letters()[i])] = {{"run_proved_until_s", number(proved.runs[i].until_s)},
                                                    {"run_proved_beyond_s", number(proved.runs[i].beyond_s)}};
    json["distance"] = proved.pair.distance.empty() ? Json(nullptr) : interval(proved.pair.distance.back());
    json["diverged_s"] = proved.diverged_s ? interval(*proved.diverged_s) : Json(nullptr);
    return json;
}

}  // namespace doppel
