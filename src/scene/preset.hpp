#pragma once

#include "base/error.hpp"
#include "image/color.hpp"
#include "image/picture.hpp"
#include "integrate/motion.hpp"
#include "numeric/quad.hpp"
#include "numeric/rational.hpp"
#include "output/formats.hpp"
#include "plot/page.hpp"
#include "render/typeface.hpp"
#include "scene/field.hpp"
#include "track/track.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace doppel {

// What a film shows, and how.

struct Range {
    double low, high;
};

/// How the pendulums of a film are arranged: each side in a panel, with the other as a shadow; both in one panel; an
/// ensemble between the two; both beside a phase portrait; upright for a telephone; only side a.
enum class Arrangement { side_by_side, overlay, ensemble, phase, portrait, single };
template <>
inline constexpr auto names_of<Arrangement> = std::to_array<std::string_view>({"side-by-side", "overlay", "ensemble",
                                                                               "phase", "portrait", "single"});

/// The quantity of a strip over time. "energy" is the error of the energy; with friction or a drive it becomes
/// total_energy (make_scene()). "energies" are kinetic, potential and total energy.
enum class StripKind {
    distance,
    exponent,
    energy,
    rod_error,
    rod_force,
    energies_a,
    energies_b,
    angles,
    rates,
    total_energy
};
inline constexpr std::size_t strip_kinds = 10;
template <>
inline constexpr auto names_of<StripKind> = std::to_array<std::string_view>({"distance", "exponent", "energy",
                                                                             "rod-error", "rod-force", "energies-a",
                                                                             "energies-b", "angles", "rates",
                                                                             "total-energy"});
inline constexpr std::array<std::string_view, strip_kinds> range_keys{
    "distance_range",   "exponent_range",   "energy_range", "rod_error_range", "rod_force_range",
    "energies_a_range", "energies_b_range", "angles_range", "rates_range",     "total_energy_range"};
/// Whether its axis is logarithmic.
constexpr bool is_logarithmic(StripKind kind) {
    return kind == StripKind::distance || kind == StripKind::energy || kind == StripKind::rod_error;
}

/// The contents of a phase portrait: rate against angle as a path, or the points of a Poincaré section (θ1 passing the
/// downward vertical upwards).
enum class PhaseKind { rate, section };
template <>
inline constexpr auto names_of<PhaseKind> = std::to_array<std::string_view>({"rate", "section"});

template <>
inline constexpr auto names_of<FilmFormat> = format_names;
template <>
inline constexpr auto names_of<PictureFormat> = std::to_array<std::string_view>({"png", "pdf", "svg", "html"});
template <>
inline constexpr auto names_of<PixelFormat> = pixel_format_names;

/// A member of a group of similar keys.
template <class Group, class Value>
struct Member {
    std::string_view key;
    Value Group::*member;
    std::string_view help;
};

/// Widths of lines, px of a 1920×1080 picture. Finer lines lose their hue in 4:2:0 video.
struct Widths {
    double trail = 4.4, trace = 2.8;
    double grid = 1.4, mark = 1.6;  // lines of charts; current time, divergence, limits
    std::optional<double> rod,
        bob;  // width of a rod, radius of the heaviest bob; if not given, from the size of the panel
};
inline constexpr std::array<Member<Widths, double>, 4> width_names{{
    {"trail", &Widths::trail, "the path behind the last bob"},
    {"trace", &Widths::trace, "curves of strips"},
    {"grid", &Widths::grid, "lines of charts"},
    {"mark", &Widths::mark, "lines that mark now, the divergence and the predictability limit"},
}};

/// Text sizes, px per em in a 1920×1080 picture; still legible at a third of that size.
struct FontSizes {
    double title = 42, subtitle = 27, clock = 42, heading = 34, note = 27, strip = 27, axis = 27, card = 84;
};
inline constexpr std::array<Member<FontSizes, double>, 8> font_size_names{{
    {"title", &FontSizes::title, "the title"},
    {"subtitle", &FontSizes::subtitle, "the line below it"},
    {"clock", &FontSizes::clock, "the time"},
    {"heading", &FontSizes::heading, "headings of the sides"},
    {"note", &FontSizes::note, "the line below a heading"},
    {"strip", &FontSizes::strip, "titles and values of strips"},
    {"axis", &FontSizes::axis, "numbers of axes"},
    {"card", &FontSizes::card, "the title on a card"},
}};

