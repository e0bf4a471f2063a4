#include "scene/resolved.hpp"

#include "base/embedded.hpp"
#include "integrate/methods.hpp"
#include "output/files.hpp"
#include "output/written.hpp"
#include "scene/preset_fields.hpp"
#include "scene/toml_reader.hpp"

#include <toml++/toml.h>

namespace doppel {

std::string toml_text(const std::string& text) {
    std::string quoted = "\"";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\')
            quoted += {'\\', c};
        else if (byte < 0x20 || byte == 0x7f)  // TOML requires these to be escaped; JSON writers leave U+007F
            quoted += fmt::format("\\u{:04X}", static_cast<unsigned>(byte));
        else
            quoted += c;
    }
    return quoted + '"';
}

std::string toml_value(const Panels& panels) {
    std::vector<std::string> names;
    if (panels.pendulums) names.emplace_back("pendulums");
    for (const auto strip : panels.strips) names.emplace_back(name_of(strip));
    return toml_value(names);
}

std::string toml_value(const Speed& speed) {
    if (!speed.changes_over_time()) return toml_ratio(speed.constant);
    std::vector<std::string> changes;
    for (const auto& [at_s, to] : speed.changes)
        changes.push_back(fmt::format("[{}, {}]", toml_ratio(at_s), toml_ratio(to)));
    return fmt::format("[{}]", fmt::join(changes, ", "));
}

std::string toml_value(const Members& members) {
    if (members.releases.empty()) return toml_value(members.count);
    std::vector<std::string> all;
    for (const auto& release : members.releases) {
        if (release.mass_kg.empty() && release.length_m.empty() && !release.color && !release.angle_deg.empty()) {
            all.push_back(toml_value(release.angle_deg));
            continue;
        }
        std::vector<std::string> keys;
        for (const auto& list : Release::lists)
            if (!(release.*list.member).empty())
                keys.push_back(fmt::format("{} = {}", list.key, toml_value(release.*list.member)));
        if (release.color) keys.push_back("color = " + toml_value(*release.color));
        all.push_back(fmt::format("{{{}}}", fmt::join(keys, ", ")));
    }
    return fmt::format("[{}]", fmt::join(all, ", "));
}

std::string toml_value(const KeyMember& member) {
    return std::visit(
        []<class M>(const M& of) -> std::string {
            if constexpr (std::is_same_v<M, ChosenName>)
                return toml_text(std::string(of.name));
            else if constexpr (is_optional<std::remove_pointer_t<M>>)
                return *of ? toml_value(**of) : "";
            else
                return toml_value(*of);
        },
        member);
}

void TomlWriter::key(const Field& field, const KeyMember& member) {
    const auto value = field.only.applies ? toml_value(member) : "";
    const auto* text = std::get_if<std::string*>(&member);
    if (!value.empty() && !(text && (*text)->empty())) add(field.key, value);
}

void TomlWriter::table(std::string_view key, const std::function<void(KeyVisitor&)>& fields) {
    TomlWriter inside;
    fields(inside);
    if (!inside.text_.empty()) tables_ += fmt::format("\n[{}.{}]\n{}", name_, key, inside.text_);
}

