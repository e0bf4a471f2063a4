#include "film/pair_table.hpp"

#include "analysis/difference.hpp"
#include "base/error.hpp"
#include "base/text.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace doppel {

namespace {

/// Columns of the masses of a side, or of a member of an ensemble. Only chains have angles and rates.
void add_columns(const std::string& prefix, const Side& side, std::vector<std::string>& names) {
    const auto add = [&](const std::string& name) { names.push_back(prefix + name); };
    const auto bobs = side.mass.size();
    for (std::size_t i = 1; side.has_angles && i <= bobs; ++i) add(fmt::format("theta{}_rad", i));
    for (std::size_t i = 1; side.has_angles && i <= bobs; ++i) add(fmt::format("omega{}_rad_per_s", i));
    for (std::size_t i = 1; i <= bobs; ++i) {
        for (const char* place : {"x", "y"}) add(fmt::format("{}{}_m", place, i));
        for (const char* velocity : {"vx", "vy"}) add(fmt::format("{}{}_m_per_s", velocity, i));
    }
}

}  // namespace

std::vector<std::string> columns_of(const Scene& scene) {
    std::vector<std::string> names{"sample", "time_s"};
    for (const char letter : scene.letters()) {
        add_columns(fmt::format("{}_", letter), scene.side(letter), names);
        for (const char* name : {"energy_J", "energy_error", "length_error_m"})
            names.push_back(fmt::format("{}_{}", letter, name));
    }
    if (!scene.is_single()) names.insert(names.end(), {"distance", "log_ratio"});
    for (const char letter : scene.letters()) {
        if (!scene.preset.energy_columns) break;
        for (const char* name : {"kinetic", "potential"}) names.push_back(fmt::format("{}_{}_J", letter, name));
    }
    for (const char letter : scene.letters()) {
        const auto& side = scene.side(letter);
        if (side.has_work) names.push_back(fmt::format("{}_work_J", letter));
        if (side.pivot_reach > 0)
            for (const char axis : {'x', 'y'}) names.push_back(fmt::format("{}_pivot_{}_m", letter, axis));
    }
    for (std::size_t k = 0; scene.preset.member_columns && k < scene.members.size(); ++k)
        add_columns(fmt::format("member{}_", k + 1), scene.a, names);
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

void PairTable::add(const Snapshot& snapshot, double start_distance) {
    const auto& state = snapshot.pair;
    const auto seen = [&](char letter) -> const Observation& { return letter == 'a' ? state.a : state.b; };
    csv_.add(state.sample);
    csv_.add(scene_.time(state.sample));
    for (const char letter : scene_.letters())
        add_side(scene_.side(letter), seen(letter), letter == 'a' ? state.energy_error_a : state.energy_error_b);
    if (!scene_.is_single()) {
        csv_.add(state.distance);
        csv_.add(log_ratio(state.distance, start_distance));
    }
    for (const char letter : scene_.letters()) {
        if (!scene_.preset.energy_columns) break;
        csv_.add(seen(letter).kinetic_energy);
        csv_.add(seen(letter).energy - seen(letter).kinetic_energy);
    }
    for (const char letter : scene_.letters()) {
        const auto& side = scene_.side(letter);
        if (side.has_work) csv_.add(seen(letter).work);
        if (side.pivot_reach > 0) csv_.add(seen(letter).pivot.x), csv_.add(seen(letter).pivot.y);
    }
    for (const auto& member : snapshot.members)
        if (scene_.preset.member_columns) add_bobs(scene_.a, member);
    csv_.end_row();
}

template <class Scalar>
void PairTable::add_bobs(const Side& side, const Bobs<Scalar>& bobs) {
    for (std::size_t i = 0; side.has_angles && i < bobs.size(); ++i) add(bobs[i].theta);
    for (std::size_t i = 0; side.has_angles && i < bobs.size(); ++i) add(bobs[i].omega);
    for (const auto& bob : bobs)
        for (const auto& value : {bob.x, bob.y, bob.vx, bob.vy}) add(value);
}

void PairTable::add_side(const Side& side, const Observation& seen, std::optional<double> energy_error) {
    seen.exact.empty() ? add_bobs(side, seen.bobs) : add_bobs(side, seen.exact);
    csv_.add(seen.energy);
    csv_.add(energy_error);
    csv_.add(seen.length_error);
}

void PairTable::add(const Quad& value) {
    if (const auto near = static_cast<double>(value); !std::isfinite(near)) return csv_.add(near);
    csv_.add(text_of(value));
}

}  // namespace doppel
