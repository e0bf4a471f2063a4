#include "figure/claim_runs.hpp"

#include "scene/scene.hpp"

namespace doppel::study {

SideSpec side(std::vector<Quad> angle_deg, ModelChoice model) {
    SideSpec spec;
    spec.mass_kg.assign(angle_deg.size(), 1);
    spec.length_m.assign(angle_deg.size(), 1);
    spec.omega_deg_per_s.assign(angle_deg.size(), 0);
    spec.angle_deg = std::move(angle_deg);
    spec.model = model;
    return spec;
}

SideSpec exactly(SideSpec spec) {
    spec.integrator = "taylor";
    spec.precision = Precision::in_quad;
    spec.tolerance = parse_quad("1e-26");
    return spec;
}

std::vector<double> distances(const SideSpec& a, const SideSpec& b, long count, const std::atomic<bool>& stop) {
    const auto scene = make_scene({.name = "audit", .duration_s = *reduced(count, 120), .a = a, .b = b});
    PairRun run(scene);
    std::vector<double> all;
    for (long n = 0; n <= count; ++n) all.push_back(run.next(stop).distance);
    return all;
}

std::vector<double> averages(const std::vector<SideTwins>& sides, const TwinSide& method,
                             const std::atomic<bool>& stop) {
    std::vector<Twins> twins;
    for (const auto& [a, b] : sides) twins.push_back({chain_of(a).cast<double>(), chain_of(b).cast<double>()});
    std::vector<double> found(twins.size());
    average_log_ratios(twins, {.a = method, .b = method}, found, stop);
    return found;
}

SideTwins angle_twins(int theta1_deg, int theta2_deg) {
    return {side({theta1_deg, theta2_deg}), side({theta1_deg + parse_quad("0.003"), theta2_deg})};
}

SideTwins mass_twins(int theta1_deg, int theta2_deg, double ratio) {
    auto twins = std::pair{side({theta1_deg, theta2_deg}), side({theta1_deg, theta2_deg})};
    twins.first.mass_kg[0] = ratio;
    twins.second.mass_kg[0] = ratio + 0.01;
    return twins;
}

SideSpec with_droplet(SideSpec spec, bool droplet) {
    spec.model = ModelChoice::mechanism;
    if (droplet)
        spec.forces.push_back({.name = {},
                               .part = DropletSpec{.position_m = QuadPair{1609, 0},
                                                   .mass_kg = parse_quad("0.000034"),
                                                   .constant_m3_per_kg_s2 = parse_quad("6.674e-11")}});
    return spec;
}

}  // namespace doppel::study
