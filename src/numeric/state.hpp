#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <limits>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

namespace doppel {

/// A point of an N-dimensional phase space (Eigen::Dynamic = known only at run time). Every model's state consists of
/// its coordinates and their rates: (q, v) with q′ = v.
template <class Scalar, int N>
using State = Eigen::Matrix<Scalar, N, 1>;

/// N · factor; N may be Eigen::Dynamic.
template <int factor, int N>
inline constexpr int times = N == Eigen::Dynamic ? Eigen::Dynamic : factor* N;

/// N for native arithmetic, otherwise Eigen::Dynamic: quads are library calls, for which fixed sizes are not worth
/// compiling.
template <class Scalar, int N>
inline constexpr int compiled_size = std::numeric_limits<Scalar>::digits > 53 ? Eigen::Dynamic : N;

/// π to the precision of the scalar.
template <class Scalar>
Scalar pi_of() {
    using std::acos;
    return acos(Scalar(-1));
}

inline constexpr double pi = 3.14159265358979323846;
constexpr double radians(double degrees) {
    return degrees * (pi / 180);
}

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
