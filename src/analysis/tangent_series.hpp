#pragma once

#include "analysis/tangent.hpp"
#include "integrate/taylor_series.hpp"
#include "numeric/lanes.hpp"
#include "physics/angle_chain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <vector>

namespace doppel {

/// A chain of N links and 2N tangents to its motion, as the Taylor method takes them (TangentSeries below).
///
/// State   (θ, ω, δθ, δω): N angles, N rates; then 2N numbers for each angle, one of each tangent; then for each rate.
template <int N>
struct TangentChain {
    using Scalar = double;
    static constexpr int tangents = 2 * N;
    using State = doppel::State<double, 2 * N*(1 + tangents)>;

    Pendulum<double> pendulum;
};

/// Lanes that fill whole registers.
constexpr int whole_registers(int lanes) {
    return (lanes + register_width - 1) / register_width * register_width;
}

/// The Taylor series of a chain's motion and of its tangents, order by order. With μ_ij = Σ_{k ≥ i, j} m_k and
/// κ_ij = μ_ij l_i l_j Lagrange's equations and what varies in them are
///     Σ_j κ_ij (cos(θ_i − θ_j) ω_j′ + sin(θ_i − θ_j) ω_j²) + μ_ii g l_i sinθ_i = 0 ,
///     Σ_j (C_ij δω_j′ + F_ij δω_j + E_ij (δθ_i − δθ_j)) + μ_ii g l_i cosθ_i δθ_i = 0   with
///     C_ij = κ_ij cos(θ_i − θ_j) ,  S_ij = κ_ij sin(θ_i − θ_j) ,  F_ij = 2 S_ij ω_j ,  E_ij = C_ij ω_j² − S_ij ω_j′ .
/// The series of C, E and F are found once; each is then multiplied with all tangents side by side. In dual numbers, which
/// carry derivatives through every product twice, a step takes two to three times as long.
/// Source  Benettin et al. 1980, Meccanica 15:9, for the tangents; Jorba & Zou 2005 (integrate/taylor.hpp), for the series.
template <int N>
class TangentSeries {
public:
    using State = typename TangentChain<N>::State;

    TangentSeries(const TangentChain<N>& model, int order)
        : order_(order),
          chain_(model.pendulum),
          unit_(NaturalUnits(model.pendulum).time),
          terms_(static_cast<std::size_t>(order) + 2) {
        const auto& p = model.pendulum;
        std::array<double, links> mass{};  // of what hangs on a rod
        for (std::size_t i = links; i-- > 0;) {
            mass[i] = p.mass[i] + (i + 1 < links ? mass[i + 1] : 0);
            weight_[i] = mass[i] * p.gravity * p.length[i];
        }
        for_each_pair([&](std::size_t i, std::size_t j, int lane) {
            coupling_.set(lane, mass[std::max(i, j)] * p.length[i] * p.length[j]);
        });
    }

    void expand(const State& y) {
        begin(y);
        for (int k = 0; k < order_; ++k) {
            if (k > 0) turn(k);
            accelerate(k);
            couple(k);
            vary(k);
        }
        amount_ = greatest(term(0).omega) + std::sqrt(greatest(term(1).omega));
        tangent_amount_ = greatest(term(0).tangent_omega) + greatest(term(0).tangent_theta) / unit_;
    }

    void move(double h, State& change) const {
        const Links theta = polynomial(h, [](const Term&term) { return term.theta; }),
                    omega = polynomial(h, [](const Term&term) { return term.omega; });
        for (std::size_t i = 0; i < links; ++i) {
            change[at(i)] = theta[static_cast<int>(i)];
            change[at(links + i)] = omega[static_cast<int>(i)];
            put(change, i, polynomial(h, [&](const Term& term) { return term.tangent_theta[i]; }));
            put(change, links + i, polynomial(h, [&](const Term& term) { return term.tangent_omega[i]; }));
        }
    }

    /// Of the motion or of its tangents, whichever is greater.
    double size(int k) const {
        return greater(relative(greatest(term(k).omega), amount_),
                       relative(greatest(term(k).tangent_omega), tangent_amount_));
    }

    double longest_step() const { return longest_chain_step(chain_.pendulum.reach(), chain_.pendulum.gravity); }

private:
    static constexpr std::size_t links = N;
    static constexpr int tangents = TangentChain<N>::tangents, pairs = N * (N - 1);

    using Tangents = Lanes<whole_registers(tangents)>;
    using Pairs = Lanes<whole_registers(std::max(1, pairs))>;  // (i, j) with i ≠ j
    using Links = Lanes<whole_registers(N)>;

