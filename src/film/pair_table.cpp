#include "film/pair_table.hpp"

#include "analysis/difference.hpp"
#include "base/error.hpp"
#include "base/text.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

/// Calls cell(of, name, number, value) for each cell of some bobs; `{}` in the name stands for the number of a bob, from
/// 1. Only chains have angles and rates.
template <class Scalar, class Cell>
void visit_bobs(const std::string& of, const Side& side, const Bobs<Scalar>& bobs, const Cell& cell) {
    for (std::size_t i = 0; side.has_angles && i < bobs.size(); ++i) cell(of, "theta{}_rad", i + 1, bobs[i].theta);
    for (std::size_t i = 0; side.has_angles && i < bobs.size(); ++i)
        cell(of, "omega{}_rad_per_s", i + 1, bobs[i].omega);
    for (std::size_t i = 0; i < bobs.size(); ++i) {
        cell(of, "x{}_m", i + 1, bobs[i].x);
        cell(of, "y{}_m", i + 1, bobs[i].y);
        cell(of, "vx{}_m_per_s", i + 1, bobs[i].vx);
        cell(of, "vy{}_m_per_s", i + 1, bobs[i].vy);
    }
}

/// Calls cell(of, name, number, value) for each cell of a row, in order.
template <class Cell>
void visit_row(const Scene& scene, const Snapshot& snapshot, double start_distance, const Cell& cell) {
    const auto& state = snapshot.pair;
    const auto of_sides = [&](const auto& visit) {
        for (const char letter : scene.letters())
            visit(std::string{letter, '_'}, scene.side(letter), letter == 'a' ? state.a : state.b);
    };
    cell("", "sample", 0, state.sample);
    cell("", "time_s", 0, scene.time(state.sample));
    of_sides([&](const std::string& of, const Side& side, const SideState& seen) {
        seen.exact.empty() ? visit_bobs(of, side, seen.bobs, cell) : visit_bobs(of, side, seen.exact, cell);
        cell(of, "energy_J", 0, seen.energy);
        cell(of, "energy_error", 0, seen.energy_error);
        cell(of, "length_error_m", 0, seen.length_error);
    });
    if (!scene.is_single()) {
        cell("", "distance", 0, state.distance);
        cell("", "log_ratio", 0, log_ratio(state.distance, start_distance));
    }
    of_sides([&](const std::string& of, const Side&, const Observation& seen) {
        if (!scene.preset.energy_columns) return;
        cell(of, "kinetic_J", 0, seen.kinetic_energy);
        cell(of, "potential_J", 0, seen.energy - seen.kinetic_energy);
    });
    of_sides([&](const std::string& of, const Side& side, const Observation& seen) {
        if (side.has_work) cell(of, "work_J", 0, seen.work);
        if (!(side.pivot_reach > 0)) return;
        cell(of, "pivot_x_m", 0, seen.pivot.x);
        cell(of, "pivot_y_m", 0, seen.pivot.y);
    });
    for (std::size_t k = 0; scene.preset.member_columns && k < snapshot.members.size(); ++k)
        visit_bobs(fmt::format("member{}_", k + 1), scene.a, snapshot.members[k], cell);
}

}  // namespace

std::vector<std::string> columns_of(const Scene& scene) {
    std::vector<std::string> names;
    visit_row(scene, blank_snapshot(scene), 0,
              [&](const std::string& of, const char* name, std::size_t number, const auto&) {
                  names.push_back(of + fmt::format(fmt::runtime(name), number));
              });
    return names;
}

std::vector<double> numbers_of(const Scene& scene, const Snapshot& snapshot, double start_distance) {
    std::vector<double> numbers;
    visit_row(scene, snapshot, start_distance, [&](const std::string&, const char*, std::size_t, const auto& value) {
        if constexpr (requires { value.value_or(NAN); })
            numbers.push_back(value.value_or(NAN));
        else
            numbers.push_back(static_cast<double>(value));
    });
    return numbers;
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

void add_row(Csv& table, const Scene& scene, const Snapshot& snapshot, double start_distance) {
    visit_row(scene, snapshot, start_distance, [&](const std::string&, const char*, std::size_t, const auto& value) {
        if constexpr (std::is_same_v<decltype(value), const Quad&>) {
            const auto nearest = static_cast<double>(value);
            if (std::isfinite(nearest))
                table.add(text_of(value));
            else
                table.add(nearest);
        } else {
            table.add(value);
        }
    });
    table.end_row();
}

}  // namespace doppel
