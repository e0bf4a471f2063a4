#include "integrate/taylor_lanes.hpp"

#include <array>
#include <utility>

// The kernel twice, for what every processor has and for four lanes. Functions of the second are marked one by one:
// nothing else in this program is compiled for processors that may not be there.

namespace doppel {

namespace two_lanes {

using Half = double __attribute__((vector_size(16), may_alias));

/// Four doubles.
struct [[gnu::may_alias]] Pack {
    Half low, high;
    [[gnu::always_inline]] friend Pack operator+(Pack a, Pack b) { return {a.low + b.low, a.high + b.high}; }
    [[gnu::always_inline]] friend Pack operator*(Pack a, Pack b) { return {a.low * b.low, a.high * b.high}; }
};
[[gnu::always_inline]] inline Pack make_pack(double a, double b, double c, double d) {
    return {Half{a, b}, Half{c, d}};
}
template <int s>
[[gnu::always_inline]] inline Pack swapped(Pack v) {
    if constexpr (s % 2 == 1)
        v = {__builtin_shufflevector(v.low, v.low, 1, 0), __builtin_shufflevector(v.high, v.high, 1, 0)};
    if constexpr (s / 2 == 1) v = {v.high, v.low};
    return v;
}
#include "integrate/taylor_kernel.hpp"

}  // namespace two_lanes

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define DOPPEL_FOUR_LANES
#pragma GCC push_options
#pragma GCC target("avx2")
namespace four_lanes {

using Pack = double __attribute__((vector_size(32), may_alias));
[[gnu::always_inline]] inline Pack make_pack(double a, double b, double c, double d) {
    return Pack{a, b, c, d};
}
template <int s>
[[gnu::always_inline]] inline Pack swapped(Pack v) {
    if constexpr (s / 2 == 1)
        v = __builtin_ia32_vperm2f128_pd256(v, v, 1);  // half the latency of a general permutation
    if constexpr (s % 2 == 1) v = __builtin_shufflevector(v, v, 1, 0, 3, 2);
    return v;
}
#include "integrate/taylor_kernel.hpp"

}  // namespace four_lanes
#pragma GCC pop_options
#endif

bool has_four_lanes() {
#ifdef DOPPEL_FOUR_LANES
    return __builtin_cpu_supports("avx2");
#else
    return false;
#endif
}

namespace {

template <int N>
typename LaneSeries<N>::Kernel kernel_for([[maybe_unused]] bool wide) {
#ifdef DOPPEL_FOUR_LANES
    if (wide) return {four_lanes::expand<N>, four_lanes::move<N>};
#endif
    return {two_lanes::expand<N>, two_lanes::move<N>};
}

}  // namespace

template <int N>
LaneSeries<N>::LaneSeries(const Pendulum<double>& p, int order, bool wide)
    : order_(order),
      longest_step_(longest_chain_step(p.reach(), p.gravity)),
      terms_(static_cast<std::size_t>(order + 2)),
      kernel_(kernel_for<N>(wide)) {
    double mass[N + 1] = {};  // μ
    for (int i = N - 1; i >= 0; --i) mass[i] = mass[i + 1] + p.mass[static_cast<std::size_t>(i)];
    const auto coupling = [&](int i, int j) { return mass[i > j ? i : j] / mass[i]; };
    constexpr int used = N == 2 ? 4 : N;  // lanes; two links fill them twice
    for (int lane = 0; lane < used; ++lane) {
        for (int i = 0; i < N; ++i) chain_.coupling[i][lane] = coupling(i, lane % N);
        for (int s = 0; s < 4; ++s)
            if ((lane ^ s) < used) chain_.exchange[s][lane] = coupling(lane % N, (lane ^ s) % N);
    }
    for (int i = 0; i < N; ++i) chain_.length[i] = p.length[static_cast<std::size_t>(i)];
    chain_.gravity = p.gravity;
    for (int k = 1; k < most_orders + 2; ++k) chain_.inverse[k] = 1 / static_cast<double>(k);
}

template <int N>
void LaneSeries<N>::expand(const State& y) {
    const auto angles = [&]<int... i>(std::integer_sequence<int, i...>) {
        return std::array{SinCos<double>(y[i])...};
    }
    (std::make_integer_sequence<int, N>());
    kernel_.expand(chain_, angles.data(), y.data() + N, terms_.data(), order_);
    amount_ = greatest(0) + std::sqrt(greatest(1));
}

template class LaneSeries<2>;
template class LaneSeries<3>;

}  // namespace doppel
