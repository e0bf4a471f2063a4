#include "scene/table.hpp"

#include "analysis/distance.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

namespace doppel {
namespace {

std::vector<std::string> columns() {
    std::vector<std::string> names{"sample", "time_s"};
    for (const char side : {'a', 'b'}) {
        const auto add = [&](const std::string& name) { names.push_back(fmt::format("{}_{}", side, name)); };
        for (std::size_t i = 1; i <= link_count; ++i) add(fmt::format("theta{}_rad", i));
        for (std::size_t i = 1; i <= link_count; ++i) add(fmt::format("omega{}_rad_per_s", i));
        for (std::size_t i = 1; i <= link_count; ++i) {
            for (const char* place : {"x", "y"}) add(fmt::format("{}{}_m", place, i));
            for (const char* velocity : {"vx", "vy"}) add(fmt::format("{}{}_m_per_s", velocity, i));
        }
        for (const char* name : {"energy_J", "energy_error", "length_error_m"}) add(name);
    }
    names.insert(names.end(), {"distance", "log_ratio"});
    return names;
}

}  // namespace

PairTable::PairTable(const std::filesystem::path& path) : csv_(path, columns()) {}

void PairTable::add(const Scene& scene, const Moment& moment, double start_distance) {
    csv_.add(moment.sample);
    csv_.add(scene.time(moment.sample));
    add_side(moment.a, moment.energy_error_a);
    add_side(moment.b, moment.energy_error_b);
    csv_.add(moment.distance);
    if (const auto ratio = log_ratio(moment.distance, start_distance))
        csv_.add(*ratio);
    else
        csv_.add_empty();
    csv_.end_row();
}

void PairTable::add_side(const Observation& seen, double energy_error) {
    for (const auto& bob : seen.bobs) csv_.add(bob.theta);
    for (const auto& bob : seen.bobs) csv_.add(bob.omega);
    for (const auto& bob : seen.bobs)
        for (const double value : {bob.x, bob.y, bob.vx, bob.vy}) csv_.add(value);
    for (const double value : {seen.energy, energy_error, seen.length_error}) csv_.add(value);
}

}  // namespace doppel
