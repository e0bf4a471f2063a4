#include "scene/field_table.hpp"

#include "scene/preset_fields.hpp"

#include <fmt/ranges.h>

#include <algorithm>

namespace doppel {
namespace {

template <class Spec>
void add_part_tables(const std::string& name, std::vector<FieldTable>& tables) {
    const auto add = [&]<class Part>(std::string_view kind, const Part& part) {
        auto& table = tables.emplace_back(FieldTable{fmt::format("[[system.{}]] kind = \"{}\"", name, kind)});
        table.fields.push_back({"name", "text", "", "by which `[a]` and `[b]` change it", "none"});
        part_fields(table, part, kind);
    };
    [&]<class... Parts>(const std::variant<Parts...>&) {
        auto kind = Spec::kinds.begin();
        (add(*kind++, Parts()), ...);
    }(Spec().part);
}

}  // namespace

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
    std::string text(type);
    if (!choices.empty()) text = fmt::format("`\"{}\"`", fmt::join(choices, "\"`, `\""));
    if (!choices.empty() && is_list()) text = "list of " + text;
    if (most > 0) text = fmt::format("1 to {} {}", most, text);
    if (const auto range = range_text(); !range.empty()) text += ", " + range;
    if (is_drawn && choices.empty()) text += fmt::format(", at most {} letters", most_letters);
    return text;
}

std::string ListedField::example() const {
    if (const auto value = default_value(); !value.empty()) return value;
    const auto is = [&](std::string_view words) { return type == words; };
    const auto first = by_default.substr(0, by_default.find_first_of("; "));  // of "1e-12; in quad 1e-28"
    const bool is_number = !first.empty() && first.find_first_not_of("0123456789.e-/") == std::string::npos;
    if (is_number) return first.find('/') == std::string::npos ? first : fmt::format("\"{}\"", first);
    if (!choices.empty()) return fmt::format("{}\"{}\"{}", is_list() ? "[" : "", choices.front(), is_list() ? "]" : "");
    if (is_list()) return "[\"\"]";
    if (is(type_words<Color>())) return "\"#ff9f40\"";
    if (is(type_words<std::array<Color, 2>>())) return "[\"#ff9f40\", \"#4fc3f7\"]";
    if (is(type_words<Range>())) return bounds.is_open ? "[1e-6, 10]" : "[0, 10]";
    if (is(type_words<QuadPair>())) return "[0, 0]";
    if (is(type_words<TomlValues>())) return "[0, 90]";
    if (is(type_words<Size>())) return "[4, 3]";
    if (is(type_words<Rational>())) return bounds.is_open ? "60" : "1";
    if (unit == "cm") return "8.6";  // a column of a journal
    if (is(type_words<int>())) return fmt::format("{}", bounds.has_low() ? bounds.low : 1);
    if (is(type_words<double>())) return bounds.is_open ? "1e-6" : "1";
    if (is(type_words<std::vector<Quad>>())) return "1";
    return "\"\"";
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
    FieldTable table{"[a], [b]", "What a picture says of a side.\n"};
    side_text_fields(table, SideSpec());
    return table;
}

std::vector<FieldTable> film_tables() {
    const Preset preset;
    const SideSpec& side = preset.a;
    const ParticleSpec released;
    FieldTable top{"title, subtitle"}, scene{"[scene]"}, system{"[system], [a], [b]"}, video{"[video]"};
    FieldTable torque{std::string(torque_table),
                      "A motor at a joint of a chain: amplitude · cos(2π · frequency · t + phase).\n"};
    FieldTable particle{
        "[[system.particle]]",
        "In place of a chain, a system may have particles; constraints and forces may stand on top of a chain, too, "
        "whose\nbobs are called `bob1`, `bob2` …\n"};
    system.is_widest = video.is_widest = true;
    top(title_field, preset.title);
    top(subtitle_field, preset.subtitle);
    scene(kind_field, std::string(pair_kind));
    clock_fields(scene, preset);
    column_fields(scene, preset);
    side_fields(system, side);
    particle.fields.push_back(
        {"name", "text", "", "by which constraints and forces call it", std::string(must_be_given)});
    particle.fields.back().is_drawn = true;
    part_fields(particle, released);
    torque.fields.push_back({"name", "text", "", "by which `[a]` and `[b]` change it", "none"});
    part_fields(torque, static_cast<const TorqueSpec&>(TorqueSpec()));
    video(size_field, preset.video.size);
    video(preview_field, false);
    format_fields(video, preset.video);
    time_fields(video, preset.video);
    layout_fields(video, preset.video);
    style_fields(video, preset.video);
    std::vector<FieldTable> tables{top, scene, system, particle};
    add_part_tables<ConstraintSpec>("constraint", tables);
    add_part_tables<ForceSpec>("force", tables);
    tables.push_back(torque);
    tables.push_back(side_text_table());
    tables.push_back(video);
    return tables;
}

}  // namespace doppel