/// The colours of a theme that a preset may change.
inline constexpr std::array<Member<Theme, Color>, 11> color_names{{
    {"background", &Theme::background, "behind everything"},
    {"panel", &Theme::panel, "behind the pendulums"},
    {"text", &Theme::text, "titles and headings"},
    {"quiet_text", &Theme::quiet_text, "notes and axes"},
    {"grid", &Theme::grid, "lines of charts"},
    {"frame", &Theme::frame, "borders of panels"},
    {"cursor", &Theme::cursor, "the line that marks now"},
    {"rod", &Theme::rod, "rods"},
    {"bob", &Theme::bob, "bobs"},
    {"pivot", &Theme::pivot, "pivots"},
    {"trace", &Theme::trace, "curves of both sides together"},
}};

/// What a film shows: texts around its pendulums ("credit": Doppel's name on the end card), and parts of the panels
/// ("circle": the circle that the outstretched chain can reach; "twin": the other side as a shadow). Trails and pivots
/// are always shown.
inline constexpr auto shown_parts = std::to_array<std::string_view>(
    {"title", "subtitle", "clock", "labels", "credit", "rods", "bobs", "circle", "twin"});

/// The range of speeds if the speed changes.
inline constexpr auto changing_speeds = from_to(0.001, 1000);

/// Seconds of motion per second of film: constant, or changing at given times with easing (scene/frame_times.cpp).
struct Speed {
    struct Change {
        Rational at_s, speed;
        friend bool operator==(const Change&, const Change&) = default;
    };
    Rational constant{1, 1};      // if there are no changes
    std::vector<Change> changes;  // from 0 s on

    bool changes_over_time() const { return !changes.empty(); }
    Rational slowest() const {
        const auto by_value = [](const Change& change) { return change.speed.value(); };
        return changes.empty() ? constant : std::ranges::min(changes, {}, by_value).speed;
    }
};

struct SideSpec;

/// A member of an ensemble. Numbers that it does not give go from side a to side b in equal steps.
struct Release {
    std::vector<Quad> angle_deg, mass_kg, length_m;  // one per link; empty if not given
    std::optional<Color> color;

    /// Its lists with their keys, those of a side, and their symbols in pictures.
    struct List {
        std::string_view key;
        std::vector<Quad> Release::*member;
        std::vector<Quad> SideSpec::*of_side;
        std::string_view symbol, unit;
    };
    static const std::array<List, 3> lists;
};

/// The members of an ensemble: a number of them from side a to side b, or a list.
struct Members {
    static constexpr std::size_t max_releases = 8;
    int count = 100;                // including the pair
    std::vector<Release> releases;  // empty, or 2 to max_releases

    std::size_t size() const { return releases.empty() ? static_cast<std::size_t>(count) : releases.size(); }
};

/// The part of the plane shown in a panel, instead of an automatic one.
struct ViewSpec {
    std::optional<std::array<Quad, 2>> center_m;  // x and y
    std::optional<double> height_m;
    int follow = 0;  // number of the mass that stays in the centre, from 1; 0 = none
};

/// Whether a film shows the pendulums, and the strips below them.
struct Panels {
    bool pendulums = true;
    std::vector<StripKind> strips{StripKind::distance};
};

/// [video]: contents and output of a film. Sizes are for 1920×1080 and scale with the picture. A transparent film has
/// no page and no panels.
struct VideoSpec : Panels, VideoOptions {
    std::optional<Rational> fps;  // frames/s; if not given, sample_hz · speed, at most 30 for a gif
    Speed speed;
    double speed_ease_s = 0.5;                      // of motion, before each change
    Rational hold_start_s{0, 1}, hold_end_s{0, 1};  // hold times of the first and last frame
    Rational title_card_s{0, 1}, end_card_s{0, 1};  // 0 = none

