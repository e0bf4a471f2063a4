#pragma once

#include "scene/preset.hpp"

#include <functional>
#include <span>
#include <string_view>
#include <type_traits>
#include <variant>

namespace doppel {

/// A member that is one of an enumeration: its names, the one that it has, and how to give it another.
struct ChosenName {
    std::span<const std::string_view> names;
    std::string_view name;
    void* member;
    void (*set)(void* member,
                std::size_t name);  // a pointer, not a std::function: KeyMember stays trivial, and cheap to compile

    void choose(std::size_t k) const { set(member, k); }
};

template <class... T>
using PointerToAny = std::variant<ChosenName, T*..., std::optional<T>*...>;

/// The member that a key stands for. How its values are read (toml_values.cpp), written (resolved.cpp) and described
/// (value_types.cpp) goes by its type.
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

/// What goes through a list of keys: visit(field, member) for each, visit.table(name, list) for a table inside. Those that
/// do not read leave the members as they are.
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
