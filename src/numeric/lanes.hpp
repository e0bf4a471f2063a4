#pragma once

#include <Eigen/Core>

#include <cmath>
#include <cstdint>
#include <type_traits>

namespace doppel {

/// Doubles in one register of the processor that the code is compiled for.
#if defined(__AVX512F__)
inline constexpr int register_width = 8;
#elif defined(__AVX__)
inline constexpr int register_width = 4;
#else
inline constexpr int register_width = 2;
#endif

template <int width>
struct LaneRegister;
template <>
struct LaneRegister<2> {
    typedef double Doubles __attribute__((vector_size(16)));
    typedef std::int64_t Masks __attribute__((vector_size(16)));
};
template <>
struct LaneRegister<4> {
    typedef double Doubles __attribute__((vector_size(32)));
    typedef std::int64_t Masks __attribute__((vector_size(32)));
};
template <>
struct LaneRegister<8> {
    typedef double Doubles __attribute__((vector_size(64)));
    typedef std::int64_t Masks __attribute__((vector_size(64)));
};

/// `lanes` doubles that are stepped side by side, each by the operations, and so to the bits, of a double on its own:
/// + − × ÷ and the square root round alike at every width; sin, cos and their like go through the C library lane by
/// lane, so they belong into rare paths. More lanes than a register holds hide the wait for its results. Lanes are
/// never compared as a whole: a comparison gives a mask, for select().
///
/// `Build` names the code that the type belongs to. Code for different processors must differ in it, or the linker
/// would take one for the other (integrate/ensemble_width.cpp).
template <int lanes, class Build = void>
struct Lanes {
    static constexpr int width = lanes;
    static constexpr int part = lanes < register_width ? lanes : register_width, parts = lanes / part;
    using Doubles = typename LaneRegister<part>::Doubles;
    using Masks = typename LaneRegister<part>::Masks;

    /// What a comparison says: a lane has all bits set, or none.
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
    [[gnu::always_inline]] friend Mask operator>=(const Lanes& a, const Lanes& b) { return b <= a; }
    [[gnu::always_inline]] friend Mask operator<(const Lanes& a, const Lanes& b) {
        Mask r;
        for (int k = 0; k < parts; ++k) r.v[k] = a.v[k] < b.v[k];
        return r;
    }
    [[gnu::always_inline]] friend Mask operator>(const Lanes& a, const Lanes& b) { return b < a; }

    /// Lane by lane a where the mask is set, else b.
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

    /// log2 a within 0.05 for a > 0, a straight line between powers of two; −1023 of zero.
    [[gnu::always_inline]] friend Lanes rough_log2(const Lanes& a) {
        // the bits of a double are its logarithm; put below the point of a number they are a double again
        Lanes r;
        for (int k = 0; k < parts; ++k)
            r.v[k] = (Doubles((Masks(a.v[k]) >> 11) | std::int64_t(0x4330000000000000)) - 0x1p52) * 0x1p-41 -
                     (1023 - rough_deviation);
        return r;
    }
    /// 2^a within 4 % for |a| < 1000: the inverse of rough_log2.
    [[gnu::always_inline]] friend Lanes rough_exp2(const Lanes& a) {
        Lanes r;
        for (int k = 0; k < parts; ++k)
            r.v[k] = Doubles(Masks((a.v[k] + (1023 - rough_deviation)) * 0x1p41 + 0x1p52) << 11 & INT64_MAX);
        return r;
    }

    friend Lanes sqrt(const Lanes& a) {
        return each(a, [](double x) { return std::sqrt(x); });
    }
    friend Lanes sin(const Lanes& a) {
        return each(a, [](double x) { return std::sin(x); });
    }
    friend Lanes cos(const Lanes& a) {
        return each(a, [](double x) { return std::cos(x); });
    }
    friend Lanes tan(const Lanes& a) {
        return each(a, [](double x) { return std::tan(x); });
    }
    friend Lanes asin(const Lanes& a) {
        return each(a, [](double x) { return std::asin(x); });
    }
    friend Lanes acos(const Lanes& a) {
        return each(a, [](double x) { return std::acos(x); });
    }
    friend Lanes exp(const Lanes& a) {
        return each(a, [](double x) { return std::exp(x); });
    }
    friend Lanes log(const Lanes& a) {
        return each(a, [](double x) { return std::log(x); });
    }
    friend Lanes atan2(const Lanes& y, const Lanes& x) {
        Lanes r;
        for (int i = 0; i < width; ++i) r.set(i, std::atan2(y[i], x[i]));
        return r;
    }

private:
    static constexpr double rough_deviation = 0.043;  // the mean one

    template <class Function>
    [[gnu::always_inline]] static Lanes each(const Lanes& a, Function function) {
        Lanes r;
        for (int i = 0; i < width; ++i) r.set(i, function(a[i]));
        return r;
    }
};

template <class Scalar>
inline constexpr bool is_lanes = false;
template <int width, class Build>
inline constexpr bool is_lanes<Lanes<width, Build>> = true;

// The same words for a lone number, whose mask is a bool.
[[gnu::always_inline]] inline bool all_of(bool mask) {
    return mask;
}
template <class Scalar>
[[gnu::always_inline]] inline const Scalar& select(bool mask, const Scalar& a, const Scalar& b) {
    return mask ? a : b;
}

/// The greater of two numbers, lane by lane of many; not a number where either is none.
template <class Scalar>
[[gnu::always_inline]] inline Scalar greater(const Scalar& a, const Scalar& b) {
    return select(b <= a, a, select(a <= a, b, a));
}

}  // namespace doppel

template <int width, class Build>
struct Eigen::NumTraits<doppel::Lanes<width, Build>> : Eigen::GenericNumTraits<doppel::Lanes<width, Build>> {
    enum {
        IsComplex = 0,
        IsInteger = 0,
        IsSigned = 1,
        RequireInitialization = 1,
        ReadCost = 1,
        AddCost = 1,
        MulCost = 1
    };
};
