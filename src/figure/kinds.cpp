#include "figure/kinds.hpp"

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
    auto system = table("system");
    read_release(system, side);
    return side;
}

void check_distinct(const TomlReader& table, std::string_view key, const std::vector<std::string>& names) {
    for (const auto& name : names)
        if (std::count(names.begin(), names.end(), name) > 1)
            throw table.fault(key, "must differ; \"{}\" is named more than once", name);
}

std::span<const FigureKind> figure_kinds() {
    static constexpr std::array<FigureKind, scene_kinds.size() - 1> kinds{{{"sweep", read_sweep},
                                                                           {"curves", read_curves},
                                                                           {"convergence", read_convergence},
                                                                           {"spectrum", read_spectrum},
                                                                           {"section", read_section},
                                                                           {"flip-map", read_flip_map},
                                                                           {"links", read_links},
                                                                           {"work-precision", read_work_precision},
                                                                           {"stability", read_stability},
                                                                           {"drift", read_drift},
                                                                           {"audit", read_audit}}};
    return kinds;
}

}  // namespace doppel
