#include "figure/map_figure.hpp"

#include "base/error.hpp"
#include "base/machine.hpp"
#include "base/text.hpp"
#include "scene/captions.hpp"

namespace doppel {

void demand_room(const FigurePreset& figure, const PartHeader& header, const std::filesystem::path& folder) {
    const auto* map = figure.experiment->map();
    if (!map) return;
    const auto& frame = map->frame();
    const double share = static_cast<double>(header.last() - header.first()) / static_cast<double>(header.trials);
    const auto numbers = static_cast<double>(frame.numbers);
    const double cells = share * frame.x.count * frame.y.count * static_cast<double>(frame.panels);
    const auto refuse = [&](const char* what, double needed, double there) {
        return bad_input("{}: {} × {} cells take {} of {}, and there are {}; take fewer{}", figure.name,
                         grouped(frame.x.count), grouped(frame.y.count), bytes_text(needed), what, bytes_text(there),
                         frame.panels > 1 ? "" : ", or --tiles");
    };
    // the numbers of all trials, and where a picture is drawn twice a float
    const double memory = cells * (8 * numbers + 8), owned = static_cast<double>(this_machine().memory);
    if (memory > 0.8 * owned) throw refuse("memory", memory, owned);
    std::error_code unknown;
    const auto space = std::filesystem::space(folder, unknown);
    const double table = cells * (30 + 18 * numbers), free = static_cast<double>(space.available);
    if (!unknown && table > free) throw refuse("disk", table, free);
}

}  // namespace doppel
