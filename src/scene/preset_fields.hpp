#pragma once

#include "integrate/methods.hpp"
#include "scene/physical_fields.hpp"
#include "scene/side_text_fields.hpp"
#include "scene/toml_reader.hpp"

#include <fmt/format.h>

#include <type_traits>
#include <vector>

namespace doppel {

/// `kind` of [scene]: of a film, and of the figures (figure/kinds.cpp).
inline constexpr std::string_view pair_kind = "pair";
inline constexpr std::array<std::string_view, 5> scene_kinds{pair_kind, "grid", "series", "section", "work-precision"};

// The keys of a film's tables, each with its member, in lists that TomlReader, TomlWriter and FieldTable visit:
// visit(field, member), visit.table(name, list). A table may be const. The reader checks what keys say together.

inline const Field title_field{
    .key = "title", .help = "shown above the pictures", .absent = "the file's name", .is_drawn = true};
inline const Field subtitle_field{.key = "subtitle",
                                  .help = "the line below the title; \"\" = none",
                                  .absent = "what both sides have in common",
                                  .is_drawn = true};
inline const Field kind_field{
    .key = "kind", .help = "\"pair\" is a film, the others are figures", .names = scene_kinds};

/// [scene], without `kind`.
template <class Visit, class Scene>
void clock_fields(Visit& visit, Scene& preset) {
    visit({"duration_s", "a whole number of samples", "s", positive}, preset.duration_s);
    visit({"sample_hz", "samples a second; divides the steps a second", "Hz", positive}, preset.sample_hz);
}

/// What the table of a film has besides; of [scene].
template <class Visit, class Scene>
void column_fields(Visit& visit, Scene& preset) {
    visit({"energy_columns", "kinetic and potential energies as last columns of the CSV"}, preset.energy_columns);
}

/// The links of a chain and their sizes.
template <class Visit, class Side>
void link_fields(Visit& visit, Side& side, const Bounds& masses = positive) {
    auto links = static_cast<int>(side.links());
    visit({"links", "links of the chain", "", from_to(1, 10'000)}, links);
    if constexpr (!std::is_const_v<Side>) side.set_links(static_cast<std::size_t>(links));
    visit({.key = "mass_kg",
           .help = "masses at the ends of the links; may be 0 beside rod_mass_kg",
           .unit = "kg",
           .bounds = masses,
           .each = "one a link",
           .otherwise = not_negative,
           .symbol = "m"},
          side.mass_kg);
    visit({.key = "length_m",
           .help = "lengths of the links",
           .unit = "m",
           .bounds = positive,
           .each = "one a link",
           .symbol = "l"},
          side.length_m);
}

template <class Visit, class Side>
void chain_fields(Visit& visit, Side& side, const Bounds& masses = positive) {
    link_fields(visit, side, masses);
    visit({.key = "angle_deg",
           .help = "at the start, from the downward vertical, counter-clockwise",
           .unit = "deg",
           .bounds = angle_bounds,
           .each = "one a link",
           .caption = "release angle",
           .symbol = "θ"},
          side.angle_deg);
    visit({.key = "omega_deg_per_s",
           .help = "rates at the start",
           .unit = "deg/s",
           .each = "one a link",
           .caption = "rate at the start",
           .symbol = "ω"},
          side.omega_deg_per_s);
}

template <class Visit, class Side>
void gravity_field(Visit& visit, Side& side) {
    visit({.key = "gravity_m_per_s2",
           .help = "may be 0 with particles, constraints or forces",
           .unit = "m/s²",
           .bounds = side.is_mechanism() ? not_negative : positive,
           .otherwise = not_negative},
          side.gravity_m_per_s2);
}

inline const Field model_field{.key = "model", .help = "the equations; auto: the smallest that serves"};
inline const Field accuracy_field{"accuracy",
                                  "largest error of an angle, or of a place as a part of the size of a mechanism; "
                                  "chooses integrator, step_s and tolerance",
                                  "rad",
                                  {.low = 0, .high = 1, .is_open = true}};

/// The method, and the step or the tolerance that it goes by.
template <class Visit, class Side>
void method_fields(Visit& visit, Side& side) {
    visit({.key = "integrator", .help = "the method", .names = names_of_methods()}, side.integrator);
    const bool adaptive = find_method(side.integrator)->adaptive;
    const auto only = [&](bool holds, const char* what) {
        return Only{
            holds,
            fmt::format("is for {}; \"{}\" goes by {}", what, side.integrator, adaptive ? "tolerance" : "step_s"),
            side.integrator_from_command_line, false, "integrator"};
    };
    const auto of_fixed = only(!adaptive, "methods with a fixed step"),
               of_adaptive = only(adaptive, "adaptive methods");
    visit({"step_s", "of methods with a fixed step", "s", positive, "1/30000", of_fixed}, side.step_s);
    visit({"tolerance", "of adaptive methods: relative error of a step", "", positive, "1e-12; in quad 1e-28",
           of_adaptive},
          side.tolerance);
}

template <class Visit, class Side>
void precision_fields(Visit& visit, Side& side) {
    visit({"precision", "53 bits or 113 (34 digits)"}, side.precision);
    visit({"stabilise", "what keeps constraints from drifting"}, side.stabilise);
    const Only of_baumgarte{.holds = side.stabilise == Stabilise::baumgarte};
    visit({"stabilise_rate_per_s", "of Baumgarte's method, α = β", "1/s", positive, "", of_baumgarte},
          side.stabilise_rate_per_s);
}

/// [[system.particle]], without `name`.
template <class Visit, class Particle>
void part_fields(Visit& visit,
                 Particle& particle) requires std::is_same_v<std::remove_const_t<Particle>, ParticleSpec> {
    visit({"mass_kg", "mass", "kg", positive}, particle.mass_kg);
    visit({"position_m", "place at the start, [x, y]", "m"}, particle.position_m);
    visit({"velocity_m_per_s", "velocity at the start, [x, y]", "m/s"}, particle.velocity_m_per_s);
}

/// [[system.constraint]] or [[system.force]] of one kind, without `name` and `kind`.
template <class Visit, class Part>
void part_fields(Visit& visit, Part& part, std::string_view kind) {
    using Kind = std::remove_const_t<Part>;
    constexpr bool is_slot_or_anchor = requires {
        part.particle;
    };
    constexpr bool is_droplet = std::is_same_v<Kind, DropletSpec>, is_circle = std::is_same_v<Kind, SlotCircleSpec>;
    constexpr bool is_spring = std::is_same_v<Kind, SpringSpec>;
    constexpr std::string_view as_released = "that of the start";
    if constexpr (is_slot_or_anchor)
        visit({.key = "particle", .help = "name of the particle", .needed_by = kind}, part.particle);
    if constexpr (requires { part.from; }) {
        visit({.key = "from", .help = "name of a particle, or a fixed place [x, y]", .needed_by = kind}, part.from);
        visit({.key = "to", .help = "the other end", .needed_by = kind}, part.to);
    }
    if constexpr (is_slot_or_anchor || is_droplet)
        visit({.key = "position_m",
               .help = is_circle ? "the centre" : "place; of a line, a point of it",
               .unit = "m",
               .absent = as_released,
               .needed_by = is_circle || is_droplet ? kind : ""},
              part.position_m);
    if constexpr (requires { part.direction; }) visit({"direction", "of the line, [x, y]"}, part.direction);
    if constexpr (requires { part.length_m; })
        visit({"length_m", "length; of a spring at rest", "m", is_spring ? not_negative : positive, as_released},
              part.length_m);
    if constexpr (is_circle) visit({"radius_m", "radius", "m", positive, as_released}, part.radius_m);
    if constexpr (is_spring) {
        visit({"stiffness_N_per_m", "stiffness", "N/m", positive}, part.stiffness_N_per_m);
        visit({"damping_N_s_per_m", "damping", "N s/m", not_negative}, part.damping_N_s_per_m);
    }
    if constexpr (is_droplet) visit({"mass_kg", "mass", "kg", positive}, part.mass_kg);
    if constexpr (requires { part.constant_m3_per_kg_s2; })
        visit({"constant_m3_per_kg_s2", "gravitational constant", "m³/(kg s²)", positive, "Newton's"},
              part.constant_m3_per_kg_s2);
}

/// [system], [a] and [b], without texts and entries; `is_physical` = with what a real chain has besides.
template <class Visit, class Side>
void side_fields(Visit& visit, Side& side, bool is_physical = true) {
    if (side.particles.empty()) {
        chain_fields(visit, side);
        if (is_physical) physical_fields(visit, side.physical);
    }
    gravity_field(visit, side);
    visit(model_field, side.model);
    visit(accuracy_field, side.accuracy);
    if (!side.accuracy) method_fields(visit, side);
    precision_fields(visit, side);
}

/// use(table, kind, name, fields) for each entry of [[system.TABLE]]; fields(visit) visits its keys, without `name` and
/// `kind`.
template <class Side, class Use>
void for_each_entry(Side& side, const Use& use) {
    const auto plain = [&](std::string_view table, auto& entries) {
        for (auto& entry : entries) use(table, table, entry.name, [&](auto& visit) { part_fields(visit, entry); });
    };
    const auto of_kinds = [&](std::string_view table, auto& entries) {
        for (auto& entry : entries)
            use(table, kind_name(entry), entry.name, [&](auto& visit) {
                std::visit([&](auto& part) { part_fields(visit, part, kind_name(entry)); }, entry.part);
            });
    };
    plain("torque", side.physical.torques);
    plain("particle", side.particles);
    of_kinds("constraint", side.constraints);
    of_kinds("force", side.forces);
}

/// Which table of a side has a key: the side itself, where all is empty; its pivot; or an entry.
struct KeyOwner {
    std::string_view table = {}, kind = {};  // "force", "spring"
    std::string name = {};                   // its own; may be empty
    int number = 0;                          // of an entry, from 1, in the order of for_each_entry()
};

/// Passes the keys of a list of fields on: use(owner, field, member).
template <class Use>
class KeyVisitor {
public:
    explicit KeyVisitor(const Use& use) : use_(use) {}

    template <class T>
    void operator()(const Field& field, T& member) const {
        use_(owner, field, member);
    }
    template <class Visit>
    void table(std::string_view key, const Visit& visit) {
        owner.table = key;
        visit(*this);
        owner = {};
    }
    static bool from_command_line(std::string_view) { return false; }

    KeyOwner owner;

private:
    const Use& use_;
};

/// use(owner, field, member) for each key that decides how a side moves, those of its entries included.
template <class Side, class Use>
void for_each_key(Side& side, const Use& use) {
    KeyVisitor visit(use);
    side_fields(visit, side);
    int number = 0;
    for_each_entry(side,
                   [&](std::string_view table, std::string_view kind, const std::string& name, const auto& fields) {
                       visit.owner = {table, kind, name, ++number};
                       fields(visit);
                   });
}

inline constexpr auto picture_sizes = from_to(64, 16384);  // more than any OpenGL takes, which says so itself
inline const Field size_field{"size", "width and height", "px", picture_sizes, "", {}, "width and height"};

inline const Field preview_field{"preview",
                                 "for trying out: half as wide and high (unless the command line gives a size), fast "
                                 "and coarse encoding"};

template <class Visit>
void theme_field(Visit& visit, auto& theme) {
    std::vector<std::string_view> names;
    for (const auto& known : themes) names.push_back(known.name);
    visit({.key = "theme", .help = "colours", .names = names}, theme);
}

/// How the film is written.
template <class Visit, class Video>
void format_fields(Visit& visit, Video& video) {
    static constexpr std::array<std::string_view, 2> codecs{"vp9", "av1"};
    visit({"format", "the file; png: a picture a frame"}, video.format);
    const auto only = [&](bool holds, const char* what) {
        return Only{holds, fmt::format("is {}; the format is \"{}\"", what, name_of(video.format)),
                    visit.from_command_line("format"), false, "format"};
    };
    const FormatRow& row = format_row(video.format, video.codec);
    const bool is_webm = video.format == FilmFormat::webm;
    const auto encoded = only(row.is_encoded(), "of mp4 and webm");
    visit({"codec", "of webm", "", {}, "vp9", only(is_webm, "a choice of webm"), "", codecs}, video.codec);
    visit({"pixel_format", "of mp4 and webm", "", {}, "", encoded}, video.pixel_format);
    visit({"transparent", "no background; of png, apng and webm (VP9)", "", {}, "", {.holds = video.transparent}},
          video.transparent);
    constexpr std::string_view effort = "of mp4 and webm: effort of the encoder; \"doppel\": chosen for such pictures";
    visit({"preset", effort, "", {}, "", encoded, "", encoder_presets}, video.preset);
    visit({.key = "crf",
           .help = "of mp4 and webm: lower is better; of mp4 up to 51",
           .bounds = from_to(0, row.largest_crf),
           .only = encoded,
           .otherwise = from_to(0, 63)},
          video.crf);
}

/// What is shown when.
template <class Visit, class Video>
void time_fields(Visit& visit, Video& video) {
    constexpr auto seconds = from_to(0, 3600, "none");
    constexpr std::string_view all_samples = "sample_hz · speed, of a gif up to 30; where the speed changes sample_hz";
    constexpr auto speeds = Bounds{.low = 0, .is_open = true};
    constexpr std::string_view rates =
        "frames a second; 23.976, 29.97 and 59.94 mean 24000/1001, 30000/1001, 60000/1001";
    visit({"fps", rates, "1/s", positive, all_samples}, video.fps);
    visit({"speed", "seconds of motion a second of film; a list: each speed is reached at its time", "", speeds},
          video.speed);
    const Only of_changes{video.speed.changes_over_time(), "is of a speed that changes, speed = [[0, 1], [6.8, 0.25]]",
                          false, false, "speed"};
    constexpr std::string_view ease =
        "of motion before a change of speed, in which the film's pace goes over by 3u² − 2u³";
    visit({"speed_ease_s", ease, "s", from_to(0, 60, "at once"), "", of_changes}, video.speed_ease_s);
    visit({"hold_start_s", "how long the first frame stands", "s", seconds}, video.hold_start_s);
    visit({"hold_end_s", "how long the last frame stands", "s", seconds}, video.hold_end_s);
    visit({"title_card_s", "a card with the title before the film", "s", seconds}, video.title_card_s);
    visit({"end_card_s", "a card with the outcome after the film", "s", seconds}, video.end_card_s);
    visit({"poster_s", "NAME.poster.png: the frame nearest to this time", "s", not_negative}, video.poster_s);
    constexpr std::string_view across = "frames across and down";
    visit({"contact_sheet",
           "NAME.contact.png: pendulums and time at so many moments, across and down",
           "",
           from_to(1, 32),
           "",
           {},
           across},
          video.contact_sheet);
}

inline const Field panels_field{.key = "panels", .help = "\"pendulums\" and strips, in their order"};

template <class Visit, class Video>
void layout_fields(Visit& visit, Video& video) {
    visit({"layout", "how the pendulums are placed"}, video.layout);
    const auto only = [&](Arrangement layout) {
        return Only{video.layout == layout,
                    fmt::format("is of the layout \"{}\"; it is \"{}\"", name_of(layout), name_of(video.layout)), false,
                    false, "layout"};
    };
    const auto of_ensemble = only(Arrangement::ensemble), of_phase = only(Arrangement::phase);
    constexpr auto some = from_to(2, 1000), link = from_to(1, 10'000);
    constexpr std::string_view members =
        "of an ensemble: pendulums from side a to side b, or the angles of each, [[120, 120], [120.01, 120]]";
    visit({"members", members, "", some, "", of_ensemble}, video.members);
    visit({"phase", "of the layout \"phase\": rates over angles, or a Poincaré section", "", {}, "", of_phase},
          video.phase);
    visit({"phase_link", "of the layout \"phase\": the link that it shows", "", link, "", of_phase}, video.phase_link);
    if constexpr (std::is_const_v<Video>)
        visit(panels_field, static_cast<const Panels&>(video));
    else
        visit(panels_field, static_cast<Panels&>(video));
    visit({.key = "show",
           .help = "what is said around the pendulums; credit: by whom, on the end card",
           .names = shown_parts},
          video.show);
    constexpr std::string_view help = "axis of the strip, [lowest, highest]", fitted = "fitted to the motion";
    for (std::size_t i = 0; i < strip_kinds; ++i) {
        const auto bounds = is_logarithmic(static_cast<StripKind>(i)) ? positive : Bounds{};
        visit({range_keys[i], help, "", bounds, fitted, {}, "lowest and highest"}, video.ranges[i]);
    }
}

/// Colours, widths, fonts, sizes of words, and trails.
template <class Visit, class Video>
void style_fields(Visit& visit, Video& video) {
    theme_field(visit, video.theme);
    constexpr std::string_view of_theme = "the theme's";
    visit({"side_colors", "of side a and side b", "", {}, of_theme}, video.side_colors);
    visit.table("colors", [&](auto& table) {
        for (std::size_t i = 0; i < color_names.size(); ++i)
            table({color_names[i].key, color_names[i].help, "", {}, of_theme}, video.colors[i]);
    });
    visit.table("widths_px", [&](auto& table) {
        for (const auto& [key, member, help] : width_names)
            table({key, help, "px", from_to(0, 200)}, video.widths.*member);
    });
    visit.table("fonts", [&](auto& table) {
        table({"text", "font file (TrueType, OpenType), beside the preset or from here", "", {}, "built in"},
              video.text_font);
    });
    visit.table("fonts_px", [&](auto& table) {
        for (const auto& [key, member, help] : font_size_names)
            table({key, help, "px", from_to(4, 400)}, video.fonts.*member);
    });
    constexpr auto glow = from_to(0, 100, "none"), trail = from_to(0, 3600, "none");
    visit({"glow_px", "how far the light of trails and bobs reaches", "px", glow, of_theme}, video.glow_px);
    visit({"trail_s", "how long the path behind the last bob lasts; 0.3 of an ensemble, 1 of one with a list", "s",
           trail},
          video.trail_s);
}

}  // namespace doppel
