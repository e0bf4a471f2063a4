#include "analysis/enclosure.hpp"

#include "analysis/ball_series.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>

namespace doppel {
namespace {

/// The numbers of a system, enclosed.
template <class B>
struct BallSystem {
    struct Droplet {
        B strength, x, y;  // G M
    };
    B m1, m2, l1, l2, g;
    std::vector<Droplet> droplets;

    explicit BallSystem(const DecimalPendulum& p)
        : m1(of(p.mass[0])), m2(of(p.mass[1])), l1(of(p.length[0])), l2(of(p.length[1])), g(of(p.gravity)) {
        for (const auto& d : p.droplets)
            droplets.push_back({of(d.constant) * of(d.mass), of(d.place[0]), of(d.place[1])});
    }
    static B of(const std::string& text) { return ball_of_decimal<B>(text); }
};

template <class Scalar>
Ball<Scalar> square_root(const Ball<Scalar>& x) {
    return sqrt(x);
}
TangentBall square_root(const TangentBall& x) {
    const auto root = sqrt(x.value);
    return {root, x.tangent / DoubleBall(DoubleBall(2) * root)};
}

/// The series of two links; the sines and cosines of the angles are states, too.
///     (m1 + m2 sin²D) l1 θ1″ = P1 − m2 cosD P2 ,   l2 θ2″ = P2 − cosD l1 θ1″ ,   D = θ1 − θ2
///     P1 = −m2 l2 sinD ω2² − (m1 + m2) g sinθ1 + F·t1 ,   P2 = l1 sinD ω1² − g sinθ2 + F2·t2 / m2
/// with the droplets' forces F = F1 + F2 and the directions t = (cosθ, sinθ).
template <class Number, class B>
class PendulumSeries {
public:
    /// `coefficient`: 1
    PendulumSeries(const DecimalPendulum& decimals, int order, double coefficient) : series(order), system_(decimals) {
        const auto n = [](const B& x) { return Number(x); };
        for (auto& node : state) node = series.state(Number(0));
        for (auto& node : turn_) node = series.state(Number(0));
        const auto [s1, c1, s2, c2] = turn_;
        const int w1 = state[2], w2 = state[3];
        const auto& [m1, m2, l1, l2, g, droplets] = system_;
        const int sin_d = series.difference(series.product(s1, c2), series.product(c1, s2));
        const int cos_d = series.sum(series.product(c1, c2), series.product(s1, s2));
        int p1 = series.sum(series.scaled(n(-(m2 * l2)), series.product(sin_d, series.product(w2, w2))),
                            series.scaled(n(-((m1 + m2) * g)), s1));
        int p2 =
            series.sum(series.scaled(n(l1), series.product(sin_d, series.product(w1, w1))), series.scaled(n(-g), s2));
        for (const auto& droplet : droplets) attract(droplet, p1, p2);
        const int mass = series.shifted(n(m1), series.scaled(n(m2), series.product(sin_d, sin_d)));
        const int b1 = series.product(series.inverse(mass, m1.least()),
                                      series.difference(p1, series.scaled(n(m2), series.product(cos_d, p2))));
        const int b2 = series.difference(p2, series.product(cos_d, b1));
        series.set_rate(state[0], w1);
        series.set_rate(state[1], w2);
        series.set_rate(w1, series.scaled(n(B(Scalar(coefficient)) / l1), b1));
        series.set_rate(w2, series.scaled(n(B(1) / l2), b2));
        series.set_rate(s1, series.product(c1, w1));
        series.set_rate(c1, series.scaled(Number(-1), series.product(s1, w1)));
        series.set_rate(s2, series.product(c2, w2));
        series.set_rate(c2, series.scaled(Number(-1), series.product(s2, w2)));
    }

    void start_at(const std::array<Number, 4>& y) {
        for (std::size_t i = 0; i < 4; ++i) series.set_start(state[i], y[i]);
        const SinCos<Number> one(y[0]), two(y[1]);
        const std::array turns{one.sin, one.cos, two.sin, two.cos};
        for (std::size_t i = 0; i < 4; ++i) series.set_start(turn_[i], turns[i]);
        for (const auto& cube : cubes_) {
            const Number x = place(cube.on_second, turns[0], turns[2]) - Number(cube.droplet.x);
            const Number y_ = -place(cube.on_second, turns[1], turns[3]) - Number(cube.droplet.y);
            const Number r2 = x * x + y_ * y_;
            series.set_start(cube.node, Number(1) / (r2 * square_root(r2)));
        }
    }

