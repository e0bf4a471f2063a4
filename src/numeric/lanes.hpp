#pragma once

#include <Eigen/Core>

#include <bit>
#include <cmath>
#include <cstdint>
#include <type_traits>

namespace doppel {

/// Doubles per register: 2, or the width for which cmake/widths.cmake compiles a file again.
#ifdef DOPPEL_COMPILED_WIDTH
constexpr int compiled_width = DOPPEL_COMPILED_WIDTH;
#else
constexpr int compiled_width = 2;
#endif

/// Mean error of approximating log2 by straight lines between powers of two.
inline constexpr double rough_log2_deviation = 0.043;

template <int width>
struct LaneRegister {
    typedef double Doubles __attribute__((vector_size(8 * width)));
    typedef std::int64_t Masks __attribute__((vector_size(8 * width)));
    typedef double Memory __attribute__((vector_size(8 * width), aligned(8), may_alias));  // doubles in memory
};

/// `lanes` doubles that are computed side by side, each with the operations, and so the bits, of a single double: + − ×
/// ÷ and the square root round equally at every width; for sine and cosine see numeric/sin_cos.hpp. More lanes than a
/// register has hide latency. Comparisons give a mask for select().
///
/// `Build` names the code that the type belongs to. Code for different processors must have different `Build` types, or
/// the linker would mix them up (integrate/batch_width.cpp).
template <int lanes, class Build = void>
struct Lanes {
    static constexpr int width = lanes;
    static constexpr int part = lanes < compiled_width ? lanes : compiled_width, parts = lanes / part;
    using Doubles = typename LaneRegister<part>::Doubles;
    using Masks = typename LaneRegister<part>::Masks;
    using Memory = typename LaneRegister<part>::Memory;

    /// The result of a comparison: in each lane all bits are set, or none.
    struct Mask {
        Masks v[parts];

        [[gnu::always_inline]] friend Mask operator&(const Mask& a, const Mask& b) {
            Mask both;
            for (int k = 0; k < parts; ++k) both.v[k] = a.v[k] & b.v[k];
            return both;
        }
        [[gnu::always_inline]] friend bool all_of(const Mask& a) {
            Masks all = a.v[0];
            for (int k = 1; k < parts; ++k) all &= a.v[k];
            std::int64_t one = all[0];
            for (int i = 1; i < part; ++i) one &= all[i];
            return one != 0;
        }
    };

    Doubles v[parts];

    Lanes() = default;
    template <class Number>
    requires std::is_arithmetic_v<Number>
    [[gnu::always_inline]] Lanes(Number all) {
        for (int k = 0; k < parts; ++k) v[k] = static_cast<double>(all) - Doubles{};
    }

    /// Loads consecutive doubles, aligned like doubles.
    [[gnu::always_inline]] static Lanes load(const double* from) {
        Lanes r;
        for (int k = 0; k < parts; ++k) r.v[k] = *reinterpret_cast<const Memory*>(from + k * part);
        return r;
    }
    [[gnu::always_inline]] void store(double* to) const {
        for (int k = 0; k < parts; ++k) *reinterpret_cast<Memory*>(to + k * part) = v[k];
    }
    [[gnu::always_inline]] static Lanes of(double a, double b, double c, double d) requires(lanes == 4) {
        Lanes r;
        if constexpr (part == 4)
            r.v[0] = Doubles{a, b, c, d};
        else
            r.v[0] = Doubles{a, b}, r.v[1] = Doubles{c, d};
        return r;
    }

    [[gnu::always_inline]] double operator[](int lane) const { return v[lane / part][lane % part]; }
    [[gnu::always_inline]] void set(int lane, double x) { v[lane / part][lane % part] = x; }

    [[gnu::always_inline]] Lanes& operator+=(const Lanes& b) {
        for (int k = 0; k < parts; ++k) v[k] += b.v[k];
        return *this;
    }
    [[gnu::always_inline]] Lanes& operator-=(const Lanes& b) {
        for (int k = 0; k < parts; ++k) v[k] -= b.v[k];
        return *this;
    }
    [[gnu::always_inline]] Lanes& operator*=(const Lanes& b) {
        for (int k = 0; k < parts; ++k) v[k] *= b.v[k];
        return *this;
    }
    [[gnu::always_inline]] Lanes& operator/=(const Lanes& b) {
        for (int k = 0; k < parts; ++k) v[k] /= b.v[k];
        return *this;
    }
    [[gnu::always_inline]] friend Lanes operator+(Lanes a, const Lanes& b) { return a += b; }
    [[gnu::always_inline]] friend Lanes operator-(Lanes a, const Lanes& b) { return a -= b; }
    [[gnu::always_inline]] friend Lanes operator*(Lanes a, const Lanes& b) { return a *= b; }
    [[gnu::always_inline]] friend Lanes operator/(Lanes a, const Lanes& b) { return a /= b; }
    [[gnu::always_inline]] friend Lanes operator+(const Lanes& a) { return a; }
    [[gnu::always_inline]] friend Lanes operator-(const Lanes& a) {
        Lanes r;
        for (int k = 0; k < parts; ++k) r.v[k] = -a.v[k];
        return r;
    }
    [[gnu::always_inline]] friend Mask operator<=(const Lanes& a, const Lanes& b) {
        Mask r;
        for (int k = 0; k < parts; ++k) r.v[k] = a.v[k] <= b.v[k];
        return r;
    }
    [[gnu::always_inline]] friend Mask operator<(const Lanes& a, const Lanes& b) {
        Mask r;
        for (int k = 0; k < parts; ++k) r.v[k] = a.v[k] < b.v[k];
        return r;
    }
    [[gnu::always_inline]] friend Mask operator>(const Lanes& a, const Lanes& b) { return b < a; }

