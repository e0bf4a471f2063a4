#include "film/table.hpp"

#include "analysis/difference.hpp"
#include "base/error.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

namespace doppel {
namespace {

/// Angles and rates only where the masses hang in a chain.
std::vector<std::string> columns(const Scene& scene) {
    std::vector<std::string> names{"sample", "time_s"};
    for (const auto* side : {&scene.a, &scene.b}) {
        const char letter = side == &scene.a ? 'a' : 'b';
        const auto add = [&](const std::string& name) { names.push_back(fmt::format("{}_{}", letter, name)); };
        const auto bobs = side->mass.size();
        for (std::size_t i = 1; side->has_angles && i <= bobs; ++i) add(fmt::format("theta{}_rad", i));
        for (std::size_t i = 1; side->has_angles && i <= bobs; ++i) add(fmt::format("omega{}_rad_per_s", i));
        for (std::size_t i = 1; i <= bobs; ++i) {
            for (const char* place : {"x", "y"}) add(fmt::format("{}{}_m", place, i));
            for (const char* velocity : {"vx", "vy"}) add(fmt::format("{}{}_m_per_s", velocity, i));
        }
        for (const char* name : {"energy_J", "energy_error", "length_error_m"}) add(name);
    }
    names.insert(names.end(), {"distance", "log_ratio"});
    return names;
}

}  // namespace

PairTable::PairTable(const FilePlace& place, const Scene& scene) : scene_(scene), csv_(place, columns(scene)) {}

void PairTable::add(const Moment& moment, double start_distance) {
    csv_.add(moment.sample);
    csv_.add(scene_.time(moment.sample));
    add_side(scene_.a, moment.a, moment.energy_error_a);
    add_side(scene_.b, moment.b, moment.energy_error_b);
    csv_.add(moment.distance);
    if (const auto ratio = log_ratio(moment.distance, start_distance))
        csv_.add(*ratio);
    else
        csv_.add_empty();
    csv_.end_row();
}

void PairTable::add_side(const Side& side, const Observation& seen, std::optional<double> energy_error) {
    if (side.has_angles) {
        for (const auto& bob : seen.bobs) csv_.add(bob.theta);
        for (const auto& bob : seen.bobs) csv_.add(bob.omega);
    }
    for (const auto& bob : seen.bobs)
        for (const double value : {bob.x, bob.y, bob.vx, bob.vy}) csv_.add(value);
    csv_.add(seen.energy);
    if (energy_error)
        csv_.add(*energy_error);
    else
        csv_.add_empty();
    csv_.add(seen.length_error);
}

}  // namespace doppel