    BallSeries<Number> series;
    std::array<int, 4> state{};

private:
    using Scalar = std::remove_cvref_t<decltype(B().center)>;
    struct Cube {
        int node;  // 1/r³
        bool on_second;
        typename BallSystem<B>::Droplet droplet;
    };

    Number place(bool on_second, const Number& a, const Number& b) const {
        const Number first = Number(system_.l1) * a;
        return on_second ? first + Number(system_.l2) * b : first;
    }
    int place_node(bool on_second, int a, int b) {
        const int first = series.scaled(Number(system_.l1), a);
        return on_second ? series.sum(first, series.scaled(Number(system_.l2), b)) : first;
    }
    /// Adds a droplet's forces to P1 and P2: −G M m r/r³ on each mass, where (r⁻³)′ = −3 r⁻³ (r·r′)/r².
    void attract(const typename BallSystem<B>::Droplet& droplet, int& p1, int& p2) {
        const auto [s1, c1, s2, c2] = turn_;
        const int w1 = state[2], w2 = state[3];
        std::array<int, 2> force_x{}, force_y{};
        for (const bool second : {false, true}) {
            const int x = series.shifted(Number(-droplet.x), place_node(second, s1, s2));
            const int y = series.shifted(Number(-droplet.y), series.scaled(Number(-1), place_node(second, c1, c2)));
            const int vx = place_node(second, series.product(c1, w1), series.product(c2, w2));
            const int vy = place_node(second, series.product(s1, w1), series.product(s2, w2));
            const int r2 = series.sum(series.product(x, x), series.product(y, y));
            const int cube = series.state(Number(0));
            const int approach = series.sum(series.product(x, vx), series.product(y, vy));
            series.set_rate(
                cube, series.scaled(Number(-3), series.product(series.product(cube, series.inverse(r2, 0)), approach)));
            cubes_.push_back({cube, second, droplet});
            const int pull = series.scaled(Number(-droplet.strength), cube);
            force_x[second] = series.product(pull, x);
            force_y[second] = series.product(pull, y);
        }
        const auto weighted = [&](const std::array<int, 2>& f) {
            return series.sum(series.scaled(Number(system_.m1), f[0]), series.scaled(Number(system_.m2), f[1]));
        };
        p1 = series.sum(p1, series.sum(series.product(weighted(force_x), c1), series.product(weighted(force_y), s1)));
        p2 = series.sum(p2, series.sum(series.product(force_x[1], c2), series.product(force_y[1], s2)));
    }

    BallSystem<B> system_;
    std::array<int, 4> turn_{};  // s1, c1, s2, c2
    std::vector<Cube> cubes_;
};

using Matrix = std::array<std::array<double, 4>, 4>;
using Box = std::array<double, 4>;  // radii

/// e ∈ Σ G_j b_j with boxes b_j = [−1, 1]⁴, and its image under matrices.
class Zonotope {
public:
    /// At least |e| by components.
    Box hull() const { return hull_of(Matrix{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}); }
    /// At least |M e|, up to rounding of M G_j, which is `rounding`.
    Box hull_of(const Matrix& m) const {
        Box sum{};
        for (const auto& g : boxes_) {
            const auto image = product(m, g);
            for (std::size_t i = 0; i < 4; ++i)
                for (const double x : image[i]) sum[i] += std::abs(x);
        }
        const double more = 1 + 0x1p-50 * (8 + static_cast<double>(boxes_.size()));
        for (auto& x : sum) x = x == 0 ? 0 : widened(x * more);
        return sum;
    }
    void map(const Matrix& m) {
        for (auto& g : boxes_) g = product(m, g);
    }
    void add(const Box& box) {
        Matrix g{};
        for (std::size_t i = 0; i < 4; ++i) g[i][i] = box[i];
        boxes_.push_back(g);
    }
    void keep_last() { boxes_.erase(boxes_.begin(), boxes_.end() - 1); }

private:
    static Matrix product(const Matrix& m, const Matrix& g) {
        Matrix all{};
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t k = 0; k < 4; ++k)
                for (std::size_t j = 0; j < 4; ++j) all[i][j] += m[i][k] * g[k][j];
        return all;
    }
    std::vector<Matrix> boxes_;
};

/// The order of the series.
template <class Scalar>
constexpr int order_of = 24;
template <>
constexpr int order_of<Quad> = 38;
template <>
constexpr int order_of<Wide> = 70;

/// Steps from sample to sample. The step's length is counted in equal parts of the interval of samples.
template <class Scalar>
class Enclosure {
public:
    using B = Ball<Scalar>;

