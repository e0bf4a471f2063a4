#include "scene/field_table.hpp"

#include "scene/preset_fields.hpp"

#include <fmt/ranges.h>

namespace doppel {
void FieldTable::key(const Field& field, const KeyMember& by_default) {
    ListedField listed{field, value_type(by_default), {}, {field.names.begin(), field.names.end()}};
    if (is_widest) listed.bounds = field.otherwise.value_or(field.bounds);
    if (listed.choices.empty()) listed.choices.assign(field.known.begin(), field.known.end());
    if (const auto* choice = std::get_if<ChosenName>(&by_default))
        listed.choices.assign(choice->names.begin(), choice->names.end());
    const auto value = toml_value(by_default);
    listed.by_default = !field.needed_by.empty() ? must_be_given
                        : !field.absent.empty()  ? field.absent
                        : value.empty()          ? "none"
                                                 : fmt::format("`{}`", value);
    fields.push_back(std::move(listed));
}

void FieldTable::table(std::string_view key, const std::function<void(KeyVisitor&)>& list) {
    // "[system], [a], [b]": the first one
    list(tables.emplace_back(fmt::format("[{}.{}]", name.substr(1, name.find(']') - 1), key)));
}

std::string ListedField::range_text() const {
    if (bounds.is_open) return bounds.has_high() ? fmt::format("> 0, to {}", bounds.high) : "> 0";
    if (!bounds.has_low()) return "";
    if (!bounds.has_high()) return fmt::format("≥ {}", bounds.low);
    return fmt::format("{}{} to {}", bounds.low, bounds.zero.empty() ? "" : fmt::format(" ({})", bounds.zero),
                       bounds.high);
}

std::string ListedField::default_value() const {
    const bool is_value =
        by_default.size() > 2 && by_default.front() == '`' && by_default.find('`', 1) + 1 == by_default.size();
    return is_value ? by_default.substr(1, by_default.size() - 2) : "";
}

std::string ListedField::takes() const {
    std::string text(type.words);
    if (!choices.empty()) text = fmt::format("`\"{}\"`", fmt::join(choices, "\"`, `\""));
    if (!choices.empty() && type.is_list) text = "list of " + text;
    if (maximum > 0) text = fmt::format("1 to {} {}", maximum, text);
    if (const auto range = range_text(); !range.empty()) text += ", " + range;
    if (is_drawn && choices.empty()) text += fmt::format(", at most {} letters", max_letters);
    return text;
}

std::string ListedField::example() const {
    if (const auto value = default_value(); !value.empty()) return value;
    const auto first = by_default.substr(0, by_default.find_first_of("; "));  // from "1e-12; in quad 1e-28"
    const bool is_number = !first.empty() && first.find_first_not_of("0123456789.e-/") == std::string::npos;
    if (is_number) return first.find('/') == std::string::npos ? first : fmt::format("\"{}\"", first);
    if (!choices.empty())
        return fmt::format("{}\"{}\"{}", type.is_list ? "[" : "", choices.front(), type.is_list ? "]" : "");
    if (unit == "cm") return "8.6";  // width of a journal's column
    const auto example = bounds.is_open ? type.positive_example : type.example;
    return example.empty() ? fmt::format("{}", bounds.low) : std::string(example);
}

void FieldTable::append(const FieldTable& other) {
    fields.insert(fields.end(), other.fields.begin(), other.fields.end());
    tables.insert(tables.end(), other.tables.begin(), other.tables.end());
}

std::string_view FieldTable::key() const {
    const std::string_view inside = std::string_view(name).substr(0, name.find(']'));
    return inside.substr(inside.find_last_of("[.") + 1);
}

std::string plain_words(std::string text) {
    std::erase(text, '`');
    return text;
}

std::string FieldTable::markdown() const {
    auto page = fmt::format("\n## `{}`\n\n{}{}| key | takes | unit | default | |\n|---|---|---|---|---|\n", name, text,
                            text.empty() ? "" : "\n");
    for (const auto& field : fields)
        page += fmt::format("| `{}` | {} | {} | {} | {} |\n", field.key, field.takes(), field.unit, field.by_default,
                            field.help);
    for (const auto& table : tables) page += table.markdown();
    return page;
}

FieldTable side_text_table() {
    FieldTable table("[a], [b]", "What a picture says of a side.\n");
    SideSpec side;
    side_text_fields(table, side);
    return table;
}

std::vector<FieldTable> film_tables() {
    Preset preset;
    const std::optional<std::string> no_name;
    const Field name{.key = "name", .help = "by which `[a]` and `[b]` change it"};
    FieldTable top("title, subtitle"), scene("[scene]"), system("[system], [a], [b]"), video("[video]");
    FieldTable torque(std::string(torque_table),
                      "A motor at a joint of a chain: amplitude · cos(2π · frequency · t + phase).\n");
    FieldTable particle(
        "[[system.particle]]",
        "In place of a chain, a system may have particles; constraints and forces may stand on top of a chain, too, "
        "whose\nbobs are called `bob1`, `bob2` …\n");
    system.is_widest = video.is_widest = true;
    top(title_field, preset.title);
    top(subtitle_field, preset.subtitle);
    scene(kind_field, std::string(pair_kind));
    film_fields(scene, preset);
    side_fields(system, preset.a);
    particle({.key = "name",
              .help = "the name that constraints and forces refer to",
              .needed_by = "particle",
              .is_drawn = true},
             std::string());
    ParticleSpec released;
    part_fields(particle, released);
    std::vector<FieldTable> tables{top, scene, system, particle};
    for (std::size_t i = 0; i < names_of<PartKind>.size(); ++i) {
        PartSpec part{.kind = static_cast<PartKind>(i)};
        auto& table = tables.emplace_back(fmt::format(
            "[[system.{}]] kind = \"{}\"", i < constraint_kinds ? "constraint" : "force", name_of(part.kind)));
        table(name, no_name);
        part_fields(table, part);
    }
    torque(name, no_name);
    TorqueSpec motor;
    part_fields(torque, motor);
    tables.push_back(torque);
    tables.push_back(side_text_table());
    video(size_field, preset.video.size);
    video(preview_field, false);
    video_fields(video, preset.video);
    tables.push_back(video);
    return tables;
}

}  // namespace doppel
