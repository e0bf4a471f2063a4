#pragma once

#include "figure/part_file.hpp"
#include "scene/manifest_json.hpp"

namespace doppel {

/// What a figure's run has to tell besides the figure.
struct FigureRecord {
    int jobs = 1;
    double compute_wall_s = 0, compute_cpu_s = 0;  // other figures may have been computed meanwhile
    double draw_cpu_s = 0;                         // picture and table
    std::string gl;
};

/// NAME.json. Throws Error (exit 4).
void write_figure_manifest(Transaction& parts, const FigurePreset& figure, const KnownTrials& trials,
                           const FigureRecord& record);

}  // namespace doppel