namespace {

std::string table_text(const std::string& name, const std::function<void(TomlWriter&)>& fields) {
    TomlWriter writer(name.substr(1, name.size() - 2));
    fields(writer);
    return fmt::format("\n{}\n{}", name, writer.text());
}

std::string entries_toml(const std::string& name, SideSpec& side) {
    std::string text;
    for (const auto& entry : entries_of(side))
        text += table_text(fmt::format("[[{}.{}]]", name, entry.table), [&](TomlWriter& writer) {
            if (entry.kind != entry.table) writer.add("kind", toml_text(std::string(entry.kind)));
            writer({.key = "name"}, entry.name);
            entry.fields(writer);
        });
    return text;
}

std::string side_toml(const std::string& name, SideSpec side) {
    side.tolerance = side.allowed_error();  // written where the method takes it
    side.step_s = side.step();
    return table_text(fmt::format("[{}]", name),
                      [&](TomlWriter& writer) {
                          side_text_fields(writer, side);
                          side_fields(writer, side, !side.physical.is_none());
                      }) +
           entries_toml(name, side);
}

/// A number with more than the 17 digits of a double becomes text.
Json json_of(const toml::node& node, const TomlText& text) {
    if (const auto* table = node.as_table()) {
        Json object = Json::object();
        for (auto&& [key, value] : *table) object[std::string(key.str())] = json_of(value, text);
        return object;
    }
    if (const auto* array = node.as_array()) {
        Json list = Json::array();
        for (const auto& element : *array) list.push_back(json_of(element, text));
        return list;
    }
    if (const auto* number = node.as_floating_point()) {
        const auto& at = node.source().begin;
        const Quad exact = parse_quad(text.literal_at(at.line, at.column));
        constexpr std::size_t of_double = 17;
        auto decimals = text_of(exact);
        if (significant_digits(decimals).size() > of_double) return decimals;
        return number->get();
    }
    if (const auto* whole = node.as_integer()) return whole->get();
    if (const auto* flag = node.as_boolean()) return flag->get();
    return node.value_or<std::string>("");
}

}  // namespace

std::string resolved_pair(const Preset& preset) {
    TomlWriter writer;
    auto clock = preset;
    film_fields(writer, clock);
    return writer.text() + resolved_sides(preset);
}

std::string resolved_sides(const Preset& preset, const std::string& above) {
    const auto a = side_toml(above + "a", preset.a);
    return preset.video.layout == Arrangement::single ? a : a + side_toml(above + "b", preset.b);
}

std::string resolved_release(SideSpec side) {
    return table_text("[system]",
                      [&](TomlWriter& writer) {
                          chain_fields(writer, side);
                          gravity_field(writer, side);
                          if (!side.physical.is_none()) physical_fields(writer, side.physical);
                      }) +
           entries_toml("system", side);
}

std::string resolved_chain(SideSpec side) {
    return table_text("[system]", [&](TomlWriter& writer) {
        link_fields(writer, side);
        gravity_field(writer, side);
    });
}

std::string resolved_toml(const Preset& preset) {
    TomlWriter top;
    top.add("title", toml_text(preset.title));
    top(subtitle_field, preset.subtitle);
    return fmt::format("{}\n[scene]\nkind = \"{}\"\n", top.text(), pair_kind) + resolved_pair(preset) +
           table_text("[video]", [video = preset.video](TomlWriter& writer) mutable {
               writer(size_field, video.size);
               video_fields(writer, video);
           });
}

Json json_of_toml(const std::string& toml) {
    return json_of(toml::parse(toml), TomlText(toml));
}

Json program_json() {
    return {{"version", version()}, {"revision", revision()}};
}

Metadata metadata_of(const std::string& title, const std::string& name, std::string record) {
    const auto program = fmt::format("Doppel {} ({})", version(), revision());
    if (record.empty()) record = fmt::format("how it was made is in {}.json, unless it was made by -o -", name);
    // MP4 stores the muxer's name as its encoder, so the comment contains all of it
    return {
        {"title", title}, {"comment", fmt::format("{}, preset {}; {}", program, name, record)}, {"encoder", program}};
}

void write_manifest(Transaction& parts, const std::string& name, Json manifest) {
    const auto place = parts.file(name);
    auto& files = manifest["files"] = Json::object();
    const auto file_json = [](const WrittenFile& file) { return Json{{"bytes", file.bytes}, {"sha256", file.sha256}}; };
    for (const auto& [file, about] : parts.finished_files()) files[file] = file_json(about);
    for (const auto& [file, about] : parts.earlier_files())
        if (file != name) manifest["earlier_files"][file] = file_json(about);
    write_file(place, manifest.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    parts.finished(name);
}

}  // namespace doppel
