#include "analysis/enclosure.hpp"

#include "analysis/ball_series.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace doppel {
namespace {

template <class Term>
struct Turn {
    Term sin, cos, sin_rate, cos_rate;
};

/// The series of two links. Sines, cosines and inverses are states, too, so that all right-hand sides are polynomials.
///     (m1 + m2 sin²D) l1 θ1″ = P1 − m2 cosD P2 ,   l2 θ2″ = P2 − cosD l1 θ1″ ,   D = θ1 − θ2
///     P1 = −m2 l2 sinD ω2² − (m1 + m2) g sinθ1 + F·t1 ,   P2 = l1 sinD ω1² − g sinθ2 + F2·t2 / m2
/// with the droplets' forces F = F1 + F2 and the directions t = (cosθ, sinθ).
template <class Number, class B>
class PendulumSeries : public BallSeries<Number> {
public:
    using Term = typename BallSeries<Number>::Term;

    /// The nodes 0 … 3 are θ1, θ2, ω1 and ω2. `coefficient`: 1
    PendulumSeries(const EnclosedSystem& system, int order, double coefficient) : BallSeries<Number>(order) {
        const auto chain = system.chain.template cast<B>();
        const B &m1 = chain.mass[0], &m2 = chain.mass[1], &l1 = chain.length[0], &l2 = chain.length[1];
        const Term angle1 = this->state(), angle2 = this->state(), w1 = this->state(), w2 = this->state();
        angle1.set_rate(w1);
        angle2.set_rate(w2);
        const auto one = turn(angle1, w1), two = turn(angle2, w2), between = turn(angle1 - angle2, w1 - w2);

        // 1/a, where (1/a)′ = −a′/a²
        const Term mass = m1 + m2 * (between.sin * between.sin);
        const Term inverse = this->state([mass] { return Number(1) / mass.start(); });
        inverse.set_rate((B(-2) * m2) * ((inverse * inverse) * (between.sin * between.sin_rate)));

        Term p1 = (-(m2 * l2)) * (between.sin * (w2 * w2)) + (-((m1 + m2) * chain.gravity)) * one.sin;
        Term p2 = l1 * (between.sin * (w1 * w1)) + (-chain.gravity) * two.sin;
        for (const auto& droplet : Cast<B>()(system.droplets)) {
            const Term x = l1 * one.sin, y = (-l1) * one.cos, vx = l1 * one.sin_rate, vy = (-l1) * one.cos_rate;
            const auto first = attraction(droplet, x, y, vx, vy);
            const auto second = attraction(droplet, x + l2 * two.sin, y + (-l2) * two.cos, vx + l2 * two.sin_rate,
                                           vy + (-l2) * two.cos_rate);
            const Term fx = m1 * first[0] + m2 * second[0], fy = m1 * first[1] + m2 * second[1];
            p1 = p1 + (fx * one.cos + fy * one.sin);
            p2 = p2 + (second[0] * two.cos + second[1] * two.sin);
        }
        const Term b1 = inverse * (p1 - m2 * (between.cos * p2)), b2 = p2 - between.cos * b1;
        w1.set_rate((B(decltype(B::center)(coefficient)) / l1) * b1);
        w2.set_rate((B(1) / l2) * b2);
    }

private:
    Turn<Term> turn(const Term& angle, const Term& rate) {
        const Term sin = this->state([angle] { return SinCos<Number>(angle.start()).sin; });
        const Term cos = this->state([angle] { return SinCos<Number>(angle.start()).cos; });
        const Turn<Term> all{sin, cos, cos * rate, B(-1) * (sin * rate)};
        sin.set_rate(all.sin_rate);
        cos.set_rate(all.cos_rate);
        return all;
    }
    /// −G M r/|r|³ at (x, y), where (1/|r|)′ = −(r·r′)/|r|³
    std::array<Term, 2> attraction(const Droplet<B>& droplet, const Term& x, const Term& y, const Term& vx,
                                   const Term& vy) {
        const Term rx = (-droplet.place[0]) + x, ry = (-droplet.place[1]) + y, square = rx * rx + ry * ry;
        const Term inverse = this->state([square] { return Number(1) / sqrt(square.start()); });
        const Term cube = inverse * (inverse * inverse);
        inverse.set_rate(B(-1) * (cube * (rx * vx + ry * vy)));
        const Term pull = (-(droplet.constant * droplet.mass)) * cube;
        return {pull * rx, pull * ry};
    }
};

/// The order of the series.
template <class Scalar>
constexpr int order_of = 24;
template <>
constexpr int order_of<Quad> = 38;
template <>
constexpr int order_of<Wide> = 70;

using Box = Eigen::Array4d;  // radii

/// All states center + Σ_j b_j (column j of `edges`), |b_j| ≤ 1.
template <class Scalar>
struct Zonotope {
    std::array<Scalar, 4> center;
    Eigen::Matrix<double, 4, Eigen::Dynamic> edges;

