#include "figure/kinds.hpp"

#include <algorithm>
#include <array>
#include <string>

namespace doppel {

Preset FigureReader::pair(const std::vector<TomlReader*>& more) {
    Preset preset;
    preset.name = preset.title = name;
    clock_fields(scene, preset);
    std::vector<TomlReader*> levels{&top};
    levels.insert(levels.end(), more.begin(), more.end());
    read_sides(levels, preset);
    if (!only_keys) check_clock(preset, scene);
    return preset;
}

SideSpec FigureReader::release(bool physical) {
    SideSpec side;
    auto system = top.inner("system");
    read_release(system, side, physical);
    return side;
}

void check_distinct(const TomlReader& table, std::string_view key, const std::vector<std::string>& names) {
    for (const auto& name : names)
        if (std::count(names.begin(), names.end(), name) > 1)
            throw table.error(key, "must differ; {} is there twice", name);
}

std::vector<std::string> methods_of(Model model, std::vector<std::string> names) {
    constexpr std::array of_model{&MethodEntry::angles, &MethodEntry::constraints, &MethodEntry::mechanism};
    std::erase_if(names,
                  [&](const auto& name) { return !(find_method(name)->*of_model[static_cast<std::size_t>(model)]); });
    return names;
}

bool have_same_release(const SideSpec& a, const SideSpec& b) {
    const auto same = [](const ParticleSpec& one, const ParticleSpec& other) {
        return one.mass_kg == other.mass_kg && one.position_m == other.position_m &&
               one.velocity_m_per_s == other.velocity_m_per_s;
    };
    return a.mass_kg == b.mass_kg && a.length_m == b.length_m && a.angle_deg == b.angle_deg &&
           a.omega_deg_per_s == b.omega_deg_per_s &&
           std::equal(a.particles.begin(), a.particles.end(), b.particles.begin(), b.particles.end(), same);
}

std::span<const FigureKind> figure_kinds() {
    static const std::array<FigureKind, scene_kinds.size() - 1> kinds{grid_kind, series_kind, section_kind,
                                                                      work_precision_kind};
    return kinds;
}

}  // namespace doppel
