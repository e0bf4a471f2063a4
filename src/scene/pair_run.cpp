#include "analysis/difference.hpp"
#include "scene/captions.hpp"
#include "scene/scene.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

/// The first number of the observation that is none, in words; nothing where all are finite.
std::optional<std::string> not_finite(const Observation& seen, bool has_angles) {
    for (std::size_t i = 0; i < seen.bobs.size(); ++i) {
        const auto& bob = seen.bobs[i];
        const auto name = [&](std::string_view symbol, double value) {
            return fmt::format("{}{} is {}", symbol, i + 1, value);
        };
        if (has_angles && !std::isfinite(bob.omega)) return name("the rate ω", bob.omega);
        if (has_angles && !std::isfinite(bob.theta)) return name("the angle θ", bob.theta);
        if (!std::isfinite(bob.x) || !std::isfinite(bob.y)) return name("the place of mass ", bob.x + bob.y);
        if (!std::isfinite(bob.vx) || !std::isfinite(bob.vy)) return name("the velocity of mass ", bob.vx + bob.vy);
    }
    if (!std::isfinite(seen.energy)) return fmt::format("the energy is {}", seen.energy);
    if (!std::isfinite(seen.length_error)) return fmt::format("the rod error is {}", seen.length_error);
    return std::nullopt;
}

double kinetic_energy(const Bobs<double>& bobs) {
    double sum = 0;
    for (const auto& bob : bobs) sum += 0.5 * bob.mass * (bob.vx * bob.vx + bob.vy * bob.vy);
    return sum;
}

/// Errors say whose they are.
std::unique_ptr<Motion> motion_of(const Scene& scene, const Side& side, char name) {
    try {
        return make_motion(side.motion);
    } catch (const Error& fault) {
        throw Error(fault.code(), fmt::format("{}: side {}: {}", scene.preset.name, name, fault.what()));
    }
}

}  // namespace

SideRun::SideRun(const Scene& scene, const Side& side, char name)
    : scene_(scene), side_(side), name_(name), motion_(motion_of(scene, side, name)) {
    const auto start = motion_->observe();
    energy_scale_ = doppel::energy_scale(start.energy, side.energy_unit);
    // ten times all the energy there is: no true motion gains that
    largest_energy_ = 10 * (side.energy_unit + std::abs(start.energy) + kinetic_energy(start.bobs));
    longest_rod_ = side.reach;
}

std::optional<double> SideRun::energy_error(const Observation& seen) const {
    if (!side_.conserves_energy) return std::nullopt;
    return seen.energy_change / energy_scale_;
}

BreakDown SideRun::broken(const std::string& what) const {
    return {fmt::format("{}: side {} broke down by t = {} s: {} ({}, {}, {})", scene_.preset.name, name_,
                        scene_.time(sample_), what, name_of(side_.motion.model), side_.method.title,
                        step_control_text(side_)),
            name_, sample_};
}

void SideRun::watch(const Observation& seen) {
    if (const auto fault = not_finite(seen, side_.has_angles)) throw broken(*fault);
    if (seen.energy_change > largest_energy_)
        throw broken(
            fmt::format("the energy has grown by {:.3g} J, more than ten times what there is", seen.energy_change));
    if (seen.length_error > longest_rod_)
        throw broken(fmt::format("a rod is off by {:.3g} m, more than all of them are long", seen.length_error));
}

Observation SideRun::next(const std::atomic<bool>& stop) {
    if (stop) throw Error(ExitCode::interrupted, "interrupted");
    ++sample_;
    if (sample_ > 0) {
        try {
            motion_->advance(stop);
        } catch (const Error& fault) {
            if (fault.code() != ExitCode::method_failed) throw;
            throw broken(fault.what());
        }
    }
    auto seen = motion_->observe();
    watch(seen);
    return seen;
}

PairState PairRun::next(const std::atomic<bool>& stop) {
    PairState now;
    now.sample = ++sample_;
    now.a = a_.next(stop);
    now.b = b_.next(stop);
    now.energy_error_a = a_.energy_error(now.a);
    now.energy_error_b = b_.energy_error(now.b);
    const bool exact = !now.a.exact.empty() && !now.b.exact.empty();
    now.distance = exact ? static_cast<double>(state_space_distance(now.a.exact, now.b.exact))
                         : state_space_distance(now.a.bobs, now.b.bobs);
    return now;
}

void check_distance(const Scene& scene, const PairState& state) {
    if (std::isfinite(state.distance)) return;
    struct Number {
        std::string what;
        double a = 0, b = 0;
    } worst;
    for (std::size_t i = 0; i < state.a.bobs.size(); ++i) {
        const auto &a = state.a.bobs[i], &b = state.b.bobs[i];
        const auto look = [&](const char* what, double of_a, double of_b) {
            if (std::abs(of_a - of_b) > std::abs(worst.a - worst.b))
                worst = {fmt::format("{} of mass {}", what, i + 1), of_a, of_b};
        };
        look("the mass, kg,", a.mass, b.mass);
        look("the place in x, m,", a.x, b.x);
        look("the place in y, m,", a.y, b.y);
        look("the velocity in x, m/s,", a.vx, b.vx);
        look("the velocity in y, m/s,", a.vy, b.vy);
    }
    const bool of_b = std::abs(worst.b) > std::abs(worst.a);
    throw Error(state.sample == 0 ? ExitCode::bad_input : ExitCode::method_failed,
                fmt::format("{}: side {}: {} is {:.6g} at t = {} s, and {:.6g} on the other side: the square of their "
                            "difference is out of range, beyond 1.8e308",
                            scene.preset.name, of_b ? 'b' : 'a', worst.what, of_b ? worst.b : worst.a,
                            scene.time(state.sample), of_b ? worst.a : worst.b));
}

}  // namespace doppel
