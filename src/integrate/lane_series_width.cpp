// The recurrence of AngleSeries for two and three links of double, in four lanes. Compiled for registers of 2 and of 4
// doubles, with the rules of integrate/batch_width.cpp. Each lane has its own sums in a fixed order, so both give the
// same bits.
//
// A plane vector for each link is stored in the lanes as follows:
//     two links      x1 x2 y1 y2                   and a number for each link   a1 a2 a1 a2
//     three links    x1 x2 x3 0  and  y1 y2 y3 0   and a number for each link   a1 a2 a3 0
// A linear map is stored by lane distance: by[s] has the factors from lane i xor s to lane i.

#include "integrate/lane_series.hpp"
#include "numeric/sin_cos.hpp"

namespace doppel {
namespace {

struct ThisBuild;
using Pack = Lanes<4, ThisBuild>;

/// A plane vector for each link.
template <int N>
struct Plane {
    Pack part[N - 1];

    [[gnu::always_inline]] static Plane from(const double (&x)[N], const double (&y)[N]) {
        if constexpr (N == 2) return {{Pack::of(x[0], x[1], y[0], y[1])}};
        if constexpr (N == 3) return {{Pack::of(x[0], x[1], x[2], 0), Pack::of(y[0], y[1], y[2], 0)}};
    }
    /// (x, y), the same for all links
    [[gnu::always_inline]] static Plane both(double x, double y) {
        if constexpr (N == 2) return {{Pack::of(x, x, y, y)}};
        if constexpr (N == 3) return {{Pack(x), Pack(y)}};
    }
    [[gnu::always_inline]] friend Plane operator+(const Plane& a, const Plane& b) {
        if constexpr (N == 2) return {{a.part[0] + b.part[0]}};
        if constexpr (N == 3) return {{a.part[0] + b.part[0], a.part[1] + b.part[1]}};
    }
    [[gnu::always_inline]] friend Plane operator*(const Plane& a, const Plane& b) {
        if constexpr (N == 2) return {{a.part[0] * b.part[0]}};
        if constexpr (N == 3) return {{a.part[0] * b.part[0], a.part[1] * b.part[1]}};
    }
    [[gnu::always_inline]] friend Plane operator*(const Plane& a, Pack number) {
        if constexpr (N == 2) return {{a.part[0] * number}};
        if constexpr (N == 3) return {{a.part[0] * number, a.part[1] * number}};
    }
    /// (y, x)
    [[gnu::always_inline]] Plane mirrored() const {
        if constexpr (N == 2) return {{part[0].template exchanged<2>()}};
        if constexpr (N == 3) return {{part[1], part[0]}};
    }
    /// x + y
    [[gnu::always_inline]] Pack sum() const {
        if constexpr (N == 2) return part[0] + part[0].template exchanged<2>();
        if constexpr (N == 3) return part[0] + part[1];
    }
    template <int s>
    [[gnu::always_inline]] Plane exchanged() const {
        if constexpr (N == 2) return {{part[0].template exchanged<s>()}};
        if constexpr (N == 3) return {{part[0].template exchanged<s>(), part[1].template exchanged<s>()}};
    }
};

/// A linear map from plane vectors to a number for each link.
template <int N>
struct Map {
    Plane<N> by[4];

    [[gnu::always_inline]] Pack operator()(const Plane<N>& v) const {
        const auto sum = (by[0] * v + by[1] * v.template exchanged<1>()) +
                         (by[2] * v.template exchanged<2>() + by[3] * v.template exchanged<3>());
        if constexpr (N == 2) return sum.part[0];
        if constexpr (N == 3) return sum.part[0] + sum.part[1];
    }
};

/// The lanes of number(i), for each link i.
template <int N, class Number>
[[gnu::always_inline]] inline Pack numbers(const Number& number) {
    if constexpr (N == 2) return Pack::of(number(0), number(1), number(0), number(1));
    if constexpr (N == 3) return Pack::of(number(0), number(1), number(2), 0);
}

/// n ← −m⁻¹
[[gnu::always_inline]] inline void invert(const double (&m)[2][2], double (&n)[2][2]) {
    const double factor = -1 / (m[0][0] * m[1][1] - m[0][1] * m[1][0]);
    n[0][0] = m[1][1] * factor;
    n[0][1] = -(m[0][1] * factor);
    n[1][0] = -(m[1][0] * factor);
    n[1][1] = m[0][0] * factor;
}
[[gnu::always_inline]] inline void invert(const double (&m)[3][3], double (&n)[3][3]) {
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            const int a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
            n[j][i] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
        }
    const double factor = -1 / (m[0][0] * n[0][0] + m[0][1] * n[1][0] + m[0][2] * n[2][0]);
    for (auto& row : n)
        for (double& entry : row) entry *= factor;
}

/// The data of a chain that the recurrence needs. μ_i = Σ_{k≥i} m_k.
template <int N>
struct Chain {
    static constexpr int max_orders = 64;