    int position_bits = 16;                           // for html: bits of an embedded place or angle
    std::optional<Rational> poster_s;                 // save the frame nearest to this time as a picture
    std::optional<std::array<int, 2>> contact_sheet;  // columns and rows

    Arrangement layout = Arrangement::side_by_side;
    std::vector<std::string> show{shown_parts.begin(), shown_parts.end()};
    Members members;  // of an ensemble
    PhaseKind phase = PhaseKind::rate;
    int phase_link = 2;  // number of the link in the phase portrait
    ViewSpec view;
    std::optional<double> model_limit_s;                   // predictability limit of a fitted model, s
    std::array<std::optional<Range>, strip_kinds> ranges;  // of strips; automatic if not given

    std::string theme = "dark";
    std::array<std::optional<Color>, color_names.size()> colors;  // replace the theme's
    std::optional<std::array<Color, 2>> side_colors;
    Widths widths;
    FontSizes fonts;
    std::optional<std::string> text_font;               // path of the font file for all text
    Typeface typeface = Typeface::with_system_fonts();  // including that file
    std::optional<double> glow_px;                      // glow radius of trails and bobs; the theme's if not given
    double trail_s = 2.5;                               // s; 0 = none

    bool shows(std::string_view part) const { return std::find(show.begin(), show.end(), part) != show.end(); }
    const FormatRow& format_row() const { return doppel::format_row(format, codec); }
    /// The options of the video file at a frame rate, without metadata.
    VideoOptions options(const Rational& rate) const {
        VideoOptions options = *this;
        options.fps_numerator = rate.numerator;
        options.fps_denominator = rate.denominator;
        return options;
    }
};

// What moves.

/// The step size if neither preset nor command line gives one.
inline constexpr Rational default_step{1, 30000};  // s, from Kao's study
inline const Quad usual_tolerance = parse_quad("1e-12"), usual_quad_tolerance = parse_quad("1e-28");

enum class ModelChoice { automatic, angles, constraints, mechanism };
template <>
inline constexpr auto names_of<ModelChoice> = std::to_array<std::string_view>({"auto", "angles", "constraints",
                                                                               "mechanism"});
template <>
inline constexpr auto names_of<Model> = std::to_array<std::string_view>({"angles", "constraints", "mechanism"});
template <>
inline constexpr auto names_of<Precision> = std::to_array<std::string_view>({"double", "quad"});
template <>
inline constexpr auto names_of<Stabilise> = std::to_array<std::string_view>({"none", "baumgarte", "projection"});

/// A text of pictures: automatic, set by the preset, or none.
struct ChosenText {
    bool shown = true;
    std::optional<std::vector<std::string>> own;  // paragraphs
};

using QuadPair = std::array<Quad, 2>;  // x and y

/// Values of any key, each as TOML: `90`, `"rk4"`, `[90, 0]`.
struct TomlValues {
    std::vector<std::string> texts;
};

/// An end of a rod or a spring: the name of a particle, or a fixed position, m.
using EndSpec = std::variant<std::string, QuadPair>;

/// [[system.particle]]: a point mass and its initial state.
struct ParticleSpec {
    std::string name;
    Quad mass_kg = 1;
    QuadPair position_m{}, velocity_m_per_s{};
};

/// The kinds of [[system.constraint]] and [[system.force]]: constraints first, then forces.
enum class PartKind { anchor, rod, slot_line, slot_circle, spring, attraction, droplet };
template <>
inline constexpr auto names_of<PartKind> = std::to_array<std::string_view>({"anchor", "rod", "slot-line", "slot-circle",
                                                                            "spring", "attraction", "droplet"});
inline constexpr std::size_t constraint_kinds = 4;

/// A constraint or a force. Its kind decides which keys it has (part_fields()). Lengths and positions that are not
/// given are those at the start.
struct PartSpec {
    std::string name = {};
    PartKind kind = PartKind::anchor;
    std::string particle = {};                  // for an anchor and slots
    std::optional<EndSpec> from = {}, to = {};  // for rods, springs and attractions
    std::optional<QuadPair> position_m = {};    // of an anchor; point of a line; centre of a circle; of a droplet
    QuadPair direction{1, 0};                   // for a slot-line
    std::optional<Quad> length_m = {}, radius_m = {};  // for a rod, or a spring at rest; for a slot-circle
    Quad stiffness_N_per_m = 1, damping_N_s_per_m = 0, mass_kg = 1;
    std::optional<Quad> constant_m3_per_kg_s2 = {};  // G
};