    Enclosure(const DecimalPendulum& system, const EnclosedState<Scalar>& start, const EnclosureSpec& spec)
        : spec_(spec),
          middle_(system, order_of<Scalar>, spec.counted.coefficient),
          tangent_(system, tangent_order, spec.counted.coefficient) {
        Box box{};
        for (std::size_t i = 0; i < 4; ++i) {
            center_[i] = start[i].center;
            box[i] = spec.counted.start * start[i].radius;
        }
        set_.add(box);
        const BallSystem<DoubleBall> numbers(system);
        const double shortest = std::min(numbers.l1.center, numbers.l2.center);
        constexpr double of_period = 16384;
        const double part = std::sqrt(shortest / (std::abs(numbers.g.center) + shortest)) / of_period;
        parts_ = static_cast<long>(std::max(1.0, std::ceil(spec.interval.value() / part)));
    }

    /// The sets at the samples that the next step passes; nothing if no step can be proved.
    std::optional<std::vector<EnclosedState<Scalar>>> step() {
        const Box hull = set_.hull();
        start_step(hull);
        if (!find_step()) return std::nullopt;
        std::vector<EnclosedState<Scalar>> passed;
        for (long n = parts_ - done_ % parts_; n < length_; n += parts_) passed.push_back(sample(hull, n));
        advance(hull);
        if (done_ % parts_ == 0) passed.push_back(here());
        return passed;
    }
    EnclosedState<Scalar> here() const {
        const Box hull = set_.hull();
        EnclosedState<Scalar> state;
        for (std::size_t i = 0; i < 4; ++i) state[i] = {center_[i], hull[i]};
        return state;
    }

private:
    static constexpr int tangent_order = 16;

    /// The length of so many parts, s.
    template <class T>
    T seconds(long parts) const {
        const auto number = [](std::int64_t n) { return ball_of_decimal<T>(std::to_string(n)); };
        return number(parts) * number(spec_.interval.numerator) / (number(spec_.interval.denominator) * number(parts_));
    }

    void start_step(const Box& hull) {
        std::array<B, 4> at;
        std::array<TangentBall, 4> around;
        for (std::size_t i = 0; i < 4; ++i) {
            at[i] = B(center_[i]);
            around[i] = TangentBall::variable(DoubleBall(at[i]).widened_by(hull[i]), static_cast<Eigen::Index>(i));
        }
        middle_.start_at(at);
        tangent_.start_at(around);
    }
    /// Finds the length of the step, and proves that the motion exists that long.
    bool find_step() {
        const long left = spec_.samples * parts_ - done_;
        for (length_ = std::min(next_length_, left); length_ > 0; length_ = length_ * 3 / 4) {
            middle_.series.expand(seconds<B>(length_));
            const double longest = static_cast<double>(length_) * longer();
            next_length_ = static_cast<long>(std::clamp(longest, 1.0, 4.0 * static_cast<double>(length_)));
            if (longest < static_cast<double>(length_)) {
                length_ = static_cast<long>(longest);
                if (length_ == 0) return false;
                middle_.series.expand(seconds<B>(length_));
            }
            tangent_.series.expand(TangentBall(seconds<DoubleBall>(length_)));
            if (middle_.series.find_remainders() && tangent_.series.find_remainders()) return true;
        }
        return false;
    }
    /// By how much the step may be longer, or must be shorter if it is < 1: the last coefficients, several because
    /// whole classes of them vanish at rest, are to be below rounding.
    double longer() const {
        const auto& series = middle_.series;
        double factor = 4;
        for (const int node : middle_.state) {
            const double amount = std::max({1.0, series.size(node, 0), series.size(node, 1)});
            for (int k = series.order() - 3; k <= series.order(); ++k)
                factor =
                    std::min(factor, std::pow(spec_.tolerance * B::roundoff * amount / series.size(node, k), 1.0 / k));
        }
        return factor;
    }

