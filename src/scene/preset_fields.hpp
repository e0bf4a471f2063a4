#pragma once

#include "integrate/methods.hpp"
#include "scene/member.hpp"
#include "scene/toml_reader.hpp"

#include <fmt/format.h>

#include <array>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace doppel {

/// `kind` in [scene]: of a film, and of figures (figure/kinds.cpp).
inline constexpr std::string_view pair_kind = "pair";
inline constexpr std::array<std::string_view, 5> scene_kinds{pair_kind, "grid", "series", "section", "work-precision"};

// The keys of a film's tables, each with its member, in lists visited by TomlReader and TomlWriter. The reader checks
// keys together.

extern const Field title_field, subtitle_field, kind_field, model_field, accuracy_field, size_field, preview_field,
    theme_field;

/// [scene] of a figure, except `kind`.
void clock_fields(KeyVisitor& visit, Preset& preset);
/// [scene] of a film, except `kind`.
void film_fields(KeyVisitor& visit, Preset& preset);

// Keys of [system], [a] and [b].

/// The links of a chain and their sizes.
void link_fields(KeyVisitor& visit, SideSpec& side, const Bounds& masses = positive);
void chain_fields(KeyVisitor& visit, SideSpec& side, const Bounds& masses = positive);
/// Properties of a rigid-body chain, except torques.
void physical_fields(KeyVisitor& visit, PhysicalSpec& physical);
void gravity_field(KeyVisitor& visit, SideSpec& side);
/// The method, and its step size or tolerance.
void method_fields(KeyVisitor& visit, SideSpec& side);
void precision_fields(KeyVisitor& visit, SideSpec& side);
/// All of these; `is_physical` = including the properties of rigid-body chains.
void side_fields(KeyVisitor& visit, SideSpec& side, bool is_physical = true);
/// Further keys of [a] and [b] of a film.
void side_text_fields(KeyVisitor& visit, SideSpec& side);

// The keys of an entry, except `name` and `kind`.
void part_fields(KeyVisitor& visit, TorqueSpec& torque);
void part_fields(KeyVisitor& visit, ParticleSpec& particle);
void part_fields(KeyVisitor& visit, PartSpec& part);

/// [video], except `size` and `preview`.
void video_fields(KeyVisitor& visit, VideoSpec& video);

/// An entry of [[system.torque]], particle, constraint or force.
struct SideEntry {
    std::string_view table = {},
                     kind = {};  // "force", "spring"; for torques and particles the kind is the table's name
    std::string name = {};
    int number = 0;  // from 1, among all entries
    std::function<void(KeyVisitor&)> fields = {};
};
std::vector<SideEntry> entries_of(SideSpec& side);

/// use(owner, field, member) is called for each key that decides the motion of a side. The owner is an entry, the side
/// itself (all members empty), or its pivot (only `table`).
using UseKey = std::function<void(const SideEntry&, const Field&, const KeyMember&)>;
void for_each_key(SideSpec& side, const UseKey& use);

}  // namespace doppel