    /// Coefficients of one order.
    struct Term {
        Links theta{0}, omega{0}, sin{0}, cos{0};                 // rad, rad/s; μ g l sinθ and μ g l cosθ
        Pairs s{0}, c{0}, apart{0};                               // S_ij, C_ij, ω_i − ω_j
        Pairs omega_j{0}, square_j{0}, turn_j{0};                 // ω_j, ω_j², ω_j′
        std::array<std::array<double, links>, links> by_theta{};  // what multiplies δθ_j,
        std::array<std::array<double, links>, links> by_omega{};  // δω_j
        std::array<std::array<double, links>, links> by_turn{};   // and δω_j′ in row i
        std::array<Tangents, links> tangent_theta, tangent_omega, tangent_turn;
    };

    static Eigen::Index at(std::size_t i) { return static_cast<Eigen::Index>(i); }
    template <class Visit>
    static void for_each_pair(Visit&& visit) {
        for (std::size_t i = 0; i < links; ++i)
            for (std::size_t j = 0; j < links; ++j)
                if (i != j) visit(i, j, static_cast<int>(i * (links - 1) + j - (j > i)));
    }
    /// For each pair (i, j) what belongs to j.
    static Pairs of_second(const Links& all) {
        Pairs r(0);
        for_each_pair([&](std::size_t, std::size_t j, int p) { r.set(p, all[static_cast<int>(j)]); });
        return r;
    }
    Term& term(int k) { return terms_[static_cast<std::size_t>(k)]; }
    const Term& term(int k) const { return terms_[static_cast<std::size_t>(k)]; }

    static Tangents get(const State& y, std::size_t i) {
        Tangents r(0);
        for (int d = 0; d < tangents; ++d) r.set(d, y[at(2 * links + i * tangents) + d]);
        return r;
    }
    static void put(State& y, std::size_t i, const Tangents& value) {
        for (int d = 0; d < tangents; ++d) y[at(2 * links + i * tangents) + d] = value[d];
    }

    /// Order 0, and the inverse of the mass matrix.
    void begin(const State& y) {
        chain_.update(y);
        typename AngleChain<double, N>::Half column;
        Term& first = term(0);
        for (std::size_t j = 0; j < links; ++j) {
            chain_.solve_mass(AngleChain<double, N>::Half::Unit(at(j)), column);
            for (std::size_t i = 0; i < links; ++i) inverse_mass_[i][j] = column[at(i)];
            first.sin.set(static_cast<int>(j), weight_[j] * chain_.sin[at(j)]);
            first.cos.set(static_cast<int>(j), weight_[j] * chain_.cos[at(j)]);
            first.tangent_theta[j] = get(y, j);
            first.tangent_omega[j] = get(y, links + j);
        }
        for_each_pair([&](std::size_t i, std::size_t j, int p) {
            const auto &sin = chain_.sin, &cos = chain_.cos;
            first.s.set(p, coupling_[p] * (sin[at(i)] * cos[at(j)] - cos[at(i)] * sin[at(j)]));
            first.c.set(p, coupling_[p] * (cos[at(i)] * cos[at(j)] + sin[at(i)] * sin[at(j)]));
        });
        Links omega(0);
        for (std::size_t i = 0; i < links; ++i) omega.set(static_cast<int>(i), y[at(links + i)]);
        set_rates(0, omega);
    }

    void set_rates(int k, const Links& omega) {
        Term& now = term(k);
        now.omega = omega;
        term(k + 1).theta = omega * Links(1.0 / (k + 1));
        const Pairs omega_j = of_second(omega);
        now.omega_j = omega_j;
        Pairs omega_i(0);
        for_each_pair([&](std::size_t i, std::size_t, int p) { omega_i.set(p, omega[static_cast<int>(i)]); });
        now.apart = omega_i - omega_j;
    }

    /// Sines and cosines of order k: sin′ = cos θ′, cos′ = −sin θ′.
    void turn(int k) {
        Links sin(0), cos(0);
        Pairs s(0), c(0);
        for (int m = 0; m < k; ++m) {
            const Term &one = term(m), &other = term(k - 1 - m);
            sin += one.cos * other.omega;
            cos -= one.sin * other.omega;
            s += one.c * other.apart;
            c -= one.s * other.apart;
        }
        Term& now = term(k);
        now.sin = sin * Links(1.0 / k);
        now.cos = cos * Links(1.0 / k);
        now.s = s * Pairs(1.0 / k);
        now.c = c * Pairs(1.0 / k);
    }

