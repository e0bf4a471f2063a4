#pragma once

#include "integrate/motion.hpp"
#include "numeric/quad.hpp"
#include "numeric/rational.hpp"
#include "scene/video_spec.hpp"
#include "track/track.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace doppel {

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

bool differ_in_numbers_only(const PhysicalSpec& one, const PhysicalSpec& other);

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
    std::optional<std::string> label, note;  // replace the automatic texts of the side

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
};

/// Whether the sides are of different types: chains of different length, or a chain and a mechanism. Then only their
/// last masses can be compared.
bool differ_in_kind(const SideSpec& a, const SideSpec& b);

/// A value from the command line that replaces one of the preset: "system.step_s" = "\"1/1000\"", from option `origin`.
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

struct TomlDocument;
class TomlReader;

// Readers of the tables that films and figures share. They change only members whose keys are given, and throw Error
// (exit 2) as TomlReader does.

/// One of scene_kinds.
std::string read_kind(TomlReader& scene);

/// Reads [system], [a] or [b]; `has_text` = including side_text_fields().
void read_side(TomlReader& table, SideSpec& side, bool has_text = false);

/// Reads a [system] of which only the chain and its release matter, not the integration; `is_physical`: including the
/// properties of rigid-body chains.
void read_release(TomlReader& table, SideSpec& side, bool is_physical);

/// Reads [system], then [a] and [b] on top, each level by level: later levels override earlier ones. Sides of a film
/// have texts of their own.
void read_sides(const TomlDocument& document, const std::vector<TomlReader*>& levels, Preset& preset,
                bool is_film = false);

/// Checks that samples are at steps, that the end is at a sample, and that no sum of times overflows 64 bits.
void check_clock(const Preset& preset, const TomlReader& scene);

/// Reads the file of a side's track, if it has one. Throws Error or records it, as the reader of its table does.
void load_track(const TomlDocument& document, TomlReader& side_table, SideSpec& side);

/// Checks the number of frames. Rounded rates become exact ones: 23.976 becomes 24000/1001. A GIF, and a film whose
/// speed changes, get a rate if none is given.
void check_frames(Preset& preset, const TomlReader& video);

}  // namespace doppel
