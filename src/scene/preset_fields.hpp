#pragma once

#include "scene/preset.hpp"

#include <fmt/format.h>

#include <array>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace doppel {

/// A member of enumeration type: its names, the current one, and a function to set another.
struct ChosenName {
    std::span<const std::string_view> names;
    std::string_view name;
    void* member;
    void (*set)(void* member,
                std::size_t name);  // a function pointer keeps KeyMember trivial and cheap to compile

    void choose(std::size_t k) const { set(member, k); }
};

template <class... T>
using PointerToAny = std::variant<ChosenName, T*..., std::optional<T>*...>;

/// A pointer to the member that belongs to a key. Its type decides how values are read (toml_values.cpp), written
/// (resolved.cpp) and described (tests/figure/field_table.cpp).
using KeyMember = PointerToAny<bool, int, double, Quad, Rational, std::string, std::vector<double>, std::vector<Quad>,
                               std::vector<std::string>, QuadPair, EndSpec, Size, std::array<int, 2>, Range, Panels,
                               Speed, Members, ChosenText, TomlValues, Color, std::array<Color, 2>>;

template <class T>
KeyMember member_of(T& member) {
    if constexpr (std::is_enum_v<T>)
        return ChosenName{names_of<T>, name_of(member), &member,
                          [](void* chosen, std::size_t k) { *static_cast<T*>(chosen) = static_cast<T>(k); }};
    else
        return &member;
}

/// Visits a list of keys: visit(field, member) for each, visit.table(name, list) for an inner table. Visitors that do
/// not read leave the members unchanged.
class KeyVisitor {
public:
    virtual ~KeyVisitor() = default;

    template <class T>
    void operator()(const Field& field, T&& member) {
        key(field, member_of(const_cast<std::remove_cvref_t<T>&>(member)));
    }
    virtual void key(const Field& field, const KeyMember& member) = 0;
    virtual void table(std::string_view key, const std::function<void(KeyVisitor&)>& fields) = 0;
    virtual bool from_command_line(std::string_view) { return false; }
};

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