    Pack coupling[N]{};  // μ_max(i,j) / μ_i in row i
    Pack exchange[4]{};  // the same by lane distance s: lane i, column i xor s
    double length[N];
    double gravity;
    double inverse[max_orders + 2]{};  // 1/k

    explicit Chain(const Pendulum<double>& p) : gravity(p.gravity) {
        double mass[N + 1] = {};  // μ
        for (int i = N - 1; i >= 0; --i) mass[i] = mass[i + 1] + p.mass[static_cast<std::size_t>(i)];
        const auto of = [&](int i, int j) { return mass[i > j ? i : j] / mass[i]; };
        constexpr int used = N == 2 ? 4 : N;  // lanes in use; two links fill them twice
        for (int lane = 0; lane < used; ++lane) {
            for (int i = 0; i < N; ++i) coupling[i].set(lane, of(i, lane % N));
            for (int s = 0; s < 4; ++s)
                if ((lane ^ s) < used) exchange[s].set(lane, of(lane % N, (lane ^ s) % N));
        }
        for (int i = 0; i < N; ++i) length[i] = p.length[static_cast<std::size_t>(i)];
        for (int k = 1; k < max_orders + 2; ++k) inverse[k] = 1 / static_cast<double>(k);
    }
};

/// Coefficients of one order; the forces of link i are in units of μ_i.
template <int N>
struct Term {
    Plane<N> across;  // r
    double rate[4];   // ω
    Plane<N> force;   // F
};

/// The recurrence about one state. With D = r_0 ω_k + R_{k−1}, which is (k + 1) r̂_{k+1}, and so F_{k−1} = k F[D]:
///     R_k     = Σ_{j=2}^k r_j ω_{k+1−j} + r_1 ω_k + r_{k+1} ω_0
///     ω_{k+1} = −M⁻¹ ( r_0 · F[R_k] + k/(k+1) r_1 · F[D] + 1/(k+1) Σ_{j=2}^k r_j · F_{k−j} ) .
/// The latency from ω_k to ω_{k+1} dominates the time, not the arithmetic. So everything that does not depend on ω_k is
/// computed earlier, and the linear maps through F and M⁻¹ are computed once.
template <int N>
struct Recurrence {
    using Vectors = Plane<N>;

    const Chain<N>& chain;
    Term<N>* const term;
    const Vectors quarter = Vectors::both(-1, 1);  // rotation by 90°: (x, y) becomes (−y, x)
    const Vectors weight = Vectors::both(0, chain.gravity);
    Vectors across0, across1;  // r_0, r_1
    Vectors turning;           // ω_0 times the rotation by 90°
    Map<N> of_newest;          // −M⁻¹ r_0 · F[…]
    Map<N> of_last;            // −M⁻¹ r_1 · F[…]
    Pack inverse[4];           // −M⁻¹, by lane distance
    Pack rate;                 // ω_k
    Vectors known;             // R_{k−1}

    /// Computes rates up to `order` from angles and rates.
    [[gnu::always_inline]] void run(const double* state, int order) {
        start(state, state + N);
        rate = of_newest(known) + solve((across0 * weight).sum());
        rate.store(term[1].rate);
        Vectors across{}, force{};  // r_k, F_{k−2}
        Pack last{};                // ω_{k−1}
        for (int k = 1; k < order; ++k) {
            Vectors p{}, e{};  // Σ_{j=2}^k r_j ω_{k+1−j}, Σ_{j=2}^k r_j · F_{k−j}
            add_old(k, p, e);
            if (k == 1) e = across1 * weight;  // F_0 = F[…] + gravity
            if (k > 2) {
                const auto across2 = term[2].across;
                p = (p + across * Pack::load(term[1].rate)) + across2 * last;
                e = (e + across * term[0].force) + across2 * force;
            }
            const double step = chain.inverse[k + 1];
            const Vectors change = across0 * rate + known;
            last = rate;
            force = force_of(change) * Pack(k);
            if (k == 1) force = force + weight;
            term[k - 1].force = force;
            across = quarter * change.mirrored() * Pack(step);
            term[k + 1].across = across;

            // r_{k+1} ω_0 is (R_{k−1} + r_0 ω_k) rotated, times ω_0/(k + 1); r_0 rotated, times ω_0, is r_1
            const Vectors next = (p + turning * Pack(step) * known.mirrored()) + across1 * Pack(1 + step) * rate;
            rate = (of_newest(next) + Pack(step) * solve(e.sum())) + of_last(change * Pack(k * step));
            known = next;
            rate.store(term[k + 1].rate);
        }
    }