    Box hull() const {
        const double more = 1 + 0x1p-51 * (16 + static_cast<double>(edges.cols()));
        const Box sum = edges.array().abs().rowwise().sum();
        return sum.unaryExpr([&](double x) { return x == 0 ? 0 : widened(x * more); });
    }
    EnclosedState<Scalar> state() const {
        const Box box = hull();
        EnclosedState<Scalar> all;
        for (std::size_t i = 0; i < 4; ++i) all[i] = {center[i], box[static_cast<Eigen::Index>(i)]};
        return all;
    }
};

/// Steps from sample to sample. The step's length is counted in equal parts of the interval of samples.
template <class Scalar>
class Enclosure {
public:
    using B = Ball<Scalar>;

    Enclosure(const EnclosedSystem& system, const EnclosureSpec& spec)
        : spec_(spec),
          middle_(system, order_of<Scalar>, spec.counted.coefficient),
          tangent_(system, tangent_order, spec.counted.coefficient) {
        const auto chain = system.chain.template cast<B>();
        const std::array start{chain.angle[0], chain.angle[1], chain.rate[0], chain.rate[1]};
        set_.edges.setZero(4, 4);
        for (Eigen::Index i = 0; i < 4; ++i) {
            const auto& x = start[static_cast<std::size_t>(i)];
            set_.center[static_cast<std::size_t>(i)] = x.center;
            set_.edges(i, i) = spec.counted.start * x.radius;
        }
        const double shortest = std::min(chain.length[0].high(), chain.length[1].high());
        constexpr double of_period = 16384;
        const double part = std::sqrt(shortest / (std::abs(chain.gravity.high()) + shortest)) / of_period;
        parts_ = static_cast<long>(std::max(1.0, std::ceil(spec.interval.value() / part)));
    }

    EnclosedState<Scalar> here() const { return set_.state(); }
    /// The sets at the samples that the next step passes; nothing if no step can be proved.
    std::optional<std::vector<EnclosedState<Scalar>>> step() {
        const Box hull = set_.hull();
        for (std::size_t i = 0; i < 4; ++i) {
            const B at(set_.center[i]);
            const auto axis = static_cast<Eigen::Index>(i);
            middle_.set_start(i, at);
            tangent_.set_start(i, TangentBall::variable(DoubleBall(at).widened_by(hull[axis]), axis));
        }
        if (!find_step()) return std::nullopt;
        std::vector<EnclosedState<Scalar>> passed;
        for (long n = parts_ - done_ % parts_; n <= length_; n += parts_) passed.push_back(image(hull, n).state());
        set_ = image(hull, length_);
        done_ += length_;
        return passed;
    }

private:
    static constexpr int tangent_order = 16;

    static Ball<Wide> number(std::int64_t n) { return Wide(n); }
    /// The length of so many parts, s.
    Ball<Wide> seconds(long parts) const {
        return number(parts) * number(spec_.interval.numerator) / (number(spec_.interval.denominator) * number(parts_));
    }