/// [system.pivot]: an oscillating pivot, amplitude · cos(2π · frequency · t + phase).
struct PivotSpec {
    Quad direction_deg = 90;  // from the x axis: 90 = upwards
    Quad amplitude_m = 0, frequency_hz = 1, phase_deg = 0;

    friend bool operator==(const PivotSpec&, const PivotSpec&) = default;
};

/// [[system.torque]]: a driving torque at a joint, amplitude · cos(2π · frequency · t + phase).
struct TorqueSpec {
    std::string name;
    int joint = 1;  // 1 = at the pivot
    Quad amplitude_N_m = 0, frequency_hz = 1, phase_deg = 0;

    friend bool operator==(const TorqueSpec&, const TorqueSpec&) = default;
};

bool is_zero(const std::vector<Quad>& numbers);

/// Properties of a rigid-body chain: links with mass, friction, a drive. One number per link.
struct PhysicalSpec {
    std::vector<Quad> rod_mass_kg{0, 0}, inertia_kg_m2{0, 0};
    std::vector<Quad> center_m;  // empty: at the ends
    std::vector<Quad> joint_viscous_N_m_s{0, 0}, joint_coulomb_N_m{0, 0};
    std::vector<Quad> arm_drag_linear_N_m_s{0, 0}, arm_drag_quadratic_N_m_s2{0, 0}, air_drag_quadratic_N_m_s2{0, 0};
    std::vector<Quad> drag_linear_N_s_per_m{0, 0}, drag_quadratic_N_s2_per_m2{0, 0};
    PivotSpec pivot;
    std::vector<TorqueSpec> torques;

    /// A key with one number per link.
    struct Property {
        std::string_view key;
        std::vector<Quad> PhysicalSpec::*member;
        std::string_view unit, kind, caption, help;  // `kind` = what such chains are said to have
        std::string_view absent = {};                // meaning of an empty list; the others are never empty
    };
    static const std::array<Property, 10> properties;

    friend bool operator==(const PhysicalSpec&, const PhysicalSpec&) = default;

    /// Whether the property is given.
    bool has(const Property& property) const;
    bool is_none() const;
    bool has_coulomb() const { return !is_zero(joint_coulomb_N_m); }
};

inline constexpr std::array<PhysicalSpec::Property, 10> PhysicalSpec::properties{{
    {"rod_mass_kg", &PhysicalSpec::rod_mass_kg, "kg", "links with mass", "",
     "mass of each uniform rod, in addition to mass_kg"},
    {"center_m", &PhysicalSpec::center_m, "m", "links with mass", "centre of mass",
     "makes mass_kg a rigid body: distance from its joint to the centre of mass", "at the end"},
    {"inertia_kg_m2", &PhysicalSpec::inertia_kg_m2, "kg m²", "links with mass", "",
     "moment of inertia of this body about its centre of mass"},
    {"joint_viscous_N_m_s", &PhysicalSpec::joint_viscous_N_m_s, "N m s", "friction", "viscous friction",
     "friction at each joint, proportional to its rate"},
    {"joint_coulomb_N_m", &PhysicalSpec::joint_coulomb_N_m, "N m", "friction", "Coulomb friction",
     "Coulomb friction at each joint, independent of its rate"},
    {"arm_drag_linear_N_m_s", &PhysicalSpec::arm_drag_linear_N_m_s, "N m s", "drag", "linear drag on links",
     "drag on each link, proportional to its own rate"},
    {"arm_drag_quadratic_N_m_s2", &PhysicalSpec::arm_drag_quadratic_N_m_s2, "N m s²", "drag", "drag on links",
     "drag on each link, proportional to the square of its own rate"},
    {"air_drag_quadratic_N_m_s2", &PhysicalSpec::air_drag_quadratic_N_m_s2, "N m s²", "drag", "air drag",
     "drag on each link, proportional to the square of the normal velocity at its centre of oscillation"},
    {"drag_linear_N_s_per_m", &PhysicalSpec::drag_linear_N_s_per_m, "N s/m", "drag", "linear drag",
     "drag on each end of a link, proportional to its speed"},
    {"drag_quadratic_N_s2_per_m2", &PhysicalSpec::drag_quadratic_N_s2_per_m2, "N s²/m²", "drag", "quadratic drag",
     "drag on each end of a link, proportional to the square of its speed"},
}};

