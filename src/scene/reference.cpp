#include "scene/preset_fields.hpp"
#include "scene/resolved.hpp"

namespace doppel {
namespace {

constexpr std::string_view introduction = R"(# Presets of films: all tables and keys

A preset is a TOML file that describes two pendulums and the film of them. Every key has a default; units are part of
the key. `doppel show NAME` prints a preset, `doppel check FILE` tells what it would run, and `--set TABLE.KEY=VALUE`
sets a key from the command line. A key that is not in these tables is an error.

```toml
title = "Three thousandths of a degree"

[scene]
duration_s = 30

[system]                  # both sides
angle_deg = [90, 90]

[b]                       # the second side, where it differs
angle_deg = [90.003, 90]
```

Side a has the keys of `[system]` with those of `[a]` in their place, side b those of `[b]`. Arrays with one number a
link may also be one number for all links. `[[a.particle]]`, `[[a.constraint]]` and `[[a.force]]` with the `name` of one
in `[system]` change it; others are added.

Presets of figures have `[scene]`, `[system]`, `[a]` and `[b]` as well, and tables of their own: see [figures](figures.md).
)";

constexpr std::string_view particles_text =
    "In place of a chain, a system may have particles; constraints and forces may stand on top of a chain, too, whose\n"
    "bobs are called `bob1`, `bob2` …\n";

/// The range of a number: "> 0", "0 (none) to 100".
std::string range_text(const Bounds& bounds) {
    if (bounds.is_open) return bounds.has_high() ? fmt::format("> 0, to {}", bounds.high) : "> 0";
    if (!bounds.has_low()) return "";
    if (!bounds.has_high()) return fmt::format("≥ {}", bounds.low);
    return fmt::format("{}{} to {}", bounds.low, bounds.zero.empty() ? "" : fmt::format(" ({})", bounds.zero),
                       bounds.high);
}

/// What a key of a type takes.
template <class T>
constexpr std::string_view type_words = "text";
template <>
constexpr std::string_view type_words<bool> = "`true` or `false`";
template <>
constexpr std::string_view type_words<int> = "whole number";
template <>
constexpr std::string_view type_words<double> = "number";
template <>
constexpr std::string_view type_words<Quad> = "number";
template <>
constexpr std::string_view type_words<Rational> = "number or \"a/b\"";
template <>
constexpr std::string_view type_words<std::vector<Quad>> = "numbers";
template <>
constexpr std::string_view type_words<QuadPair> = "[x, y]";
template <>
constexpr std::string_view type_words<EndSpec> = "text or [x, y]";
template <>
constexpr std::string_view type_words<Size> = "two whole numbers";
template <>
constexpr std::string_view type_words<std::array<int, 2>> = "two whole numbers";
template <>
constexpr std::string_view type_words<Range> = "two numbers";
template <>
constexpr std::string_view type_words<Color> = "\"#rrggbb\"";
template <>
constexpr std::string_view type_words<std::array<Color, 2>> = "two of \"#rrggbb\"";
template <class T>
constexpr std::string_view type_words<std::optional<T>> = type_words<T>;

std::string choices_text(std::span<const std::string_view> names) {
    return fmt::format("`\"{}\"`", fmt::join(names, "\"`, `\""));
}

template <class T>
std::string taken_by(const Field& field) {
    if (!field.names.empty()) return choices_text(field.names);
    if constexpr (std::is_enum_v<T>)
        return choices_text(names_of<T>);
    else if constexpr (std::is_same_v<T, Panels>)
        return "list of `\"pendulums\"`, " + choices_text(names_of<StripKind>);
    else
        return std::string(type_words<T>);
}

/// A table of Markdown with a row a key: reference(field, default).
class ReferenceTable {
public:
    explicit ReferenceTable(std::string name, std::string text = "") : name_(std::move(name)) {
        text_ = fmt::format("\n## `{}`\n\n{}{}| key | takes | unit | default | |\n|---|---|---|---|---|\n", name_, text,
                            text.empty() ? "" : "\n");
    }

    template <class T>
    void operator()(const Field& field, const T& value) {
        auto takes = taken_by<T>(field);
        if (const auto range = range_text(field.bounds); !range.empty()) takes += ", " + range;
        add(field, takes, default_text(field, value));
    }
    void add(const Field& field, const std::string& takes, const std::string& by_default) {
        text_ += fmt::format("| `{}` | {} | {} | {} | {} |\n", field.key, takes, field.unit, by_default, field.help);
    }
    template <class Visit>
    void table(std::string_view key, const Visit& visit) {
        ReferenceTable inside(fmt::format("[{}.{}]", name_.substr(1, name_.size() - 2), key));
        visit(inside);
        tables_ += inside.text();
    }
    static bool from_command_line(std::string_view) { return false; }

    std::string text() const { return text_ + tables_; }

private:
    template <class T>
    static std::string default_text(const Field& field, const T& value) {
        if (!field.needed_by.empty()) return "must be given";
        if constexpr (is_optional<T>)
            return field.absent.empty() ? "none" : std::string(field.absent);
        else if (!field.absent.empty())
            return std::string(field.absent);
        else
            return fmt::format("`{}`", toml_value(value));
    }

    std::string name_, text_, tables_;
};

template <class Spec>
std::string part_tables(const std::string& name) {
    std::string text;
    const auto add = [&]<class Part>(std::string_view kind, const Part& part) {
        ReferenceTable table(fmt::format("[[system.{}]] kind = \"{}\"", name, kind));
        table.add({.key = "name", .help = "by which `[a]` and `[b]` change it"}, "text", "none");
        part_fields(table, part, kind);
        text += table.text();
    };
    [&]<class... Parts>(const std::variant<Parts...>&) {
        auto kind = Spec::kinds.begin();
        (add(*kind++, Parts()), ...);
    }(Spec().part);
    return text;
}

}  // namespace

std::string preset_reference() {
    const Preset preset;
    const SideSpec& side = preset.a;
    const ParticleSpec released;
    ReferenceTable top("title"), scene("[scene]"), system("[system], [a], [b]"),
        particle("[[system.particle]]", std::string(particles_text)), video("[video]");
    top(title_field, preset.title);
    scene(kind_field, std::string(pair_kind));
    clock_fields(scene, preset);
    chain_fields(system, side);
    gravity_field(system, side);
    system(model_field, side.model);
    system(accuracy_field, side.accuracy);
    method_fields(system, side);
    precision_fields(system, side);
    particle.add({.key = "name", .help = "by which constraints and forces call it"}, "text", "must be given");
    part_fields(particle, released);
    video(size_field, preset.video.size);
    format_fields(video, preset.video);
    time_fields(video, preset.video);
    layout_fields(video, preset.video);
    style_fields(video, preset.video);
    return std::string(introduction) + top.text() + scene.text() + system.text() + particle.text() +
           part_tables<ConstraintSpec>("constraint") + part_tables<ForceSpec>("force") + video.text();
}

}  // namespace doppel