    [[gnu::always_inline]] void start(const double* angles, const double* rates) {
        const SinCos<Pack> turn(numbers<N>([&](int i) { return angles[i]; }));
        double x[N], y[N], dx[N], dy[N], m[N][N], n[N][N];  // r_0, r_1, M, −M⁻¹
        for (int i = 0; i < N; ++i) {
            x[i] = chain.length[i] * turn.cos[i];
            y[i] = chain.length[i] * turn.sin[i];
            dx[i] = -(y[i] * rates[i]);
            dy[i] = x[i] * rates[i];
        }
        for (int i = 0; i < N; ++i)
            for (int j = 0; j < N; ++j) m[i][j] = chain.coupling[i][j] * (x[i] * x[j] + y[i] * y[j]);
        invert(m, n);
        of_newest = map_of(x, y, n);
        of_last = map_of(dx, dy, n);
        for (int s = 0; s < 4; ++s) inverse[s] = numbers<N>([&](int i) { return (i ^ s) < N ? n[i][i ^ s] : 0; });
        across0 = Vectors::from(x, y);
        across1 = Vectors::from(dx, dy);
        rate = numbers<N>([&](int i) { return rates[i]; });
        turning = quarter * rate;
        known = across1 * rate;
        rate.store(term[0].rate);
        term[1].across = across1;
    }

    /// The map −M⁻¹ (x, y) · F[…], from n = −M⁻¹.
    [[gnu::always_inline]] Map<N> map_of(const double (&x)[N], const double (&y)[N], const double (&n)[N][N]) const {
        Map<N> map{};
        for (int i = 0; i < N; ++i) {
            const auto row = Vectors::both(x[i], y[i]) * chain.coupling[i];
            const Pack column = numbers<N>([&](int j) { return n[j][i]; });
            map.by[0] = map.by[0] + row * column;
            map.by[1] = map.by[1] + row.template exchanged<1>() * column;
            map.by[2] = map.by[2] + row.template exchanged<2>() * column;
            map.by[3] = map.by[3] + row.template exchanged<3>() * column;
        }
        return map;
    }

    /// F[v], in units of μ_i
    [[gnu::always_inline]] Vectors force_of(const Vectors& v) const {
        const auto sum = v + v.template exchanged<1>() * chain.exchange[1];
        if constexpr (N == 2) return sum;
        return sum + (v.template exchanged<2>() * chain.exchange[2] + v.template exchanged<3>() * chain.exchange[3]);
    }

    /// −M⁻¹ v
    [[gnu::always_inline]] Pack solve(Pack v) const {
        const Pack sum = inverse[0] * v + inverse[1] * v.template exchanged<1>();
        if constexpr (N == 2) return sum;
        return sum + (inverse[2] * v.template exchanged<2>() + inverse[3] * v.template exchanged<3>());
    }

    /// Adds the products for 2 < j < k, and for j = k = 2, from the middle outwards: the newest are added last.
    [[gnu::always_inline]] void add_old(int k, Vectors& p, Vectors& e) const {
        Vectors p2{}, e2{};
        const auto add = [&](int j, Vectors& into_p, Vectors& into_e) __attribute__((always_inline)) {
            const auto r = term[j].across;
            into_p = into_p + r * Pack::load(term[k + 1 - j].rate);
            into_e = into_e + r * term[k - j].force;
        };
        if (k % 2 == 0) add(k / 2 + 1, p, e);
        for (int low = (k + 1) / 2, high = k / 2 + 2; low > 2; --low, ++high) {
            add(low, p, e);
            add(high, p2, e2);
        }
        p = p + p2;
        e = e + e2;
    }
};

template <int N>
class LaneRecurrenceOf final : public LaneRecurrence {
public:
    LaneRecurrenceOf(const Pendulum<double>& p, int order) : order_(order), chain_(p) {}

    void expand(const double* state) override { Recurrence<N>{chain_, terms_}.run(state, order_); }

    /// change ← Σ_{k≥0} ω_k h^{k+1} / (k + 1) and Σ_{k≥1} ω_k h^k; even and odd orders are summed separately.
    void move(double h, double* change) const override {
        using Both = Plane<N>;  // numbers for each link, the angles in x and the rates in y
        const auto coefficient = [&](int k) __attribute__((always_inline)) {
            return Both::both(chain_.inverse[k + 1], 1) * Pack::load(terms_[k].rate);
        };
        const Pack square = Pack(h * h);
        Both even{}, odd{};
        int k = order_;
        if (k % 2 == 1) odd = coefficient(k--);
        for (; k > 0; k -= 2) {
            even = even * square + coefficient(k);
            odd = odd * square + coefficient(k - 1);
        }
        const Both total = even * square + odd * Pack(h);
        for (int i = 0; i < N; ++i) {
            change[i] = (total.part[0][i] + terms_[0].rate[i]) * h;
            change[N + i] = total.part[N - 2][N == 2 ? i + 2 : i];
        }
    }

    const double* rates(int k) const override { return terms_[k].rate; }

private:
    int order_;
    Chain<N> chain_;
    Term<N> terms_[Chain<N>::max_orders + 2];
};

}  // namespace

template <>
LaneRecurrence* make_lane_recurrence<compiled_width>(const Pendulum<double>& p, int order) {
    if (p.links() == 2) return new LaneRecurrenceOf<2>(p, order);
    return new LaneRecurrenceOf<3>(p, order);
}

}  // namespace doppel