/// [a.track]: a measured motion, shown instead of a simulation.
struct TrackSpec {
    std::string file;                    // as found; empty: none
    std::optional<Quad> start_s;         // time in the file; if not given, that of the first sample
    std::vector<Quad> offset_deg{0, 0};  // of the encoders: their reading at rest
    std::shared_ptr<const Track> track;  // contents of the file
    std::string sha256;                  // of the file

    bool is_none() const { return file.empty(); }
};

/// One side of the pair, from [system] with [a] or [b] on top. Numbers have the written digits, up to 34; angles are in
/// degrees.
struct SideSpec {
    std::vector<Quad> mass_kg{1, 1};
    std::vector<Quad> length_m{1, 1};
    std::vector<Quad> angle_deg{90, 90};
    std::vector<Quad> omega_deg_per_s{0, 0};
    Quad gravity_m_per_s2 = Quad(98) / 10;
    ModelChoice model = ModelChoice::automatic;
    std::string integrator = "euler";
    bool integrator_from_command_line = false;
    std::optional<Rational> step_s;  // for methods with a fixed step
    std::optional<Quad> tolerance;   // for adaptive methods
    std::optional<Quad> accuracy;    // rad; instead of integrator, step size and tolerance (scene/method_choice.hpp)
    bool accuracy_from_command_line = false;
    Precision precision = Precision::in_double;
    Stabilise stabilise = Stabilise::none;
    Quad stabilise_rate_per_s = 10;  // Baumgarte's α = β
    PhysicalSpec physical;
    TrackSpec track;
    std::vector<ParticleSpec> particles;  // instead of a chain
    std::vector<PartSpec> constraints, forces;
    std::optional<std::string> label, note;                             // replace the automatic texts of the side
    std::map<std::pair<std::string, std::size_t>, std::string> places;  // of entries, by table and number, for errors

    Rational step() const { return step_s.value_or(default_step); }
    Quad allowed_error() const {
        return tolerance.value_or(precision == Precision::in_quad ? usual_quad_tolerance : usual_tolerance);
    }

    /// Whether method and step size are chosen by the accuracy.
    bool is_chosen() const { return accuracy && track.is_none(); }
    std::size_t links() const { return mass_kg.size(); }
    /// The number of particles, or of ends of links.
    std::size_t masses() const { return particles.empty() ? links() : particles.size(); }
    /// If the number changes, all links are released horizontally, at rest.
    void set_links(std::size_t links);
    /// Whether the system is more than a chain under gravity.
    bool is_mechanism() const { return !particles.empty() || !constraints.empty() || !forces.empty(); }
};

inline constexpr std::array<Release::List, 3> Release::lists{
    {{"angle_deg", &Release::angle_deg, &SideSpec::angle_deg, "θ", "°"},
     {"mass_kg", &Release::mass_kg, &SideSpec::mass_kg, "m", " kg"},
     {"length_m", &Release::length_m, &SideSpec::length_m, "l", " m"}}};

struct TomlDocument;

/// A scene described by a preset file: read, completed and checked, not yet computed.
struct Preset {
    std::string name;                     // of the file, without folder and extension
    std::string title;                    // the name if not given
    std::optional<std::string> subtitle;  // replaces the automatic subtitle
    Rational duration_s{30, 1};
    Rational sample_hz{120, 1};
    bool energy_columns = false;  // table has kinetic and potential energies
    bool member_columns = false;  // table has the members of an ensemble
    bool certify = false;         // proves how long the run follows the true motion (scene/certificate.hpp)
    SideSpec a, b;
    VideoSpec video;
    std::shared_ptr<const TomlDocument> document = {};  // of a film: for the places of errors
};

