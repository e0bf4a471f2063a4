#include "scene/scene.hpp"

#include "analysis/difference.hpp"
#include "base/error.hpp"
#include "base/machine.hpp"
#include "base/threads.hpp"
#include "scene/captions.hpp"
#include "scene/certificate.hpp"
#include "scene/method_choice.hpp"
#include "scene/numeric_key.hpp"
#include "scene/resolved.hpp"
#include "scene/side_keys.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>

namespace doppel {

double Scene::time(const Moment& moment) const {
    return (static_cast<double>(moment.sample) + moment.share) * static_cast<double>(preset.sample_hz.denominator) /
           static_cast<double>(preset.sample_hz.numerator);
}

std::optional<double> Scene::horizon() const {
    long first = samples;
    for (const auto* side : {&a, &b})
        if (side->choice) first = std::min(first, side->choice->horizon);
    if (first == samples) return std::nullopt;
    return time(first);
}

namespace {

/// Throws Error (exit 2) if a side would run longer than its track.
void check_tracks(const Scene& scene) {
    const auto& preset = scene.preset;
    for (const auto* side : {&scene.a, &scene.b}) {
        if (!side->replay) continue;
        const auto maximum = longest_duration(*side->replay, preset.sample_hz);
        const double seconds = maximum.value();  // as a decimal, if that is exact
        const auto text = rational_from_decimal(seconds) == maximum
                              ? fmt::format("{}", seconds)
                              : fmt::format("{} ({:.4g} s)", toml_ratio(maximum), seconds);
        if (preset.duration_s.value() > seconds)
            throw bad_input(
                "{}: [scene] duration_s must be at most {}, as long as the track of side {} lasts; it is {}",
                preset.name, text, side == &scene.a ? "a" : "b", preset.duration_s.value());
    }
}

/// With fixed steps, a frame between samples shows the nearest step. Throws Error (exit 2) if its time is wrong by more
/// than a sixteenth of the frame interval: the film would stutter.
void check_steps(const Scene& scene) {
    const auto& speed = scene.preset.video.speed;
    const double between_frames = speed.slowest().value() / scene.fps.value();  // s of motion
    constexpr double min_steps = 8;
    for (const auto* side : {&scene.a, &scene.b}) {
        if (side->replay || side->method.adaptive || between_frames >= min_steps * side->step.value()) continue;
        const auto steps = product(scene.frames.stride, {side->motion.steps_per_sample, 1});
        if (!speed.changes_over_time() && steps && steps->is_whole()) continue;
        throw bad_input(
            "{}: [video] frames are {:.3g} s of the motion apart and not all at steps, which are {:.3g} s long on side "
            "{}: they must be at most {:.3g} s, by a smaller step_s or accuracy",
            scene.preset.name, between_frames, side->step.value(), side == &scene.a ? "a" : "b",
            between_frames / min_steps);
    }
}

/// The members of an ensemble, integrated as side a. Numbers that no list gives go from side a to side b in equal
/// steps.
std::vector<MotionSpec> members_of(const Scene& scene) {
    const auto &first = scene.preset.a, &last = scene.preset.b;
    std::vector<MotionSpec> members;
    const auto& requested = scene.preset.video.members;
    for (std::size_t k = 0; k < requested.size(); ++k) {
        auto member = between(first, last, Quad(k) / Quad(requested.size() - 1));
        for (const auto& list : Release::lists)
            if (!requested.releases.empty() && !(requested.releases[k].*list.member).empty())
                member.*list.of_side = requested.releases[k].*list.member;
        members.push_back(scene.a.motion);
        members.back().chain = chain_of(member);
        if (!member.physical.is_none()) members.back().physical = physical_of(member);
        members.back().wants_tension = false;
    }
    return members;
}

/// A number of a mass, in words: {} = the number of the mass.
constexpr std::array<std::pair<const char*, double Bob<double>::*>, 7> bob_numbers{
    {{"the rate ω{}", &Bob<double>::omega},
     {"the angle θ{}", &Bob<double>::theta},
     {"mass {}", &Bob<double>::mass},
     {"the place in x of mass {}", &Bob<double>::x},
     {"the place in y of mass {}", &Bob<double>::y},
     {"the velocity in x of mass {}", &Bob<double>::vx},
     {"the velocity in y of mass {}", &Bob<double>::vy}}};

/// The first number of the observation that is not finite, in words; nothing if all are.
std::optional<std::string> not_finite(const Observation& seen) {
    const auto text = [](double value) { return std::isnan(value) ? "not a number" : fmt::to_string(value); };
    for (std::size_t i = 0; i < seen.bobs.size(); ++i)
        for (const auto& [words, member] : bob_numbers)
            if (const double value = seen.bobs[i].*member; !std::isfinite(value))
                return fmt::format(fmt::runtime(words), i + 1) + " is " + text(value);
    if (!std::isfinite(seen.energy)) return "the energy is " + text(seen.energy);
    if (!std::isfinite(seen.length_error)) return "the rod error is " + text(seen.length_error);
    return std::nullopt;
}

}  // namespace

Scene make_scene(const Preset& preset, const std::atomic<bool>& stop, const ProofReport& report) {
    const double wall_start = seconds_of(CLOCK_MONOTONIC), cpu_start = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
    const bool chooses = preset.a.is_chosen() || preset.b.is_chosen();
    const auto chooser = chooses ? std::make_shared<MethodChooser>(preset, stop) : nullptr;
    auto chosen = chooser ? chooser->choose(1, stop) : std::array<std::optional<Side>, 2>{};
    const auto side_of = [&](const SideSpec& spec, std::size_t place) {
        return chosen[place] ? std::move(*chosen[place])
                             : for_side(preset, "ab"[place], [&] { return make_side(spec, preset.sample_hz); });
    };
    Scene scene{.preset = preset,
                .a = side_of(preset.a, 0),
                .b = side_of(preset.b, 1),
                .samples = product(preset.duration_s, preset.sample_hz)->numerator,
                .chooser = chooser};
    scene.fps = preset.video.fps ? *preset.video.fps : *product(preset.sample_hz, preset.video.speed.constant);
    scene.frames = frame_times(preset, scene.fps, scene.samples);
    check_steps(scene);
    auto& strips = scene.preset.video.strips;
    const bool wants_tension = std::ranges::count(strips, StripKind::rod_force) > 0;
    for (auto* side : {&scene.a, &scene.b}) {
        if (side->replay || side->has_work) std::ranges::replace(strips, StripKind::energy, StripKind::total_energy);
        if (wants_tension && (side->motion.physical || side->replay))
            throw bad_input(
                "{}: [video] panels: \"rod-force\" needs massless rods; links with mass, friction or a drive, and "
                "tracks, have no rod tension",
                preset.name);
        side->motion.wants_tension = wants_tension;
    }
    check_difference(scene);
    check_tracks(scene);
    if (preset.video.layout == Arrangement::ensemble) scene.members = members_of(scene);
    if (preset.certify && !scene.members.empty())
        throw bad_input(
            "{}: [scene] certify is not for the layout \"ensemble\"; without it, doppel certify proves sides a and b",
            preset.name);
    if (preset.certify)
        scene.certificate =
            std::make_shared<Certificate>(certificate_of(scene, usual_run_radius, cores(), stop, report));
    scene.made_wall_s = seconds_of(CLOCK_MONOTONIC) - wall_start;
    scene.made_cpu_s = seconds_of(CLOCK_PROCESS_CPUTIME_ID) - cpu_start;
    return scene;
}

SideRun::SideRun(const Scene& scene, const Side& side, char name)
    : scene_(scene),
      side_(side),
      name_(name),
      motion_(
          for_side(scene.preset, name,
                   [&] { return side.replay ? make_replay(side.motion, *side.replay) : make_motion(side.motion); })),
      proportion_(motion_->observe(), side.energy_unit, side.reach) {
    if (const auto period = drive_period(name == 'a' ? scene.preset.a : scene.preset.b, scene.preset.duration_s))
        energy_.emplace(*period);
}

RunFailure SideRun::broken(const std::string& what) const {
    return {fmt::format("{}: side {} failed by t = {} s: {} ({}, {}, {})", scene_.preset.name, name_, scene_.time(now_),
                        what, name_of(side_.motion.model), side_.method.title, step_control_text(side_)),
            name_, now_.share > 0 ? now_.sample + 1 : now_.sample};
}

void SideRun::watch(const Observation& seen) {
    if (const auto error = not_finite(seen)) throw broken(*error);
    if (seen.energy_change > proportion_.gain)
        throw broken(fmt::format("the energy has grown by {:.3g} J, more than tenfold", seen.energy_change));
    if (seen.length_error > proportion_.reach)
        throw broken(fmt::format("the length of a rod has an error of {:.3g} m, more than the length of the chain",
                                 seen.length_error));
}

SideState SideRun::advance_to(const Moment& moment, const std::atomic<bool>& stop) {
    throw_if_set(stop);
    const bool is_released = now_.sample < 0;
    now_ = moment;
    try {
        if (moment.share > 0)
            motion_->advance_within(moment.share, stop);
        else if (!is_released)
            motion_->advance(stop);
    } catch (const Error& error) {
        if (error.code() != ExitCode::method_failed) throw;
        throw broken(error.what());
    }
    SideState seen{motion_->observe()};
    watch(seen);
    if (side_.has_energy_error) seen.energy_error = seen.energy_change / proportion_.energy;
    const double time = scene_.time(now_);
    if (energy_ && moment.share == 0) energy_->add(time, seen.energy);
    seen.mean_energy = energy_ ? energy_->at(time, seen.energy) : seen.energy;
    return seen;
}

std::optional<double> drive_period(const SideSpec& spec, const Rational& duration_s) {
    std::optional<double> longest;
    const auto add = [&](const Quad& amplitude, const Quad& frequency_hz) {
        const double period = 1 / static_cast<double>(frequency_hz);
        if (amplitude != 0 && period < duration_s.value()) longest = std::max(longest.value_or(0), period);
    };
    add(spec.physical.pivot.amplitude_m, spec.physical.pivot.frequency_hz);
    for (const auto& torque : spec.physical.torques) add(torque.amplitude_N_m, torque.frequency_hz);
    return longest;
}

void PeriodMean::add(double time, double value) {
    points_.push_back(points_.empty() ? Point{time, value, 0} : next(points_.back(), time, value));
    while (points_.size() > 1 && points_[1].time <= time - period_) points_.pop_front();
}

std::optional<double> PeriodMean::at(double time, double value) const {
    constexpr double rounding = 1e-9;
    const double begin = time - period_;
    if (points_.empty() || begin < points_.front().time - rounding * period_) return std::nullopt;
    const auto after = std::ranges::find_if(points_, [&](const Point& point) { return point.time > begin; });
    const auto last = next(points_.back(), time, value);
    const auto &to = after == points_.end() ? last : *after,
               &from = after == points_.begin() ? points_.front() : *std::prev(after);
    const double share = to.time > from.time ? (begin - from.time) / (to.time - from.time) : 0;
    const auto first = next(from, begin, std::lerp(from.value, to.value, share));
    return (last.integral - first.integral) / period_;
}

PairState PairRun::advance_to(const Moment& moment, const std::atomic<bool>& stop) {
    PairState now{moment};
    sample_ = moment.sample;
    std::exception_ptr error;  // of side b; one of side a comes first
    const auto advance_b = [&] {
        try {
            now.b = b_->advance_to(moment, stop);
        } catch (...) {
            error = std::current_exception();
        }
    };
    auto other = start_threads(b_ && are_large_ ? 1 : 0, [&] {
        advance_b();
        other_cpu_s_ += seconds_of(CLOCK_THREAD_CPUTIME_ID);
    });
    const bool is_alone = other.empty();
    now.a = a_.advance_to(moment, stop);
    other.clear();
    if (!b_)
        now.b = now.a;
    else if (is_alone)
        advance_b();
    if (error) std::rethrow_exception(error);
    const bool exact = !now.a.exact.empty() && !now.b.exact.empty();
    const auto distance = [&]<class Scalar>(const Bobs<Scalar>& a, const Bobs<Scalar>& b) {
        // sides of different types have only their last masses in common
        return static_cast<double>(differ_in_kind(scene_.preset.a, scene_.preset.b)
                                       ? state_space_distance(Bobs<Scalar>{a.back()}, Bobs<Scalar>{b.back()})
                                       : state_space_distance(a, b));
    };
    now.distance = exact ? distance(now.a.exact, now.b.exact) : distance(now.a.bobs, now.b.bobs);
    return now;
}

void check_distance(const Scene& scene, const PairState& state) {
    if (std::isfinite(state.distance)) return;
    throw Error(
        state.sample == 0 ? ExitCode::bad_input : ExitCode::method_failed,
        fmt::format("{}: side b differs from side a by more than 1e154 m, m/s or kg at t = {} s: the square of their "
                    "distance exceeds 1.8e308",
                    scene.preset.name, scene.time(state.sample)));
}

}  // namespace doppel
