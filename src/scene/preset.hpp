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

/// Where neither preset nor command line says how finely to step.
inline constexpr Rational default_step{1, 30000};  // s, the study's
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

/// What stands where a picture has words of its own: these, others, or none.
struct ChosenText {
    bool shown = true;
    std::optional<std::vector<std::string>> own;  // paragraphs
};

using QuadPair = std::array<Quad, 2>;  // x and y

/// Values that any key may take, each as TOML writes it: `90`, `"rk4"`, `[90, 0]`.
struct TomlValues {
    std::vector<std::string> texts;
};

/// An end of a rod or a spring: the name of a particle, or a fixed place, m.
using EndSpec = std::variant<std::string, QuadPair>;

/// [[system.particle]]: a point mass and how it is released.
struct ParticleSpec {
    std::string name;
    Quad mass_kg = 1;
    QuadPair position_m{}, velocity_m_per_s{};
};

/// What [[system.constraint]] and [[system.force]] hold: constraints first, then forces.
enum class PartKind { anchor, rod, slot_line, slot_circle, spring, attraction, droplet };
template <>
inline constexpr auto names_of<PartKind> = std::to_array<std::string_view>({"anchor", "rod", "slot-line", "slot-circle",
                                                                            "spring", "attraction", "droplet"});
inline constexpr std::size_t constraint_kinds = 4;

/// A constraint or a force. Which keys it has is a matter of its kind (part_fields()); lengths and places that are not
/// given are those of the start.
struct PartSpec {
    std::string name = {};
    PartKind kind = PartKind::anchor;
    std::string particle = {};                  // of an anchor and of slots
    std::optional<EndSpec> from = {}, to = {};  // of rods, springs and attractions
    std::optional<QuadPair> position_m = {};    // of an anchor; a point of a line; the centre of a circle; of a droplet
    QuadPair direction{1, 0};                   // of a slot-line
    std::optional<Quad> length_m = {}, radius_m = {};  // of a rod, of a spring at rest; of a slot-circle
    Quad stiffness_N_per_m = 1, damping_N_s_per_m = 0, mass_kg = 1;
    std::optional<Quad> constant_m3_per_kg_s2 = {};  // G
};

/// [system.pivot]: a pivot that moves to and fro, at amplitude · cos(2π · frequency · t + phase).
struct PivotSpec {
    Quad direction_deg = 90;  // from the x axis: 90 = up
    Quad amplitude_m = 0, frequency_hz = 1, phase_deg = 0;

    friend bool operator==(const PivotSpec&, const PivotSpec&) = default;
};

/// [[system.torque]]: a motor at a joint, amplitude · cos(2π · frequency · t + phase).
struct TorqueSpec {
    std::string name;
    int joint = 1;  // 1 = at the pivot
    Quad amplitude_N_m = 0, frequency_hz = 1, phase_deg = 0;

    friend bool operator==(const TorqueSpec&, const TorqueSpec&) = default;
};

bool is_zero(const std::vector<Quad>& numbers);

/// What a real chain has that an ideal one lacks: links with mass, friction, a drive. One number a link.
struct PhysicalSpec {
    std::vector<Quad> rod_mass_kg{0, 0}, inertia_kg_m2{0, 0};
    std::vector<Quad> center_m;  // none: at the ends
    std::vector<Quad> joint_viscous_N_m_s{0, 0}, joint_coulomb_N_m{0, 0};
    std::vector<Quad> arm_drag_linear_N_m_s{0, 0}, arm_drag_quadratic_N_m_s2{0, 0}, air_drag_quadratic_N_m_s2{0, 0};
    std::vector<Quad> drag_linear_N_s_per_m{0, 0}, drag_quadratic_N_s2_per_m2{0, 0};
    PivotSpec pivot;
    std::vector<TorqueSpec> torques;

