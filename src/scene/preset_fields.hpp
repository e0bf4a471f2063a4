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

/// `kind` of [scene]: of a film, and of the figures (figure/kinds.cpp).
inline constexpr std::string_view pair_kind = "pair";
inline constexpr std::array<std::string_view, 5> scene_kinds{pair_kind, "grid", "series", "section", "work-precision"};

// The keys of a film's tables, each with its member, in lists that TomlReader, TomlWriter and FieldTable visit. The
// reader checks what keys say together.

extern const Field title_field, subtitle_field, kind_field, model_field, accuracy_field, size_field, preview_field,
    theme_field;

/// [scene], without `kind`.
void clock_fields(KeyVisitor& visit, Preset& preset);
/// What the table of a film has besides; of [scene].
void column_fields(KeyVisitor& visit, Preset& preset);

// Of [system], [a] and [b].

/// The links of a chain and their sizes.
void link_fields(KeyVisitor& visit, SideSpec& side, const Bounds& masses = positive);
void chain_fields(KeyVisitor& visit, SideSpec& side, const Bounds& masses = positive);
/// What a real chain has besides, but torques.
void physical_fields(KeyVisitor& visit, PhysicalSpec& physical);
void gravity_field(KeyVisitor& visit, SideSpec& side);
/// The method, and the step or the tolerance that it goes by.
void method_fields(KeyVisitor& visit, SideSpec& side);
void precision_fields(KeyVisitor& visit, SideSpec& side);
/// All of these; `is_physical` = with what a real chain has besides.
void side_fields(KeyVisitor& visit, SideSpec& side, bool is_physical = true);
/// What [a] and [b] of a film have besides.
void side_text_fields(KeyVisitor& visit, SideSpec& side);

// Of an entry, without `name` and `kind`.
void part_fields(KeyVisitor& visit, TorqueSpec& torque);
void part_fields(KeyVisitor& visit, ParticleSpec& particle);
void part_fields(KeyVisitor& visit, PartSpec& part);

// Of [video].

/// How the film is written.
void format_fields(KeyVisitor& visit, VideoSpec& video);
/// What is shown when.
void time_fields(KeyVisitor& visit, VideoSpec& video);
void layout_fields(KeyVisitor& visit, VideoSpec& video);
/// Colours, widths, fonts, sizes of words, and trails.
void style_fields(KeyVisitor& visit, VideoSpec& video);

/// An entry of [[system.torque]], particle, constraint or force, and the list of its keys.
struct SideEntry {
    std::string_view table = {}, kind = {};  // "force", "spring"; of torques and particles the table's name
    std::string name = {};
    int number = 0;  // from 1, of all entries
    std::function<void(KeyVisitor&)> fields = {};
};
std::vector<SideEntry> entries_of(SideSpec& side);

/// use(owner, field, member) for each key that decides how a side moves. Its owner is an entry; or the side itself, where
/// all is empty; or its pivot, by `table` alone.
using UseKey = std::function<void(const SideEntry&, const Field&, const KeyMember&)>;
void for_each_key(SideSpec& side, const UseKey& use);

}  // namespace doppel
