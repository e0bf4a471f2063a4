#pragma once

#include "scene/preset.hpp"

#include <functional>
#include <span>
#include <string_view>
#include <type_traits>
#include <variant>

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

}  // namespace doppel
