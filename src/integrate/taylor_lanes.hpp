#pragma once

#include "physics/angle_series.hpp"

#include <vector>

namespace doppel {

/// Whether this processor, and this build, computes on four doubles at once (AVX2).
bool has_four_lanes();

/// AngleSeries for two or three links of double, all of them side by side in the lanes of the processor: several times
/// as fast, and bit for bit the same whether there are four lanes (`wide`) or two.
template <int N>
class LaneSeries {
public:
    using State = doppel::State<double, 2 * N>;
    static constexpr int most_orders = 64;

    /// The chain as the recurrence needs it, four lanes a number (integrate/taylor_kernel.hpp). μ_i = Σ_{k≥i} m_k.
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
        void (*expand)(const Chain&, const SinCos<double>* angles, const double* rates, Term*, int order);
        void (*move)(const Chain&, const Term*, int order, double h, double* change);
    };

    LaneSeries(const Pendulum<double>& p, int order, bool wide = has_four_lanes());

    void expand(const State& y);
    void move(double h, State& change) const { kernel_.move(chain_, terms_.data(), order_, h, change.data()); }
    double size(int k) const { return amount_ == 0 ? 0 : greatest(k) / amount_; }
    double longest_step() const { return longest_step_; }
    /// Coefficient k of the rate of a link, rad/s^(k+1).
    double rate(int k, int link) const { return terms_[static_cast<std::size_t>(k)].rate[link]; }

private:
    /// The greatest |ω_k|.
    double greatest(int k) const {
        double most = 0;
        for (int i = 0; i < N; ++i) most = greater(most, std::abs(terms_[static_cast<std::size_t>(k)].rate[i]));
        return most;
    }

    int order_;
    Chain chain_{};
    double longest_step_;  // s
    std::vector<Term> terms_;
    Kernel kernel_;
    double amount_ = 0;  // of the rates, rad/s
};

extern template class LaneSeries<2>;
extern template class LaneSeries<3>;

template <>
struct SeriesOf<AngleChain<double, 2>> {
    struct type : LaneSeries<2> {
        type(const AngleChain<double, 2>& model, int order) : LaneSeries(model.pendulum, order) {}
    };
};
template <>
struct SeriesOf<AngleChain<double, 3>> {
    struct type : LaneSeries<3> {
        type(const AngleChain<double, 3>& model, int order) : LaneSeries(model.pendulum, order) {}
    };
};
template <>
struct SeriesOf<DoublePendulum<double>> {
    struct type : LaneSeries<2> {
        type(const DoublePendulum<double>& model, int order) : LaneSeries(chain_of(model), order) {}
    };
};

}  // namespace doppel
