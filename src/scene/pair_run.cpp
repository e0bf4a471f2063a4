#include "analysis/difference.hpp"
#include "base/clock.hpp"
#include "base/error.hpp"
#include "base/threads.hpp"
#include "scene/scene.hpp"

#include <fmt/format.h>

#include <cmath>
#include <exception>
#include <thread>

namespace doppel {

void PairRun::advance_sides(const std::atomic<bool>& stop, PairState& now) {
    if (!b_) {
        now.a = now.b = a_.advance_to(now.moment(), stop);
        return;
    }
    const auto advance_b = [&] { now.b = b_->advance_to(now.moment(), stop); };
    std::exception_ptr error;
    std::vector<std::jthread> other;
    if (are_large_)
        other = start_threads(1, [&] {
            try {
                advance_b();
            } catch (...) {
                error = std::current_exception();
            }
            other_cpu_s_ += seconds_of(CLOCK_THREAD_CPUTIME_ID);
        });
    const bool is_alone = other.empty();
    now.a = a_.advance_to(now.moment(), stop);
    if (is_alone) return advance_b();
    other.clear();
    if (error) std::rethrow_exception(error);
}

PairState PairRun::advance_to(const Moment& moment, const std::atomic<bool>& stop) {
    PairState now;
    now.sample = sample_ = moment.sample;
    now.share = moment.share;
    advance_sides(stop, now);
    now.energy_error_a = a_.energy_error(now.a);
    now.energy_error_b = b_ ? b_->energy_error(now.b) : now.energy_error_a;
    now.mean_energy_a = a_.mean_energy(now.a);
    now.mean_energy_b = b_ ? b_->mean_energy(now.b) : now.mean_energy_a;
    const bool exact = !now.a.exact.empty() && !now.b.exact.empty();
    const auto distance = [&](const auto& a, const auto& b) {
        if (!differ_in_kind(scene_.preset.a, scene_.preset.b)) return static_cast<double>(state_space_distance(a, b));
        return static_cast<double>(state_space_distance(compared_bobs(scene_, a), compared_bobs(scene_, b)));
    };
    now.distance = exact ? distance(now.a.exact, now.b.exact) : distance(now.a.bobs, now.b.bobs);
    return now;
}

void check_distance(const Scene& scene, const PairState& state) {
    if (std::isfinite(state.distance)) return;
    struct Number {
        std::string what;
        double a = 0, b = 0;
    } worst;
    using Member = double Bob<double>::*;
    const auto all_a = compared_bobs(scene, state.a.bobs), all_b = compared_bobs(scene, state.b.bobs);
    for (std::size_t i = 0; i < all_a.size(); ++i)
        for (const auto& [what, member] : {std::pair<const char*, Member>{"the mass, kg,", &Bob<double>::mass},
                                           {"the place in x, m,", &Bob<double>::x},
                                           {"the place in y, m,", &Bob<double>::y},
                                           {"the velocity in x, m/s,", &Bob<double>::vx},
                                           {"the velocity in y, m/s,", &Bob<double>::vy}}) {
            const double a = all_a[i].*member, b = all_b[i].*member;
            if (std::abs(a - b) > std::abs(worst.a - worst.b))
                worst = {fmt::format("{} of mass {}", what, i + 1), a, b};
        }
    const bool of_b = std::abs(worst.b) > std::abs(worst.a);
    throw Error(state.sample == 0 ? ExitCode::bad_input : ExitCode::method_failed,
                fmt::format("{}: side {}: {} is {:.6g} at t = {} s, and {:.6g} on the other side: the square of their "
                            "difference exceeds 1.8e308",
                            scene.preset.name, of_b ? 'b' : 'a', worst.what, of_b ? worst.b : worst.a,
                            scene.time(state.sample), of_b ? worst.a : worst.b));
}

}  // namespace doppel