    struct Linear {
        Matrix middle{}, spread{};  // J = middle ± spread
    };
    Linear jacobian(const TangentBall& tau) const {
        Linear all;
        for (std::size_t i = 0; i < 4; ++i) {
            const auto value = tangent_.series.value(tangent_.state[i], tau);
            const auto& rest = tangent_.series.remainder(tangent_.state[i]);
            for (std::size_t j = 0; j < 4; ++j) {
                const auto& entry = value.tangent[static_cast<Eigen::Index>(j)];
                all.middle[i][j] = entry.center;
                all.spread[i][j] = spec_.counted.nonlinearity *
                                   widened(entry.radius + rest.tangent[static_cast<Eigen::Index>(j)].value);
            }
        }
        return all;
    }
    /// What mapping by the middle of a Jacobian leaves out, with its rounding.
    Box missing(const Linear& j, const Box& hull) const {
        Box all{};
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t k = 0; k < 4; ++k)
                all[i] = widened(all[i] + (j.spread[i][k] + 0x1p-49 * std::abs(j.middle[i][k])) * hull[k]);
        return all;
    }
    B moved(std::size_t i, const B& tau) const {
        const int node = middle_.state[i];
        return middle_.series.value(node, tau).widened_by(spec_.counted.truncation *
                                                          middle_.series.remainder(node).value);
    }
    /// The set within the step, so many units after its start.
    EnclosedState<Scalar> sample(const Box& hull, long units) const {
        const B tau = seconds<B>(units) / seconds<B>(length_);
        const auto j = jacobian(TangentBall(DoubleBall(tau)));
        const Box spread = set_.hull_of(j.middle), more = missing(j, hull);
        EnclosedState<Scalar> state;
        for (std::size_t i = 0; i < 4; ++i) state[i] = moved(i, tau).widened_by(widened(spread[i] + more[i]));
        return state;
    }
    void advance(const Box& hull) {
        const auto j = jacobian(TangentBall(1));
        Box box = missing(j, hull);
        for (std::size_t i = 0; i < 4; ++i) {
            const B end = moved(i, B(1));
            center_[i] = end.center;
            box[i] = widened(box[i] + spec_.counted.rounding * end.radius);
        }
        done_ += length_;
        set_.map(j.middle);
        set_.add(box);
        if (spec_.counted.earlier_boxes == 0) set_.keep_last();
    }

    EnclosureSpec spec_;
    PendulumSeries<B, B> middle_;
    PendulumSeries<TangentBall, DoubleBall> tangent_;
    std::array<Scalar, 4> center_;
    Zonotope set_;
    long parts_ = 1, length_ = 0, next_length_ = 256, done_ = 0;  // units a sample; of the step; since the start
};

}  // namespace

template <class Scalar>
EnclosedState<Scalar> enclosed_start(const DecimalPendulum& system) {
    EnclosedState<Scalar> start;
    for (std::size_t i = 0; i < 4; ++i) {
        const auto& degrees = i < 2 ? system.angle_deg[i] : system.omega_deg_per_s[i - 2];
        const auto number = ball_of_decimal<Ball<Wide>>(degrees);
        if (number.radius > 0) start[i] = Ball<Scalar>(number * pi_ball<Ball<Wide>>() / Ball<Wide>(180));
    }
    return start;
}

template <class Scalar>
std::vector<EnclosedState<Scalar>> enclosures(const DecimalPendulum& system, const EnclosedState<Scalar>& start,
                                              const EnclosureSpec& spec, const std::function<void(long)>& watch) {
    Enclosure<Scalar> enclosure(system, start, spec);
    std::vector<EnclosedState<Scalar>> all{enclosure.here()};
    const auto is_wide = [&](const EnclosedState<Scalar>& state) {
        return !std::all_of(state.begin(), state.end(), [&](const auto& x) { return x.radius <= spec.largest_radius; });
    };
    while (static_cast<long>(all.size()) <= spec.samples) {
        watch(static_cast<long>(all.size()));
        const auto passed = enclosure.step();
        if (!passed) break;
        for (const auto& state : *passed) {
            if (is_wide(state)) return all;
            all.push_back(state);
        }
    }
    return all;
}

#define DOPPEL_ENCLOSURES(Scalar)                                                                                \
    template EnclosedState<Scalar> enclosed_start<Scalar>(const DecimalPendulum&);                               \
    template std::vector<EnclosedState<Scalar>> enclosures(const DecimalPendulum&, const EnclosedState<Scalar>&, \
                                                           const EnclosureSpec&, const std::function<void(long)>&);
DOPPEL_ENCLOSURES(double)
DOPPEL_ENCLOSURES(Quad)
DOPPEL_ENCLOSURES(Wide)
#undef DOPPEL_ENCLOSURES

}  // namespace doppel
