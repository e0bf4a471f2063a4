#include "scene/preset_fields.hpp"

#include "integrate/methods.hpp"

namespace doppel {
namespace {

constexpr auto picture_sizes = from_to(64, 16384);  // more than any OpenGL supports, which reports its own limit
constexpr double max_hz = 1e6;                      // of a drive: far above the response of a pendulum

const auto known_themes = [] {
    std::vector<std::string_view> names;
    for (const auto& known : themes) names.push_back(known.name);
    return names;
}();
const auto panel_names = [] {
    std::vector<std::string_view> names{"pendulums"};
    names.insert(names.end(), names_of<StripKind>.begin(), names_of<StripKind>.end());
    return names;
}();

/// A key with one number per link.
Field of_links(std::string_view key, std::string_view help, std::string_view unit, const Bounds& bounds,
               std::string_view symbol = "", std::string_view caption = "") {
    return {.key = key,
            .help = help,
            .unit = unit,
            .bounds = bounds,
            .each = "one a link",
            .caption = caption,
            .symbol = symbol};
}

void format_fields(KeyVisitor& visit, VideoSpec& video) {
    visit({"format", "file format; png: one picture a frame; html: a page to use in a browser; y4m, rgb: uncompressed"},
          video.format);
    const auto only = [&](bool applies, const char* what) {
        return Condition{applies, fmt::format("is {}; the format is \"{}\"", what, name_of(video.format)),
                         visit.from_command_line("format"), "format"};
    };
    const FormatRow& row = format_row(video.format, video.codec);
    const bool is_webm = video.format == FilmFormat::webm;
    const auto encoded = only(row.is_encoded(), "of mp4 and webm");
    visit({"codec", "of webm", "", {}, "vp9", only(is_webm, "a choice of webm"), "", webm_codecs}, video.codec);
    visit({"pixel_format", "of mp4, webm and y4m", "", {}, "", only(row.is_yuv(), "of mp4, webm and y4m")},
          video.pixel_format);
    visit({.key = "transparent",
           .help = "no background; of png, apng, html, rgb and webm (VP9)",
           .only = {.applies = video.transparent}},
          video.transparent);
    visit({"position_bits", "of html: bits of a position, where the page holds the motion", "", from_to(16, 24), "",
           only(video.format == FilmFormat::html, "of html")},
          video.position_bits);
    constexpr std::string_view effort = "of mp4 and webm: preset of the encoder; \"doppel\": tuned for these pictures";
    visit({"preset", effort, "", {}, "", encoded, "", encoder_presets}, video.preset);
    visit({.key = "crf",
           .help = "of mp4 and webm: lower is better; at most 51 for mp4",
           .bounds = from_to(0, row.largest_crf),
           .only = encoded,
           .otherwise = from_to(0, 63)},
          video.crf);
}

void time_fields(KeyVisitor& visit, VideoSpec& video) {
    constexpr auto seconds = from_to(0, 3600, "none");
    constexpr std::string_view all_samples = "sample_hz · speed, of a gif up to 30; where the speed changes sample_hz";
    constexpr std::string_view rates =
        "frames a second; 23.976, 29.97 and 59.94 mean 24000/1001, 30000/1001, 60000/1001";
    visit({"fps", rates, "1/s", positive, all_samples}, video.fps);
    visit({"speed", "seconds of motion a second of film; in a list, each speed is reached at its time", "", positive},
          video.speed);
    const Condition of_changes{video.speed.changes_over_time(),
                               "is for a speed that changes, such as speed = [[0, 1], [6.8, 0.25]]", false, "speed"};
    constexpr std::string_view ease = "time of motion before a change of speed, in which 1/speed changes by 3u² − 2u³";
    visit({"speed_ease_s", ease, "s", from_to(0, 60, "at once"), "", of_changes}, video.speed_ease_s);
    visit({"hold_start_s", "hold time of the first frame", "s", seconds}, video.hold_start_s);
    visit({"hold_end_s", "hold time of the last frame", "s", seconds}, video.hold_end_s);
    visit({"title_card_s", "a card with the title before the film", "s", seconds}, video.title_card_s);
    visit({"end_card_s", "a card with the result after the film", "s", seconds}, video.end_card_s);
    visit({"poster_s", "NAME.poster.png: the frame nearest to this time", "s", not_negative}, video.poster_s);
    constexpr std::string_view moments = "NAME.contact.png: frames at equal intervals, across and down";
    visit({"contact_sheet", moments, "", from_to(1, 32), "", {}, "frames across and down"}, video.contact_sheet);
}

void layout_fields(KeyVisitor& visit, VideoSpec& video) {
    visit({"layout", "how the pendulums are placed"}, video.layout);
    const auto only = [&](Arrangement layout) {
        return Condition{video.layout == layout,
                         fmt::format("is for the layout \"{}\"; it is \"{}\"", name_of(layout), name_of(video.layout)),
                         false, "layout"};
    };
    const auto of_ensemble = only(Arrangement::ensemble), of_phase = only(Arrangement::phase);
    constexpr auto some = from_to(2, 1000), link = from_to(1, 10'000);
    constexpr std::string_view members =
        "of an ensemble: pendulums from side a to side b, or a list of angles, [[120, 120], [120.01, 120]], or of "
        "tables with angle_deg, mass_kg, length_m, color; numbers that a table lacks go from side a to side b";
    visit({"members", members, "", some, "", of_ensemble}, video.members);
    visit({"phase", "of the layout \"phase\": rates over angles, or a Poincaré section", "", {}, "", of_phase},
          video.phase);
    visit({"phase_link", "of the layout \"phase\": the link that it shows", "", link, "", of_phase}, video.phase_link);
    if (video.layout == Arrangement::single && video.strips == Panels().strips) video.strips = {StripKind::energies_a};
    visit({.key = "panels", .help = "\"pendulums\" and strips, in their order", .names = panel_names},
          static_cast<Panels&>(video));
    visit({.key = "show",
           .help =
               "what is shown besides trails; credit: Doppel's name on the end card; twin: the other side as a shadow",
           .names = shown_parts},
          video.show);
    visit.table("view", [&](KeyVisitor& table) {
        table({"follow", "the mass that stays in the middle, from 1; 0 = none", "", from_to(0, 10'000)},
              video.view.follow);
        const Condition still{video.view.follow == 0, "is for a view that follows no mass", false, "follow"};
        table({.key = "center_m",
               .help = "the place in the middle of a panel, [x, y]",
               .unit = "m",
               .absent = "the pivot, or that of the motion",
               .only = still},
              video.view.center_m);
        table({"height_m", "what the height of a panel shows", "m", positive, "all of the motion"},
              video.view.height_m);
    });
    visit({"model_limit_s", "how long a fitted model predicts what was measured: a line in the first strip", "s",
           positive},
          video.model_limit_s);
    constexpr std::string_view help = "axis of the strip, [lowest, highest]", fitted = "fitted to the motion";
    for (std::size_t i = 0; i < strip_kinds; ++i) {
        const auto kind = static_cast<StripKind>(i);
        const auto shown = [&](StripKind strip) { return std::ranges::count(video.strips, strip) > 0; };
        // "energy" may become total_energy
        const Condition of_shown{shown(kind) || (kind == StripKind::total_energy && shown(StripKind::energy)),
                                 fmt::format("is for \"{}\", which panels does not contain", name_of(kind)),
                                 visit.from_command_line("panels"), "panels"};
        const auto bounds = is_logarithmic(kind) ? positive : Bounds{};
        visit({range_keys[i], help, "", bounds, fitted, of_shown}, video.ranges[i]);
    }
}

void style_fields(KeyVisitor& visit, VideoSpec& video) {
    visit(theme_field, video.theme);
    constexpr std::string_view of_theme = "the theme's";
    visit({"side_colors", "of side a and side b", "", {}, of_theme}, video.side_colors);
    visit.table("colors", [&](KeyVisitor& table) {
        for (std::size_t i = 0; i < color_names.size(); ++i)
            table({color_names[i].key, color_names[i].help, "", {}, of_theme}, video.colors[i]);
    });
    visit.table("widths_px", [&](KeyVisitor& table) {
        constexpr std::string_view fitted = "by the size of the panel";
        for (const auto& [key, member, help] : width_names)
            table({key, help, "px", from_to(0, 200, "nothing")}, video.widths.*member);
        table({"rod", "rods", "px", from_to(0, 200, "nothing"), fitted}, video.widths.rod);
        table({"bob", "radius of the heaviest bob", "px", from_to(0, 200, "nothing"), fitted}, video.widths.bob);
    });
    visit.table("fonts", [&](KeyVisitor& table) {
        table({"text",
               "font file (TrueType, OpenType); path from the preset or from the current folder",
               "",
               {},
               "built in"},
              video.text_font);
    });
    visit.table("fonts_px", [&](KeyVisitor& table) {
        for (const auto& [key, member, help] : font_size_names)
            table({key, help, "px", from_to(4, 400)}, video.fonts.*member);
    });
    constexpr auto glow = from_to(0, 100, "none"), trail = from_to(0, 3600, "none");
    visit({"glow_px", "glow radius of trails and bobs", "px", glow, of_theme}, video.glow_px);
    visit({"trail_s", "duration of the trail of the last bob; ensembles: 0.3, or 1 with a list of members", "s", trail},
          video.trail_s);
}

}  // namespace

const Field title_field{
    .key = "title", .help = "shown above the pictures", .absent = "the file's name", .is_drawn = true};
const Field subtitle_field{.key = "subtitle",
                           .help = "the line below the title; \"\" = none",
                           .absent = "what both sides have in common",
                           .is_drawn = true};
const Field kind_field{.key = "kind", .help = "\"pair\" is a film, the others are figures", .names = scene_kinds};
const Field model_field{.key = "model", .help = "the equations; auto: the smallest model that can simulate the scene"};
const Field accuracy_field{"accuracy",
                           "largest error of an angle, or of a place as a part of the size of a mechanism; "
                           "chooses integrator, step_s and tolerance",
                           "rad",
                           {.low = 0, .high = 1, .is_open = true}};
const Field size_field{"size", "width and height", "px", picture_sizes, "", {}, "width and height"};
const Field preview_field{
    "preview", "a draft: half the width and height (unless the command line gives a size), fast and coarse encoding"};
const Field theme_field{.key = "theme", .help = "colours", .names = known_themes};

void clock_fields(KeyVisitor& visit, Preset& preset) {
    visit({"duration_s", "a whole number of samples", "s", positive}, preset.duration_s);
    visit({"sample_hz", "samples a second; divides the steps a second", "Hz", positive}, preset.sample_hz);
}

void film_fields(KeyVisitor& visit, Preset& preset) {
    clock_fields(visit, preset);
    const Condition of_columns{.applies = preset.energy_columns || preset.member_columns};
    visit({.key = "energy_columns",
           .help = "kinetic and potential energies as last columns of the CSV",
           .only = of_columns},
          preset.energy_columns);
    visit({.key = "member_columns",
           .help = "of an ensemble: angles, rates, places and velocities of each member as last columns",
           .only = of_columns},
          preset.member_columns);
    visit({.key = "certify",
           .help = "proves, for two ideal links, how long the run follows the true motion: in the manifest, the strip "
                   "and `check`",
           .only = {.applies = preset.certify}},
          preset.certify);
}

void link_fields(KeyVisitor& visit, SideSpec& side, const Bounds& masses) {
    auto links = static_cast<int>(side.links());
    visit({"links", "links of the chain", "", from_to(1, 10'000)}, links);
    side.set_links(static_cast<std::size_t>(links));
    auto mass =
        of_links("mass_kg", "masses at the ends of the links; 0 is possible with rod_mass_kg", "kg", masses, "m");
    mass.otherwise = not_negative;
    visit(mass, side.mass_kg);
    visit(of_links("length_m", "lengths of the links", "m", positive, "l"), side.length_m);
}

void chain_fields(KeyVisitor& visit, SideSpec& side, const Bounds& masses) {
    link_fields(visit, side, masses);
    visit(of_links("angle_deg", "at the start, from the downward vertical, counter-clockwise", "deg", angle_bounds, "θ",
                   "release angle"),
          side.angle_deg);
    visit(of_links("omega_deg_per_s", "rates at the start", "deg/s", {}, "ω", "rate at the start"),
          side.omega_deg_per_s);
}

void physical_fields(KeyVisitor& visit, PhysicalSpec& physical) {
    for (const auto& property : PhysicalSpec::properties) {
        auto field = of_links(property.key, property.help, property.unit, not_negative, "", property.caption);
        field.absent = property.absent;
        field.only.applies = physical.has(property);
        visit(field, physical.*property.member);
    }
    visit.table("pivot", [&pivot = physical.pivot](KeyVisitor& table) {
        table({"direction_deg", "direction of the prescribed motion, from the x axis: 90 = up", "deg", angle_bounds},
              pivot.direction_deg);
        table({"amplitude_m", "amplitude of the prescribed motion; 0 = a fixed pivot", "m", not_negative},
              pivot.amplitude_m);
        table({"frequency_hz", "frequency", "Hz", {.low = 0, .high = max_hz, .is_open = true}}, pivot.frequency_hz);
        table({"phase_deg", "of the cosine at t = 0", "deg", angle_bounds}, pivot.phase_deg);
    });
}

void gravity_field(KeyVisitor& visit, SideSpec& side) {
    visit({.key = "gravity_m_per_s2",
           .help = "may be 0 with particles, constraints or forces",
           .unit = "m/s²",
           .bounds = side.is_mechanism() ? not_negative : positive,
           .otherwise = not_negative,
           .symbol = "g"},
          side.gravity_m_per_s2);
}

void method_fields(KeyVisitor& visit, SideSpec& side) {
    visit({.key = "integrator", .help = "the method", .names = names_of_methods()}, side.integrator);
    const bool adaptive = find_method(side.integrator)->adaptive;
    const auto only = [&](bool applies, const char* what) {
        return Condition{
            applies, fmt::format("is for {}; \"{}\" uses {}", what, side.integrator, adaptive ? "tolerance" : "step_s"),
            side.integrator_from_command_line, "integrator"};
    };
    visit({"step_s", "of methods with a fixed step", "s", positive, "1/30000",
           only(!adaptive, "methods with a fixed step")},
          side.step_s);
    visit({"tolerance", "of adaptive methods: relative error of a step", "", positive, "1e-12; in quad 1e-28",
           only(adaptive, "adaptive methods")},
          side.tolerance);
}

void precision_fields(KeyVisitor& visit, SideSpec& side) {
    visit({.key = "precision", .help = "53 bits or 113 (34 digits)", .caption = "in"}, side.precision);
    visit({.key = "stabilise", .help = "correction of constraint drift", .caption = "stabilisation"}, side.stabilise);
    visit({"stabilise_rate_per_s",
           "of Baumgarte's method, α = β",
           "1/s",
           positive,
           "",
           {side.stabilise == Stabilise::baumgarte,
            fmt::format("is for stabilise = \"baumgarte\"; it is \"{}\"", name_of(side.stabilise)),
            visit.from_command_line("stabilise"), "stabilise"}},
          side.stabilise_rate_per_s);
}

void side_fields(KeyVisitor& visit, SideSpec& side, bool is_physical) {
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

void side_text_fields(KeyVisitor& visit, SideSpec& side) {
    visit({.key = "label",
           .help = "name of the side in the picture; \"\" = none",
           .absent = "what differs from the other side",
           .is_drawn = true},
          side.label);
    visit({.key = "note", .help = "the line below the label; \"\" = none", .absent = "its start", .is_drawn = true},
          side.note);
    visit.table("track", [&track = side.track](KeyVisitor& table) {
        table({.key = "file",
               .help = "CSV of a measured double pendulum, shown instead of a simulation; path from the preset, from "
                       "the current folder, or a built-in name",
               .absent = "none"},
              track.file);
        const Condition of_file{!track.is_none(), "is of a measured motion; give the file of one", false, "file"};
        table({"start_s", "time in the file at which the motion begins", "s", {}, "the first sample", of_file},
              track.start_s);
        table({"offset_deg", "reading of the encoders at rest, which is subtracted", "deg", angle_bounds, "", of_file,
               "one a link"},
              track.offset_deg);
    });
}

void part_fields(KeyVisitor& visit, TorqueSpec& torque) {
    visit({"joint", "1 is the pivot, 2 the end of link 1; the link above takes the opposite torque", "",
           from_to(1, 10'000)},
          torque.joint);
    visit({"amplitude_N_m", "torque", "N m"}, torque.amplitude_N_m);
    visit({"frequency_hz", "frequency", "Hz", from_to(0, max_hz)}, torque.frequency_hz);
    visit({"phase_deg", "of the cosine at t = 0", "deg", angle_bounds}, torque.phase_deg);
}

void part_fields(KeyVisitor& visit, ParticleSpec& particle) {
    visit({"mass_kg", "mass", "kg", positive}, particle.mass_kg);
    visit({"position_m", "place at the start, [x, y]", "m"}, particle.position_m);
    visit({"velocity_m_per_s", "velocity at the start, [x, y]", "m/s"}, particle.velocity_m_per_s);
}

void part_fields(KeyVisitor& visit, PartSpec& part) {
    using enum PartKind;
    const auto is = [&](auto... kinds) { return ((part.kind == kinds) || ...); };
    const auto kind = name_of(part.kind);
    constexpr std::string_view as_released = "that of the start";
    if (is(anchor, slot_line, slot_circle))
        visit({.key = "particle", .help = "name of the particle", .needed_by = kind}, part.particle);
    if (is(rod, spring, attraction)) {
        const bool is_fixable = part.kind != attraction;
        visit({.key = "from",
               .help = is_fixable ? "name of a particle, or a fixed place [x, y]" : "name of a particle",
               .needed_by = kind},
              part.from);
        visit({.key = "to", .help = is_fixable ? "the other end" : "name of the other particle", .needed_by = kind},
              part.to);
    }
    if (is(anchor, slot_line, slot_circle, droplet))
        visit({.key = "position_m",
               .help = is(slot_circle) ? "the centre" : "place; of a line, a point of it",
               .unit = "m",
               .absent = as_released,
               .needed_by = is(slot_circle, droplet) ? kind : ""},
              part.position_m);
    if (is(slot_line)) visit({"direction", "of the line, [x, y]"}, part.direction);
    if (is(rod, spring))
        visit({"length_m", "length; of a spring at rest", "m", is(spring) ? not_negative : positive, as_released},
              part.length_m);
    if (is(slot_circle)) visit({"radius_m", "radius", "m", positive, as_released}, part.radius_m);
    if (is(spring)) {
        visit({"stiffness_N_per_m", "stiffness", "N/m", positive}, part.stiffness_N_per_m);
        visit({"damping_N_s_per_m", "damping", "N s/m", not_negative}, part.damping_N_s_per_m);
    }
    if (is(droplet)) visit({"mass_kg", "mass", "kg", positive}, part.mass_kg);
    if (is(attraction, droplet))
        visit({"constant_m3_per_kg_s2", "gravitational constant", "m³/(kg s²)", positive, "Newton's"},
              part.constant_m3_per_kg_s2);
}

void video_fields(KeyVisitor& visit, VideoSpec& video) {
    format_fields(visit, video);
    time_fields(visit, video);
    layout_fields(visit, video);
    style_fields(visit, video);
}

std::vector<SideEntry> entries_of(SideSpec& side) {
    std::vector<SideEntry> all;
    const auto add = [&](std::string_view table, auto& entries) {
        for (auto& entry : entries) {
            auto kind = table;
            if constexpr (requires { entry.kind; }) kind = name_of(entry.kind);
            all.push_back({table, kind, entry.name, static_cast<int>(all.size()) + 1,
                           [&entry](KeyVisitor& visit) { part_fields(visit, entry); }});
        }
    };
    add("torque", side.physical.torques);
    add("particle", side.particles);
    add("constraint", side.constraints);
    add("force", side.forces);
    return all;
}

void for_each_key(SideSpec& side, const UseKey& use) {
    struct Visitor : KeyVisitor {
        explicit Visitor(const UseKey& use_key) : use(use_key) {}
        void key(const Field& field, const KeyMember& member) override { use(owner, field, member); }
        void table(std::string_view name, const std::function<void(KeyVisitor&)>& fields) override {
            owner.table = name;
            fields(*this);
            owner = {};
        }
        const UseKey& use;
        SideEntry owner;
    } visit(use);
    side_fields(visit, side);
    for (const auto& entry : entries_of(side)) {
        visit.owner = entry;
        entry.fields(visit);
    }
}

}  // namespace doppel
