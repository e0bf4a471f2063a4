#include "figure/kind_tables.hpp"

#include "figure/kinds.hpp"
#include "figure/preset.hpp"
#include "scene/preset_fields.hpp"

#include <algorithm>

namespace doppel::test {

MotionOf motion_of(std::string_view kind) {
    return kind == "work-precision" ? MotionOf::none : kind == "section" ? MotionOf::release : MotionOf::pair;
}

std::vector<FieldTable> own_tables(std::string_view kind) {
    FieldTable all;
    std::ranges::find(figure_kinds(), kind, &FigureKind::name)->list(all);
    for (auto& table : all.tables)
        if (table.name == "[curve]") table.name = "[[curve]]";
    return all.tables;
}

std::vector<FieldTable> tables_of(std::string_view kind) {
    const bool is_film = kind == pair_kind, has_pair = is_film || motion_of(kind) == MotionOf::pair;
    std::vector<FieldTable> all;
    Preset preset;
    FigurePreset none;
    auto& top = all.emplace_back("[]");
    if (is_film) {
        top(title_field, preset.title);
        top(subtitle_field, preset.subtitle);
    } else {
        top_fields(top, none);
    }
    auto& scene = all.emplace_back("[scene]");
    scene(kind_field, std::string(pair_kind));
    if (is_film)
        film_fields(scene, preset);
    else if (has_pair)
        clock_fields(scene, preset);
    for (const auto* name : {"[system]", "[a]", "[b]"}) {
        if (!has_pair) break;
        auto& side = all.emplace_back(name);
        side.is_widest = true;
        side_fields(side, preset.a);
        if (is_film && side.key() != "system") side_text_fields(side, preset.a);
    }
    if (is_film) {
        auto& video = all.emplace_back("[video]");
        video.is_widest = true;
        video(size_field, preset.video.size);
        video(preview_field, false);
        video_fields(video, preset.video);
        return all;
    }
    if (motion_of(kind) == MotionOf::release) {
        auto& chain = all.emplace_back("[system]");
        chain_fields(chain, preset.a);
        gravity_field(chain, preset.a);
        std::erase_if(chain.fields, [](const auto& field) {  // a section's orbits start at all states of an energy
            return field.key == "angle_deg" || field.key == "omega_deg_per_s";
        });
    }
    chart_fields(all.emplace_back("[chart]"), none.chart);
    for (auto& table : own_tables(kind))
        if (table.key() == "chart")
            all.back().fields.insert(all.back().fields.end(), table.fields.begin(), table.fields.end());
        else
            all.insert(all.end() - 1, std::move(table));
    return all;
}

}  // namespace doppel::test