    /// With a number a link, all but center_m.
    static constexpr std::array<std::vector<Quad> PhysicalSpec::*, 9> lists{&PhysicalSpec::rod_mass_kg,
                                                                            &PhysicalSpec::inertia_kg_m2,
                                                                            &PhysicalSpec::joint_viscous_N_m_s,
                                                                            &PhysicalSpec::joint_coulomb_N_m,
                                                                            &PhysicalSpec::arm_drag_linear_N_m_s,
                                                                            &PhysicalSpec::arm_drag_quadratic_N_m_s2,
                                                                            &PhysicalSpec::air_drag_quadratic_N_m_s2,
                                                                            &PhysicalSpec::drag_linear_N_s_per_m,
                                                                            &PhysicalSpec::drag_quadratic_N_s2_per_m2};

    friend bool operator==(const PhysicalSpec&, const PhysicalSpec&) = default;

    /// Whether any of it is there.
    bool is_none() const;
    bool has_coulomb() const;
};

/// Whether such chains differ in numbers alone.
bool are_alike(const PhysicalSpec& one, const PhysicalSpec& other);

/// [a.track]: a measured swing, which the side shows in place of a simulation.
struct TrackSpec {
    std::string file;                    // as it was found; empty: none
    std::optional<Quad> start_s;         // on the file's clock; none: the first sample
    std::vector<Quad> offset_deg{0, 0};  // of the encoders: what they show at rest
    std::shared_ptr<const Track> track;  // what the file holds
    std::string sha256;                  // of the file

    bool is_none() const { return file.empty(); }
};

/// One side of the pair, as [system] with [a] or [b] on top describes it. Numbers are those written, to 34 digits;
/// angles stay in degrees.
struct SideSpec {
    std::vector<Quad> mass_kg{1, 1};
    std::vector<Quad> length_m{1, 1};
    std::vector<Quad> angle_deg{90, 90};
    std::vector<Quad> omega_deg_per_s{0, 0};
    Quad gravity_m_per_s2 = Quad(98) / 10;
    ModelChoice model = ModelChoice::automatic;
    std::string integrator = "euler";
    bool integrator_from_command_line = false;
    std::optional<Rational> step_s;  // of methods with a fixed step
    std::optional<Quad> tolerance;   // of adaptive methods
    std::optional<Quad> accuracy;    // rad; in place of integrator, step and tolerance (scene/method_choice.hpp)
    bool accuracy_from_command_line = false;
    Precision precision = Precision::in_double;
    Stabilise stabilise = Stabilise::none;
    Quad stabilise_rate_per_s = 10;  // Baumgarte's α = β
    PhysicalSpec physical;
    TrackSpec track;
    std::vector<ParticleSpec> particles;  // in place of a chain
    std::vector<PartSpec> constraints, forces;
    std::optional<std::string> label, note;  // in place of what pictures say of the side by themselves

    /// How finely to step where nothing was given, too.
    Rational step() const { return step_s.value_or(default_step); }
    Quad allowed_error() const {
        return tolerance.value_or(precision == Precision::in_quad ? usual_quad_tolerance : usual_tolerance);
    }

    std::size_t links() const { return mass_kg.size(); }
    /// Where their number changes, all are released level, at rest.
    void set_links(std::size_t links);
    /// Whether it takes more than a chain under gravity.
    bool is_mechanism() const { return !particles.empty() || !constraints.empty() || !forces.empty(); }
};

/// A scene as a preset file describes it: read, complete and checked, nothing computed yet.
struct Preset {
    std::string name;                     // of the file, without folder and ending
    std::string title;                    // the name where it is not given
    std::optional<std::string> subtitle;  // in place of what the scene says of itself
    Rational duration_s{30, 1};
    Rational sample_hz{120, 1};
    bool energy_columns = false;  // of the table: kinetic and potential energies
    bool member_columns = false;  // of the table: an ensemble's members
    SideSpec a, b;
    VideoSpec video;
};

