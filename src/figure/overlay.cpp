#include "figure/overlay.hpp"

#include "figure/experiment.hpp"
#include "scene/scene.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

std::vector<Curve> stability_curves(Overlay overlay, const PhysicalPendulum<double>& p) {
    const double mass = p.chain.mass[0], center = p.center[0], gravity = p.chain.gravity;
    const double length = (p.inertia[0] + mass * center * center) / (mass * center);
    std::vector<Curve> curves;
    const auto add = [&](const char* label, double first, double last, const auto& characteristic) {
        Curve curve{.label = label, .hue = 1};
        constexpr int parts = 400;
        for (int i = 0; i <= parts; ++i) {
            const double q = first * std::pow(last / first, static_cast<double>(i) / parts);
            const double below = -characteristic(q);  // 4 g / (l ν²)
            if (below > 0) add_point(curve, std::sqrt(4 * gravity / (length * below)) / (2 * pi), q * length / 2);
        }
        curves.push_back(std::move(curve));
    };
    if (overlay == Overlay::kapitza) {
        add("Kapitza: stable above", 1e-3, 2, [](double q) { return -q * q / 2; });
        return curves;
    }
    add("a₀ of Mathieu: stable above", 1e-3, 1.2, [](double q) {
        const double s = q * q;
        return s * (-1.0 / 2 + s * (7.0 / 128 + s * (-29.0 / 2304 + s * 68687 / 18874368)));
    });
    add("b₁ of Mathieu: unstable above", 0.9, 1.2,
        [](double q) { return 1 - q * (1 + q * (1.0 / 8 - q * (1.0 / 64 - q * (1.0 / 1536 + q * (11.0 / 36864))))); });
    return curves;
}

Curve energy_bound(const Pendulum<double>& p) {
    const double w1 = p.gravity * p.length[0] * (p.mass[0] + p.mass[1]), w2 = p.gravity * p.length[1] * p.mass[1];
    const double bound = w1 + w2 - 2 * std::min(w1, w2);
    std::vector<std::pair<double, double>> half;  // θ2 ≥ 0
    constexpr int points = 2000;
    for (int i = -points; i <= points; ++i) {
        const double theta1 = 180.0 * i / points, cosine = (bound - w1 * std::cos(radians(theta1))) / w2;
        if (std::abs(cosine) <= 1) half.emplace_back(theta1, std::acos(cosine) / radians(1.0));
    }
    Curve outline;
    for (const auto& [theta1, theta2] : half) add_point(outline, theta1, theta2);
    for (auto at = half.rbegin(); at != half.rend(); ++at) add_point(outline, at->first, -at->second);
    if (!half.empty()) add_point(outline, half.front().first, half.front().second);
    return outline;
}

}  // namespace

std::vector<Curve> overlay_curves(Overlay overlay, const SideSpec& side) {
    if (overlay == Overlay::none || overlay == Overlay::linear_limit) return {};
    if (overlay == Overlay::energy_bound) return {energy_bound(chain_of(side).cast<double>())};
    return stability_curves(overlay, physical_of(side).cast<double>());
}

}  // namespace doppel