/// An error in a key of a side, or in an entry of this table, numbered from 0.
struct PlacedError : Error {
    PlacedError(const Error& error, std::string in_key, std::optional<std::size_t> in_entry = {})
        : Error(error), key(std::move(in_key)), entry(in_entry) {}

    std::string key;
    std::optional<std::size_t> entry;
};

/// Whether the sides are of different types: chains of different length, or a chain and a mechanism. Then only their
/// last masses can be compared.
bool differ_in_kind(const SideSpec& a, const SideSpec& b);

/// A value from the command line that replaces one of the preset: "system.step_s" = "\"1/1000\"", from option `origin`,
/// which begins with "--".
struct Override {
    std::string key;     // "table.key"
    std::string value;   // TOML
    std::string origin;  // shown in errors: "--set system.step_s"
};

/// The text of a preset and its source.
struct PresetText {
    std::string name;  // "butterfly"
    std::string path;  // "presets/butterfly.toml": shown in errors
    std::string text;
    std::string call;  // name or path for find_preset()
};

/// Longest name of a preset, bytes. File systems allow 255 for a file; the rest is for suffixes, the longest being
/// ".100000-of-100000.HASH.resume.part".
inline constexpr std::size_t longest_preset_name = 255 - 64;

/// Checks a name that becomes that of a folder and the prefix of its files. Throws Error (exit 2) if it leads out of
/// the folder, is too long, not UTF-8, or contains a control character; `path` = the source of the name.
void check_preset_name(const std::string& path, const std::string& name);

/// Finds a preset: a path (with a slash or ending in .toml), a name in presets/ or presets/figures/ of the current
/// folder, or a built-in name. A pipe is read if `stop` is given, which ends the waiting. Throws Error: exit 2 naming
/// the nearest preset, or what is wrong with the file or its name; exit 4 if it cannot be read; exit 130 soon after
/// `stop` is set.
PresetText find_preset(const std::string& name_or_path, const std::atomic<bool>* stop = nullptr);

/// The path of a file named in a preset: relative to the preset, or else to the current folder; from the command line
/// always the latter.
std::string path_beside(const std::string& preset_path, const std::string& given, bool from_command_line);

/// All built-in presets, sorted by name.
std::vector<PresetText> builtin_presets();

/// The `kind` in [scene]. Throws as read_preset().
std::string kind_of_preset(const PresetText& source);
/// Whether the preset is a figure (figure/preset.hpp) and not a film. Throws as read_preset().
bool is_figure(const PresetText& source);

/// Reads and checks a preset. Unknown keys, wrong types or lengths, and values out of range throw Error (exit 2) with
/// the place, the value and what would be right.
Preset read_preset(const PresetText& source, const std::vector<Override>& overrides = {});

/// Parses the key=value of --set. Throws Error (exit 2) if it has another form.
Override parse_set(const std::string& argument);

class TomlReader;

// Readers of the tables that films and figures share. They change only members whose keys are given, and throw Error
// (exit 2) as TomlReader does.

/// One of scene_kinds. Throws Error if it is not that of a film, or of a figure.
std::string read_kind(TomlReader& scene, const PresetText& source, bool is_film);

/// Reads a [system] of which only the chain and its release matter, not the integration; `is_physical`: including the
/// properties of rigid-body chains.
void read_release(TomlReader& table, SideSpec& side, bool is_physical);

/// Reads [system], then [a] and [b] on top, each level by level: later levels override earlier ones. Sides of a film
/// have texts of their own.
void read_sides(const std::vector<TomlReader*>& levels, Preset& preset, bool is_film = false);

/// Checks that samples are at steps, that the end is at a sample, and that no sum of times overflows 64 bits.
void check_clock(const Preset& preset, const TomlReader& scene);

/// Checks the number of frames. Rounded rates become exact ones: 23.976 becomes 24000/1001. A GIF, and a film whose
/// speed changes, get a rate if none is given.
void check_frames(Preset& preset, const TomlReader& video);

}  // namespace doppel
