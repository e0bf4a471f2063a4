#include "integrate/flips.hpp"

#include "base/error.hpp"
#include "integrate/flips_kernel.hpp"
#include "integrate/widths.hpp"
#include "numeric/roots.hpp"
#include "numeric/state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace doppel {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

void check(std::span<const Pendulum<double>> pendulums, const FlipSpec& spec, std::span<double> times) {
    for (const auto& p : pendulums)
        if (p.links() != 2) throw bad_input("flips are computed for two links; there are {}", p.links());
    if (pendulums.size() != times.size())
        throw bad_input("{} pendulums have {} times to be written", pendulums.size(), times.size());
    if (!(spec.duration > 0 && std::isfinite(spec.duration)))
        throw bad_input("the duration of a search for flips must be > 0 s; it is {} s", spec.duration);
    if (!(spec.tolerance >= 1e-15 && spec.tolerance <= 1))
        throw bad_input("the tolerance of flips must be from 1e-15 to 1 rad/s; it is {:.3g}", spec.tolerance);
}

}  // namespace

double first_flip(const RodOnStep& rod) {
    struct Outward {
        double value, rate;  // rad beyond the upright position in the direction of the flip, rad/s
    };
    auto theta = Bernstein::of_powers(rod.theta, rod.h);
    theta.b.back() = rod.theta_end;
    const double widest = 1.5 / 32 * theta.length;  // 1/32 of the step, with a margin for rounding
    double first = never;
    const auto [minimum, largest] = std::minmax_element(theta.b.begin(), theta.b.end());
    for (const double sense : {1.0, -1.0}) {
        if (!(sense > 0 ? *largest > pi : *minimum < -pi)) continue;
        auto outward = theta;
        for (double& value : outward.b) value *= sense;
        const auto rises = outward.rises(pi);
        if (rises.empty()) continue;
        const auto at = [&](double t) {
            double angle = rod.theta[flip_order], rate = rod.omega[flip_order];
            for (int k = flip_order - 1; k >= 0; --k) {
                angle = angle * t + rod.theta[k];
                rate = rate * t + rod.omega[k];
            }
            return Outward{sense * angle - pi, sense * rate};
        };
        first = std::min(first, root(rises.front(), at, widest));
    }
    return first;
}

double flip_tolerance(double duration) {
    return std::pow(10, -std::clamp(8 + std::ceil((duration - 20) / 2), 8.0, 14.0));
}

bool flip_is_forbidden(const Pendulum<double>& p) {
    if (p.gravity < 0) return false;  // a rod then needs no energy to stand upright
    double minimum = never, below = 0;
    for (std::size_t i = p.links(); i-- > 0;) {
        below += p.mass[i];
        minimum = std::min(minimum, 2 * p.gravity * p.length[i] * below);
    }
    return released_energy(p) < minimum;
}

void first_flips(std::span<const Pendulum<double>> pendulums, const FlipSpec& spec, std::span<double> times,
                 const std::atomic<bool>& stop, int width) {
    check(pendulums, spec, times);
    const auto find = at_width(chosen_width(width), []<int chosen>() { return find_flips<chosen>; });
    for (std::size_t i = 0; i < pendulums.size(); ++i) {
        // enters the results known beforehand; a negative time marks the others
        const auto& p = pendulums[i];
        const bool is_beyond = std::max(std::abs(p.angle[0]), std::abs(p.angle[1])) > pi;
        times[i] = is_beyond ? 0 : flip_is_forbidden(p) ? never : -1;
    }
    const Pendulum<double> hanging;
    const FlipRequest request{.duration = spec.duration,
                              .allowed = std::log2(spec.tolerance),
                              .count = pendulums.size(),
                              .pendulums = pendulums.data(),
                              .hanging = &hanging,
                              .times = times.data(),
                              .stop = &stop};
    if (!find(request)) throw interrupted();
}

}  // namespace doppel
