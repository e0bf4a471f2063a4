#include "figure/kinds.hpp"

#include "scene/resolved.hpp"

#include <algorithm>
#include <array>

namespace doppel {

Preset FigureReader::pair(const std::vector<TomlReader*>& more) {
    Preset preset;
    preset.name = preset.title = name;
    read_clock(scene, preset);
    std::vector<TomlReader*> levels{&top};
    levels.insert(levels.end(), more.begin(), more.end());
    read_sides(document, levels, preset);
    check_clock(preset, scene);
    return preset;
}

SideSpec FigureReader::release() {
    SideSpec side;
    auto system = document.table(top, "system");
    read_release(system, side);
    return side;
}

const MethodEntry& method_named(const TomlReader& table, const std::string& name) {
    if (const auto* method = find_method(name)) return *method;
    throw table.fault("methods", "must be names of methods (doppel list methods); \"{}\" is not", name);
}

const ReleaseParameter& release_parameter(std::string_view name) {
    static constexpr std::array<ReleaseParameter, 4> all{
        {{"theta1_deg", "release angle θ₁, °", 1, [](SideSpec& s, const Quad& x) { s.angle_deg[0] = x; }, 30, false},
         {"theta2_deg", "release angle θ₂, °", 2, [](SideSpec& s, const Quad& x) { s.angle_deg[1] = x; }, 30, false},
         {"mass_ratio", "mass ratio m₁/m₂", 2, [](SideSpec& s, const Quad& x) { s.mass_kg[0] = x * s.mass_kg[1]; }, 0,
          true},
         {"length_ratio", "length ratio l₁/l₂", 2,
          [](SideSpec& s, const Quad& x) { s.length_m[0] = x * s.length_m[1]; }, 0, true}}};
    return *std::find_if(all.begin(), all.end(), [&](const auto& parameter) { return parameter.name == name; });
}

void check_distinct(const TomlReader& table, std::string_view key, const std::vector<std::string>& names) {
    for (const auto& name : names)
        if (std::count(names.begin(), names.end(), name) > 1)
            throw table.fault(key, "must differ; \"{}\" is named more than once", name);
}

std::span<const FigureKind> figure_kinds() {
    static const std::array<FigureKind, scene_kinds.size() - 1> kinds{
        sweep_kind, curves_kind,         convergence_kind, spectrum_kind, section_kind, flip_map_kind,
        links_kind, work_precision_kind, stability_kind,   drift_kind,    audit_kind};
    return kinds;
}

}  // namespace doppel
