#pragma once

#include "integrate/series.hpp"
#include "physics/pendulum.hpp"

#include <vector>

namespace doppel {

/// AngleSeries for two or three links of double, all of them side by side in four lanes: several times as fast, and bit
/// for bit the same whether a register holds 4 doubles or 2.
template <int N>
class LaneSeries final : public Series<double> {
public:
    static constexpr int most_orders = 64;

    /// The chain as the recurrence needs it, four lanes a number (integrate/lane_series_width.cpp). μ_i = Σ_{k≥i} m_k.
    struct Chain {
        alignas(32) double coupling[N][4];  // μ_max(i,j) / μ_i in row i
        alignas(32) double exchange[4][4];  // the same by distance s: lane i, column i xor s
        double length[N];
        double gravity;
        double inverse[most_orders + 2];  // 1/k
    };
    /// Coefficients of one order; the forces of link i in units of μ_i.
    struct alignas(32) Term {
        double across[N - 1][4];  // r
        double rate[4];           // ω
        double force[N - 1][4];   // F
    };
    struct Kernel {
        void (*expand)(const Chain&, const double* sin, const double* cos, const double* rates, Term*, int order);
        void (*move)(const Chain&, const Term*, int order, double h, double* change);
    };

    /// `width` doubles to a register, 2 or 4; 0: the widest of the two that this processor has.
    LaneSeries(const Pendulum<double>& p, int order, int width = 0);

    void expand(const State& y) override;
    void move(const double& h, State& change) override;
    double size(int k) const override;
    double longest_step() const override { return longest_step_; }
    double rate(int k, Eigen::Index link) const override { return terms_[static_cast<std::size_t>(k)].rate[link]; }

private:
    double greatest(int k) const;  // |ω_k|

    int order_;
    Chain chain_{};
    double longest_step_;  // s
    std::vector<Term> terms_;
    Kernel kernel_;
    double amount_ = 0;  // of the rates, rad/s
};

extern template class LaneSeries<2>;
extern template class LaneSeries<3>;

/// In the code for registers of `width` doubles (cmake/widths.cmake).
struct LaneKernels {
    LaneSeries<2>::Kernel two;
    LaneSeries<3>::Kernel three;
};
template <int width>
LaneKernels lane_kernels();
template <>
LaneKernels lane_kernels<2>();
template <>
LaneKernels lane_kernels<4>();

}  // namespace doppel