    /// In each lane a if the mask is set, otherwise b.
    [[gnu::always_inline]] friend Lanes select(const Mask& mask, const Lanes& a, const Lanes& b) {
        Lanes r;
        for (int k = 0; k < parts; ++k) r.v[k] = mask.v[k] ? a.v[k] : b.v[k];
        return r;
    }
    [[gnu::always_inline]] friend Lanes abs(const Lanes& a) {
        Lanes r;
        for (int k = 0; k < parts; ++k) r.v[k] = Doubles(Masks(a.v[k]) & (INT64_MAX - Masks{}));
        return r;
    }

    [[gnu::always_inline]] friend Lanes lesser(const Lanes& a, const Lanes& b) { return select(b < a, b, a); }

    /// log2 a within 0.05 for a > 0, by straight lines between powers of two; −1023 for zero.
    [[gnu::always_inline]] friend Lanes rough_log2(const Lanes& a) {
        // the exponent and fraction bits of a double approximate its logarithm; as the fraction of a number they are
        // read as a double
        Lanes r;
        for (int k = 0; k < parts; ++k)
            r.v[k] = (Doubles((Masks(a.v[k]) >> 11) | std::int64_t(0x4330000000000000)) - 0x1p52) * 0x1p-41 -
                     (1023 - rough_log2_deviation);
        return r;
    }
    /// 2^a within 4 % for |a| < 1000: the inverse of rough_log2.
    [[gnu::always_inline]] friend Lanes rough_exp2(const Lanes& a) {
        Lanes r;
        for (int k = 0; k < parts; ++k)
            r.v[k] = Doubles(Masks((a.v[k] + (1023 - rough_log2_deviation)) * 0x1p41 + 0x1p52) << 11 & INT64_MAX);
        return r;
    }

    friend Lanes sqrt(const Lanes& a) {
        Lanes r;
        for (int i = 0; i < width; ++i) r.set(i, std::sqrt(a[i]));
        return r;
    }

    /// Permutes the lanes: lane i gets lane i xor s.
    template <int s>
    [[gnu::always_inline]] Lanes exchanged() const requires(lanes == 4) {
        Lanes r = *this;
        if constexpr (s / 2 == 1 && part == 2) r.v[0] = v[1], r.v[1] = v[0];
#ifdef __AVX__
        if constexpr (s / 2 == 1 && part == 4)
            r.v[0] = __builtin_ia32_vperm2f128_pd256(v[0], v[0], 1);  // has half the latency of a general permutation
#endif
        for (int k = 0; s % 2 == 1 && k < parts; ++k) {
            if constexpr (part == 4)
                r.v[k] = __builtin_shufflevector(r.v[k], r.v[k], 1, 0, 3, 2);
            else
                r.v[k] = __builtin_shufflevector(r.v[k], r.v[k], 1, 0);
        }
        return r;
    }
};

template <class Scalar>
inline constexpr bool is_lanes = false;
template <int width, class Build>
inline constexpr bool is_lanes<Lanes<width, Build>> = true;

/// Types with native arithmetic: double and lanes.
template <class Scalar>
inline constexpr bool is_machine_number = std::is_same_v<Scalar, double> || is_lanes<Scalar>;

// The same for a single number, whose mask is a bool.
[[gnu::always_inline]] inline bool all_of(bool mask) {
    return mask;
}
template <class Scalar>
[[gnu::always_inline]] inline const Scalar& select(bool mask, const Scalar& a, const Scalar& b) {
    return mask ? a : b;
}

inline double rough_log2(double a) {
    return static_cast<double>(std::bit_cast<std::int64_t>(a)) * 0x1p-52 - (1023 - rough_log2_deviation);
}

/// The larger of two numbers, lane by lane; NaN if either is NaN.
template <class Scalar>
[[gnu::always_inline]] inline Scalar greater(const Scalar& a, const Scalar& b) {
    return select(b <= a, a, select(a <= a, b, a));
}

}  // namespace doppel

template <int width, class Build>
struct Eigen::NumTraits<doppel::Lanes<width, Build>> : Eigen::GenericNumTraits<doppel::Lanes<width, Build>> {
    enum { IsSigned = 1 };
};