    /// Finds the length of the step, and proves that the motion exists that long.
    bool find_step() {
        length_ = std::min(next_length_, spec_.samples * parts_ - done_);
        while (length_ > 0) {
            const auto h = seconds(length_);
            middle_.expand(B(h));
            const double longest = static_cast<double>(length_) * longer();
            next_length_ = static_cast<long>(std::clamp(longest, 1.0, 4.0 * static_cast<double>(length_)));
            if (longest + 1 < static_cast<double>(length_)) {
                length_ = static_cast<long>(longest);
                continue;
            }
            tangent_.expand(TangentBall(DoubleBall(h)));
            if (middle_.find_remainders() && tangent_.find_remainders()) return true;
            length_ = length_ * 3 / 4;
        }
        return false;
    }
    /// By how much the step may be longer, or must be shorter if it is < 1: the last coefficients, several because
    /// whole classes of them vanish at rest, are to be below rounding.
    double longer() const {
        constexpr int order = order_of<Scalar>;
        double factor = 4;
        for (std::size_t i = 0; i < 4; ++i) {
            const auto size = [&](int k) { return middle_.coefficient(i, k).size(); };
            const double least = spec_.tolerance * B::roundoff * std::max({1.0, size(0), size(1)});
            for (int k = order - 3; k <= order; ++k) factor = std::min(factor, std::pow(least / size(k), 1.0 / k));
        }
        return factor;
    }

    /// The set so many parts after the start of the step, where its hull is `hull`.
    Zonotope<Scalar> image(const Box& hull, long parts) const {
        const auto tau = number(parts) / number(length_);
        Zonotope<Scalar> all;
        Eigen::Matrix4d middle, spread;  // J = middle ± spread
        Box rounding;
        for (std::size_t i = 0; i < 4; ++i) {
            const auto row = static_cast<Eigen::Index>(i);
            const auto tangent = tangent_.value(i, TangentBall(DoubleBall(tau))).tangent;
            for (Eigen::Index j = 0; j < 4; ++j) {
                middle(row, j) = tangent[j].center;
                spread(row, j) = spec_.counted.nonlinearity * tangent[j].radius;
            }
            const B end = middle_.value(i, B(tau), spec_.counted.truncation != 0);
            all.center[i] = end.center;
            rounding[row] = spec_.counted.rounding * end.radius;
        }
        // what mapping by the middle of the Jacobian leaves out, with its rounding
        const Box missing = ((spread + 0x1p-49 * middle.cwiseAbs()) * hull.matrix()).array();
        const Box box = (missing.unaryExpr(&widened) + rounding).unaryExpr(&widened);
        const Eigen::Index edges = spec_.counted.earlier_boxes == 0 ? 0 : set_.edges.cols();
        all.edges.resize(4, edges + 4);
        all.edges << middle * set_.edges.leftCols(edges), Eigen::Matrix4d(box.matrix().asDiagonal());
        return all;
    }

    EnclosureSpec spec_;
    PendulumSeries<B, B> middle_;
    PendulumSeries<TangentBall, DoubleBall> tangent_;
    Zonotope<Scalar> set_;
    long parts_ = 1, length_ = 0, next_length_ = 256, done_ = 0;  // of a sample; of the step; since the start
};

}  // namespace

template <class Scalar>
std::vector<EnclosedState<Scalar>> enclosures(const EnclosedSystem& system, const EnclosureSpec& spec,
                                              const std::function<void(long)>& watch) {
    Enclosure<Scalar> enclosure(system, spec);
    std::vector<EnclosedState<Scalar>> all{enclosure.here()};
    while (static_cast<long>(all.size()) <= spec.samples) {
        watch(static_cast<long>(all.size()));
        const auto passed = enclosure.step();
        if (!passed) break;
        for (const auto& state : *passed) {
            for (const auto& x : state)
                if (!(x.radius <= spec.largest_radius)) return all;
            all.push_back(state);
        }
    }
    return all;
}

template std::vector<EnclosedState<double>> enclosures(const EnclosedSystem&, const EnclosureSpec&,
                                                       const std::function<void(long)>&);
template std::vector<EnclosedState<Quad>> enclosures(const EnclosedSystem&, const EnclosureSpec&,
                                                     const std::function<void(long)>&);
template std::vector<EnclosedState<Wide>> enclosures(const EnclosedSystem&, const EnclosureSpec&,
                                                     const std::function<void(long)>&);

}  // namespace doppel
