#include "film/pair_table.hpp"

#include "analysis/difference.hpp"
#include "base/error.hpp"
#include "base/text.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace doppel {

/// Angles and rates only where the masses hang in a chain.
std::vector<std::string> columns_of(const Scene& scene) {
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
    if (scene.preset.energy_columns)
        names.insert(names.end(), {"a_kinetic_J", "a_potential_J", "b_kinetic_J", "b_potential_J"});
    for (const auto* side : {&scene.a, &scene.b}) {
        const char letter = side == &scene.a ? 'a' : 'b';
        if (side->has_work) names.push_back(fmt::format("{}_work_J", letter));
        if (side->pivot_reach > 0)
            for (const char axis : {'x', 'y'}) names.push_back(fmt::format("{}_pivot_{}_m", letter, axis));
    }
    return names;
}

std::vector<std::string> columns_of(const Scene& scene, const std::vector<std::string>& chosen) {
    auto all = columns_of(scene);
    if (chosen.empty()) return all;
    const auto is_of = [](const std::string& column, const std::string& name) {
        return column == name || ((name == "a" || name == "b") && column.starts_with(name + "_"));
    };
    for (const auto& name : chosen) {
        if (std::ranges::any_of(all, [&](const auto& column) { return is_of(column, name); })) continue;
        const auto meant = nearest(name, std::vector<std::string_view>(all.begin(), all.end()));
        throw bad_input("--columns: the table of {} has no \"{}\"; {}it has {}, and a and b for all of a side",
                        scene.preset.name, name, meant ? fmt::format("did you mean \"{}\"? ", *meant) : "",
                        fmt::join(all, ", "));
    }
    std::erase_if(all, [&](const std::string& column) {
        return std::ranges::none_of(chosen, [&](const auto& name) { return is_of(column, name); });
    });
    return all;
}

void PairTable::add(const PairState& state, double start_distance) {
    csv_.add(state.sample);
    csv_.add(scene_.time(state.sample));
    add_side(scene_.a, state.a, state.energy_error_a);
    add_side(scene_.b, state.b, state.energy_error_b);
    csv_.add(state.distance);
    csv_.add(log_ratio(state.distance, start_distance));
    for (const auto* seen : {&state.a, &state.b}) {
        if (!scene_.preset.energy_columns) break;
        const double kinetic = seen->kinetic_energy;
        csv_.add(kinetic);
        csv_.add(seen->energy - kinetic);
    }
    for (const auto& [side, seen] : {std::pair{&scene_.a, &state.a}, {&scene_.b, &state.b}}) {
        if (side->has_work) csv_.add(seen->work);
        if (side->pivot_reach > 0) csv_.add(seen->pivot.x), csv_.add(seen->pivot.y);
    }
    csv_.end_row();
}

void PairTable::add_side(const Side& side, const Observation& seen, std::optional<double> energy_error) {
    const auto add_all = [&](const auto& bobs) {
        for (std::size_t i = 0; side.has_angles && i < bobs.size(); ++i) add(bobs[i].theta);
        for (std::size_t i = 0; side.has_angles && i < bobs.size(); ++i) add(bobs[i].omega);
        for (const auto& bob : bobs)
            for (const auto& value : {bob.x, bob.y, bob.vx, bob.vy}) add(value);
    };
    seen.exact.empty() ? add_all(seen.bobs) : add_all(seen.exact);
    csv_.add(seen.energy);
    csv_.add(energy_error);
    csv_.add(seen.length_error);
}

void PairTable::add(const Quad& value) {
    if (const auto near = static_cast<double>(value); !std::isfinite(near)) return csv_.add(near);
    csv_.add(text_of(value));
}

}  // namespace doppel
