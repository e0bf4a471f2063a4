#include "integrate/lane_series.hpp"

#include "integrate/angle_series.hpp"
#include "integrate/widths.hpp"
#include "numeric/sin_cos.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

template <int N>
typename LaneSeries<N>::Kernel kernel_for(int width) {
    const auto kernels = at_width(std::min(chosen_width(width), 4),
                                  []<int chosen>() { return lane_kernels < chosen == 2 ? 2 : 4 > (); });
    if constexpr (N == 2)
        return kernels.two;
    else
        return kernels.three;
}

}  // namespace

template <int N>
LaneSeries<N>::LaneSeries(const Pendulum<double>& p, int order, int width)
    : order_(order),
      longest_step_(longest_chain_step(p.reach(), p.gravity)),
      terms_(static_cast<std::size_t>(order + 2)),
      kernel_(kernel_for<N>(width)) {
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
    doppel::State<double, N> sin, cos;
    take_sin_cos(y, sin, cos);
    kernel_.expand(chain_, sin.data(), cos.data(), y.data() + N, terms_.data(), order_);
    amount_ = greatest(0) + std::sqrt(greatest(1));
}

template <int N>
void LaneSeries<N>::move(const double& h, State& change) {
    kernel_.move(chain_, terms_.data(), order_, h, change.data());
}

template <int N>
double LaneSeries<N>::size(int k) const {
    return amount_ == 0 ? 0 : greatest(k) / amount_;
}

template <int N>
double LaneSeries<N>::greatest(int k) const {
    double most = 0;
    for (int i = 0; i < N; ++i) most = greater(most, std::abs(terms_[static_cast<std::size_t>(k)].rate[i]));
    return most;
}

template class LaneSeries<2>;
template class LaneSeries<3>;

/// A mass much lighter than the next costs the mass matrix of the lanes its digits.
template <>
std::unique_ptr<Series<double>> series_of_chain(const Pendulum<double>& p, int order) {
    constexpr double light = 1.0 / 64;
    bool is_even = true;
    for (std::size_t k = 0; k + 1 < p.links(); ++k) is_even = is_even && p.mass[k] >= light * p.mass[k + 1];
    if (p.links() == 2 && is_even) return std::make_unique<LaneSeries<2>>(p, order);
    if (p.links() == 3 && is_even) return std::make_unique<LaneSeries<3>>(p, order);
    return std::make_unique<AngleSeries<double>>(p, order);
}

}  // namespace doppel