/// Whether the sides differ in kind, chains of unlike length or a chain beside a mechanism: then only what hangs last can
/// be compared.
bool differ_in_kind(const SideSpec& a, const SideSpec& b);

/// A value from the command line that goes on top of a preset: "system.step_s" = "\"1/1000\"", given by `origin`.
struct Override {
    std::string key;     // table.key
    std::string value;   // TOML
    std::string origin;  // what errors name: "--set system.step_s"
};

/// Where a preset's text comes from and what it says.
struct PresetText {
    std::string name;  // "butterfly"
    std::string path;  // "presets/butterfly.toml": what errors name
    std::string text;
    std::string call;  // what finds it again: a name or a path
};

/// Bytes of a preset's name. File systems take 255 of a file's; the rest is for endings, of which
/// ".100000-of-100000.HASH.resume.part" would be the longest.
inline constexpr std::size_t longest_preset_name = 255 - 64;

/// What becomes the name of a folder and the start of those of its files. Throws Error (exit 2) where that leads out of
/// the folder, is too long, not UTF-8, or holds a control character; `path` = where the name is from.
void check_preset_name(const std::string& path, const std::string& name);

/// Finds a preset: a path (anything with a slash or ending in .toml), or a name in presets/ or presets/figures/ here,
/// or built into the program. A path may be that of a pipe where `stop` is given, which ends the waiting for it. Throws
/// Error: exit 2 that names the nearest preset, or says what is in place of the file or wrong with its name; exit 4
/// where it cannot be read; exit 130 soon after `stop` is set.
PresetText find_preset(const std::string& name_or_path, const std::atomic<bool>* stop = nullptr);

/// The path of a file that a preset names: beside the preset, or from here; from the command line always from here.
std::string path_beside(const std::string& preset_path, const std::string& given, bool from_command_line);

/// All presets that are built in, by name.
std::vector<PresetText> builtin_presets();

/// `kind` of its [scene]. Errors as read_preset()'s.
std::string kind_of_preset(const PresetText& source);
/// Whether a preset is a figure (figure/preset.hpp) and not a film. Errors as read_preset()'s.
bool is_figure(const PresetText& source);

/// Reads and checks; unknown keys, wrong types and lengths, and values out of range are Errors (exit 2) with place,
/// value found and what would be right.
Preset read_preset(const PresetText& source, const std::vector<Override>& overrides = {});

/// The key=value of --set. Throws Error (exit 2) where it is not of that form.
Override parse_set(const std::string& argument);

struct TomlDocument;
class TomlReader;

// Readers of the tables that films and figures share. Each leaves alone what the table does not say, and throws Error
// (exit 2) as TomlReader does.

/// One of scene_kinds.
std::string read_kind(TomlReader& scene);

/// [system], [a] or [b]; `has_text` = with side_text_fields().
void read_side(TomlReader& table, SideSpec& side, bool has_text = false);

/// [system] where only a chain and its release matter, and how it is integrated is not for the preset to say; `is_physical`:
/// with what a real chain has besides.
void read_release(TomlReader& table, SideSpec& side, bool is_physical);

/// [system], then [a] and [b] on top, each from level to level: what a later one says goes on top of the earlier. Those
/// of a film have texts of their own.
void read_sides(const TomlDocument& document, const std::vector<TomlReader*>& levels, Preset& preset,
                bool is_film = false);

/// Samples must be at steps, the end at a sample, and the numbers of the clock such that no sum of it leaves 64 bits.
void check_clock(const Preset& preset, const TomlReader& scene);

/// Reads the file of a side's track, if it has one. Throws Error, or takes note of the fault, as the reader of its table does.
void load_track(const TomlDocument& document, TomlReader& side_table, SideSpec& side);

/// Frames must not be too many; 23.976 frames/s and the like become what they mean, 24000/1001. A GIF, and a film whose
/// speed changes, get a rate where none is named.
void check_frames(Preset& preset, const TomlReader& video);

}  // namespace doppel
