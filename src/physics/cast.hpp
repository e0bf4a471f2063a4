#pragma once

#include "numeric/state.hpp"

#include <cstddef>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

namespace doppel {

/// A struct template over a scalar with a function that lists its members in order of declaration.
template <class Struct>
concept Described = requires(const Struct& described) {
    described.members();
};

template <template <class> class Struct, class Scalar>
requires Described<Struct<Scalar>>
bool operator==(const Struct<Scalar>& one, const Struct<Scalar>& other) {
    return one.members() == other.members();
}

/// Converts a description to another scalar: numbers, positions, and lists, variants and structs of these. Indices are
/// unchanged.
template <class To>
struct Cast {
    std::size_t operator()(std::size_t index) const { return index; }
    template <class Number>
    To operator()(const Number& number) const {
        return static_cast<To>(number);
    }
    template <class From, int N>
    State<To, N> operator()(const State<From, N>& place) const {
        return place.template cast<To>();
    }
    template <class Part>
    auto operator()(const std::vector<Part>& all) const {
        std::vector<decltype((*this)(all[0]))> made;
        for (const auto& part : all) made.push_back((*this)(part));
        return made;
    }
    template <class... Parts>
    auto operator()(const std::variant<Parts...>& part) const {
        using Made = std::variant<decltype((*this)(std::declval<const Parts&>()))...>;
        return std::visit([&](const auto& one) -> Made { return (*this)(one); }, part);
    }
    template <template <class> class Struct, class From>
    requires Described<Struct<From>> Struct<To>
    operator()(const Struct<From>& from) const {
        return std::apply([&](const auto&... member) { return Struct<To>{(*this)(member)...}; }, from.members());
    }
};

}  // namespace doppel
