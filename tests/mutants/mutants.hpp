// Included before every file that mutate.py changed: the definitions of its mutants. DOPPEL_MUTANT=<number> selects a
// mutant at run time. DOPPEL_MUTANT=-1 selects none, and marks the mutants that are reached in the file
// DOPPEL_MUTANTS_REACHED, a byte each: 1 reached, 2 reached where no other operator would compile.
#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <concepts>
#include <cstdlib>
#include <type_traits>

extern "C" {
__attribute__((weak)) int doppel_mutant = 0;
__attribute__((weak)) unsigned char* doppel_mutants_reached = nullptr;

__attribute__((weak, constructor(101))) void doppel_choose_mutant() {
    if (const char* number = std::getenv("DOPPEL_MUTANT")) doppel_mutant = std::atoi(number);
    const char* path = std::getenv("DOPPEL_MUTANTS_REACHED");
    const int file = path ? open(path, O_RDWR | O_CLOEXEC) : -1;
    if (file < 0) return;
    void* bytes = mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (bytes != MAP_FAILED) doppel_mutants_reached = static_cast<unsigned char*>(bytes);
    close(file);
}
}

namespace mutant {

inline bool chosen(int id) {
    if (doppel_mutants_reached) doppel_mutants_reached[id] |= 1;
    return doppel_mutant == id;
}
inline void cannot_be(int id) {
    if (doppel_mutants_reached) doppel_mutants_reached[id] |= 2;
}

template <class A, class B>
constexpr bool same = std::is_same_v<std::remove_cvref_t<A>, std::remove_cvref_t<B>>;

/// a OP M<id>{} OP b is a OP b, or its mutant. Left stores the left operand until the mutant is chosen.
template <int id>
struct M {};
template <class A, int op, int id>
struct Left {
    const A& a;
};

template <int id, class Is, class Other>
constexpr auto either(const Is& is, const Other& other) {
    if (std::is_constant_evaluated()) return is();
    if constexpr (same<decltype(is()), decltype(other())>) {
        return chosen(id) ? other() : is();
    } else if constexpr (requires {
                             is().eval();
                             other().eval();
                         }) {  // Eigen's expressions have different types
        if constexpr (same<decltype(is().eval()), decltype(other().eval())>) {
            auto value = is().eval();
            if (chosen(id)) value = other().eval();
            return value;
        } else {
            cannot_be(id);
            return is();
        }
    } else {
        cannot_be(id);
        return is();
    }
}

/// `near` takes the place of `op` in half of the mutants of integers, `other` in the others and in all of floating-point
/// numbers: a comparison's bound moves by one, or it is reversed.
#define DOPPEL_OPERATOR(number, op, near, other)                                      \
    template <class A, int id>                                                        \
    constexpr Left<A, number, id> operator op(const A& a, M<id>) {                    \
        return {a};                                                                   \
    }                                                                                 \
    template <class A, int id, class B>                                               \
    constexpr auto operator op(Left<A, number, id> l, const B& b) {                   \
        if constexpr (id % 2 == 0 && std::integral<A> && std::integral<B>) {          \
            return either<id>([&] { return l.a op b; }, [&] { return l.a near b; });  \
        } else if constexpr (requires { l.a other b; }) {                             \
            return either<id>([&] { return l.a op b; }, [&] { return l.a other b; }); \
        } else {                                                                      \
            if (!std::is_constant_evaluated()) cannot_be(id);                         \
            return l.a op b;                                                          \
        }                                                                             \
    }
DOPPEL_OPERATOR(1, +, -, -)
DOPPEL_OPERATOR(2, -, +, +)
DOPPEL_OPERATOR(3, *, /, /)
DOPPEL_OPERATOR(4, /, *, *)
DOPPEL_OPERATOR(5, ==, !=, !=)
DOPPEL_OPERATOR(6, !=, ==, ==)
DOPPEL_OPERATOR(7, <, <=, >=)
DOPPEL_OPERATOR(8, <=, <, >)
DOPPEL_OPERATOR(9, >, >=, <=)
DOPPEL_OPERATOR(10, >=, >, <)

/// Not<id>{} ^ b is b or its negation.
template <int id>
struct Not {};
template <int id, class B>
constexpr auto operator^(Not<id>, const B& b) {
    if (std::is_constant_evaluated()) return static_cast<bool>(b);
    return static_cast<bool>(b) != chosen(id);
}

/// 2x, or x + 1 for integers and for 0.
template <int id, class T>
constexpr T number(T x) {
    if (std::is_constant_evaluated()) return x;
    const T other = std::floating_point<T> && x != T(0) ? x + x : x + T(1);
    return chosen(id) ? other : x;
}

}  // namespace mutant