    /// ω′ of order k, and so ω of order k + 1.
    void accelerate(int k) {
        Term& now = term(k);
        Links square(0);
        for (int m = 0; m <= k; ++m) square += term(m).omega * term(k - m).omega;
        const Pairs square_j = of_second(square);
        now.square_j = square_j;
        Pairs torque = term(0).s * square_j;
        for (int m = 1; m <= k; ++m) {
            const Term &one = term(m), &other = term(k - m);
            torque += one.s * other.square_j + one.c * other.turn_j;
        }
        std::array<double, links> sum;
        for (std::size_t i = 0; i < links; ++i) sum[i] = now.sin[static_cast<int>(i)];
        for_each_pair([&](std::size_t i, std::size_t, int p) { sum[i] += torque[p]; });
        Links turn(0);
        for (std::size_t i = 0; i < links; ++i) {
            double all = 0;
            for (std::size_t j = 0; j < links; ++j) all -= inverse_mass_[i][j] * sum[j];
            turn.set(static_cast<int>(i), all);
        }
        now.turn_j = of_second(turn);
        set_rates(k + 1, turn * Links(1.0 / (k + 1)));
    }

    /// What multiplies the tangents, of order k.
    void couple(int k) {
        Pairs e(0), f(0);
        for (int m = 0; m <= k; ++m) {
            const Term &one = term(m), &other = term(k - m);
            e += one.c * other.square_j - one.s * other.turn_j;
            f += one.s * other.omega_j;
        }
        Term& now = term(k);
        for (std::size_t i = 0; i < links; ++i) now.by_theta[i][i] = now.cos[static_cast<int>(i)];
        for_each_pair([&](std::size_t i, std::size_t j, int p) {
            now.by_theta[i][i] += e[p];
            now.by_theta[i][j] = -e[p];
            now.by_omega[i][j] = 2 * f[p];
            now.by_turn[i][j] = now.c[p];
        });
    }

    /// Of one order of what multiplies the tangents and one order of these; δω′ of order k itself is not known yet.
    template <bool knows_turn>
    [[gnu::always_inline]] static void add_products(const Term& one, const Term& other,
                                                    std::array<Tangents, links>& torque) {
        for (std::size_t i = 0; i < links; ++i)
            for (std::size_t j = 0; j < links; ++j) {
                Tangents part = Tangents(one.by_theta[i][j]) * other.tangent_theta[j];
                if (i != j) part += Tangents(one.by_omega[i][j]) * other.tangent_omega[j];
                if (i != j && knows_turn) part += Tangents(one.by_turn[i][j]) * other.tangent_turn[j];
                torque[i] += part;
            }
    }

    /// δω′ of order k, and so δω and δθ of order k + 1.
    void vary(int k) {
        std::array<Tangents, links> torque;
        torque.fill(Tangents(0));
        for (int m = 1; m <= k; ++m) add_products<true>(term(m), term(k - m), torque);
        add_products<false>(term(0), term(k), torque);
        const Tangents by(1.0 / (k + 1));
        Term &now = term(k), &next = term(k + 1);
        for (std::size_t i = 0; i < links; ++i) {
            Tangents turn(0);
            for (std::size_t j = 0; j < links; ++j) turn -= Tangents(inverse_mass_[i][j]) * torque[j];
            now.tangent_turn[i] = turn;
            next.tangent_omega[i] = turn * by;
            next.tangent_theta[i] = now.tangent_omega[i] * by;
        }
    }

    /// Σ_{k ≥ 1} c_k h^k
    template <class Coefficient>
    auto polynomial(double h, Coefficient&& coefficient) const {
        using Number = std::decay_t<decltype(coefficient(term(0)))>;
        Number sum(0);
        for (int k = order_; k > 0; --k) sum = (sum + coefficient(term(k))) * Number(h);
        return sum;
    }

    static double relative(double size, double amount) { return amount == 0 ? 0 : size / amount; }

    static double greatest(const Links& all) {
        double most = 0;
        for (int i = 0; i < N; ++i) most = greater(most, std::abs(all[i]));
        return most;
    }
    static double greatest(const std::array<Tangents, links>& all) {
        double most = 0;
        for (const auto& row : all)
            for (int d = 0; d < tangents; ++d) most = greater(most, std::abs(row[d]));
        return most;
    }

    int order_;
    AngleChain<double, N> chain_;
    double unit_;                         // s, natural
    std::array<double, links> weight_{};  // μ_ii g l_i, J
    Pairs coupling_{0};                   // κ_ij, kg m²
    std::array<std::array<double, links>, links> inverse_mass_{};
    std::vector<Term> terms_;
    double amount_ = 0, tangent_amount_ = 0;  // rad/s; of tangents, in their unit over s
};

template <int N>
struct SeriesOf<TangentChain<N>> {
    using type = TangentSeries<N>;
};

}  // namespace doppel
