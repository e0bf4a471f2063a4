#include "analysis/enclosure.hpp"

#include "analysis/ball_series.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace doppel {
namespace {

/// Begins the series of two links; θ1, θ2, ω1, ω2 are its nodes 0 … 3. Sines, cosines and inverses are states, too, so
/// that all right-hand sides are polynomials.
///     (m1 + m2 sin²D) l1 θ1″ = P1 − m2 cosD P2 ,   l2 θ2″ = P2 − cosD l1 θ1″ ,   D = θ1 − θ2
///     P1 = −m2 l2 sinD ω2² − (m1 + m2) g sinθ1 + F·t1 ,   P2 = l1 sinD ω1² − g sinθ2 + F2·t2 / m2
/// with the droplets' forces F = F1 + F2 and the directions t = (cosθ, sinθ). The links are l (sinθ, −cosθ).
template <class Number>
void begin(BallSeries<Number>& series, const LinksAndDroplets<Number>& system, const State<Number, 4>& start) {
    using Quantity = Taped<Number>;
    using Vector = Place<Quantity>;
    const auto turning = [&](const Quantity& angle, const Quantity& rate) -> Vector {
        const SinCos<Number> at(angle.value);
        const Quantity cos = series.state(at.cos), sin = series.state(at.sin);
        series.set_rate(cos, -(sin * rate));
        series.set_rate(sin, cos * rate);
        return {cos, sin};
    };
    const auto link = [](const Quantity& length, const Vector& t) -> Vector { return {length * t[1], -length * t[0]}; };
    // −G M r/|r|³, where (1/|r|)′ = −(r·r′)/|r|³
    const auto attraction = [&](const Droplet<Number>& droplet, const Vector& place, const Vector& velocity) -> Vector {
        const Vector r = place - droplet.place.template cast<Quantity>();
        const Quantity inverse = series.state(Number(1) / sqrt(r.dot(r).value)), cube = inverse * inverse * inverse;
        series.set_rate(inverse, -(cube * r.dot(velocity)));
        return Quantity(-(droplet.constant * droplet.mass)) * cube * r;
    };
    const auto& chain = system.chain;
    const Quantity m1 = chain.mass[0], m2 = chain.mass[1], l1 = chain.length[0], l2 = chain.length[1];
    const Quantity g = chain.gravity;
    series.clear();
    const Quantity angle1 = series.state(start[0]), angle2 = series.state(start[1]);
    const Quantity w1 = series.state(start[2]), w2 = series.state(start[3]);
    series.set_rate(angle1, w1);
    series.set_rate(angle2, w2);
    const Vector t1 = turning(angle1, w1), t2 = turning(angle2, w2), between = turning(angle1 - angle2, w1 - w2);
    const Quantity &cos_d = between[0], &sin_d = between[1];

    // 1/a, where (1/a)′ = −a′/a²
    const Quantity inverse = series.state(Number(1) / (m1 + m2 * (sin_d * sin_d)).value);
    series.set_rate(inverse, Quantity(-2) * m2 * (inverse * inverse * (sin_d * (cos_d * (w1 - w2)))));

    Quantity p1 = -(m2 * l2) * (sin_d * (w2 * w2)) - (m1 + m2) * g * t1[1];
    Quantity p2 = l1 * (sin_d * (w1 * w1)) - g * t2[1];
    for (const auto& droplet : system.droplets) {
        const Vector place = link(l1, t1), velocity = l1 * (w1 * t1);
        const Vector first = attraction(droplet, place, velocity);
        const Vector second = attraction(droplet, place + link(l2, t2), velocity + l2 * (w2 * t2));
        p1 += (m1 * first + m2 * second).dot(t1);
        p2 += second.dot(t2);
    }
    const Quantity b1 = inverse * (p1 - m2 * (cos_d * p2));
    series.set_rate(w1, Quantity(1) / l1 * b1);
    series.set_rate(w2, Quantity(1) / l2 * (p2 - cos_d * b1));
}

/// The order of the series: 24, 38 or 70.
template <class Scalar>
constexpr int order_of = 12 + (5 * std::numeric_limits<Scalar>::digits + 11) / 22;
static_assert(order_of<double> == 24 && order_of<Quad> == 38 && order_of<Wide> == 70);

using Box = Eigen::Array4d;  // radii

/// All states center + Σ_j b_j (column j of `edges`), |b_j| ≤ 1.
template <class Scalar>
struct Zonotope {
    EnclosedState<Scalar> center;  // of radius 0
    Eigen::Matrix<double, 4, Eigen::Dynamic> edges;

    Box hull() const {
        const double more = 1 + 0x1p-51 * (16 + static_cast<double>(edges.cols()));
        const Box sum = edges.array().abs().rowwise().sum();
        return sum.unaryExpr([&](double x) { return x == 0 ? 0 : widened(x * more); });
    }
    EnclosedState<Scalar> state() const {
        const Box box = hull();
        auto all = center;
        for (int i = 0; i < 4; ++i) all[i].radius = box[i];
        return all;
    }
    /// Replaces the smaller half of the edges by a box around them.
    void reduce() {
        if (!edges.allFinite()) return;
        const Eigen::RowVectorXd size = edges.cwiseAbs().colwise().sum();
        std::vector<Eigen::Index> larger(static_cast<std::size_t>(size.size()));
        std::iota(larger.begin(), larger.end(), 0);
        std::ranges::stable_sort(larger, std::greater(), [&](Eigen::Index i) { return size[i]; });
        const std::vector smaller(larger.begin() + size.size() / 2, larger.end());
        larger.resize(larger.size() - smaller.size());
        const Box box = Zonotope{center, edges(Eigen::all, smaller)}.hull();
        Eigen::Matrix<double, 4, Eigen::Dynamic> fewer(4, size.size() / 2 + 4);
        fewer << edges(Eigen::all, larger), Eigen::Matrix4d(box.matrix().asDiagonal());
        edges.swap(fewer);
    }
};

/// Steps from sample to sample. The step's length is counted in equal parts of the interval of samples.
template <class Scalar>
class Enclosure {
public:
    using B = Ball<Scalar>;

    Enclosure(const EnclosedSystem& system, const EnclosureSpec& spec)
        : spec_(spec), system_(Cast<B>()(system)), in_double_(Cast<TangentBall>()(Cast<DoubleBall>()(system))) {
        set_.center = released_in_angles<B, 2>(system_.chain);
        set_.edges.setZero(4, 4);
        for (int i = 0; i < 4; ++i) std::swap(set_.edges(i, i), set_.center[i].radius);
        const auto& chain = system_.chain;
        const double shortest = std::min(chain.length[0].high(), chain.length[1].high());
        constexpr double of_period = 16384;
        const double longest = std::sqrt(shortest / (std::abs(chain.gravity.high()) + shortest)) / of_period;
        divide(static_cast<long>(std::max(1.0, std::ceil(spec.interval.value() / longest))));
    }

    /// As enclosures().
    std::vector<EnclosedState<Scalar>> samples(const Watch& watch) {
        std::vector<EnclosedState<Scalar>> all{set_.state()};
        while (static_cast<long>(all.size()) <= spec_.samples) {
            if (!find_step([&] { watch(static_cast<long>(all.size())); })) break;
            for (long n = parts_ - done_ % parts_; n <= length_; n += parts_) {
                const auto sample = image(n);
                if (!(sample.hull() <= spec_.largest_radius).all()) return all;
                all.push_back(sample.state());
            }
            set_ = image(length_);
            if (set_.edges.cols() > spec_.most_edges) set_.reduce();
            done_ += length_;
        }
        return all;
    }

private:
    static Ball<Wide> number(std::int64_t n) { return Wide(n); }
    /// Divides each part. False if there would be too many.
    bool divide(long divisor) {
        constexpr long most = std::numeric_limits<long>::max() / 8;
        if (divisor > most / parts_ / std::max(spec_.samples, 1L)) return false;
        parts_ *= divisor;
        done_ *= divisor;
        part_ = number(spec_.interval.numerator) / (number(spec_.interval.denominator) * number(parts_));
        return true;
    }
    /// Finds the length of the step, and proves that the motion exists that long.
    bool find_step(const std::function<void()>& watch) {
        const auto now = set_.state();
        State<TangentBall, 4> around;
        for (int i = 0; i < 4; ++i) around[i] = TangentBall::variable(DoubleBall(now[i]), i);
        begin(middle_, system_, set_.center);
        begin(tangent_, in_double_, around);
        length_ = std::min(next_length_, spec_.samples * parts_ - done_);
        while (length_ > 0) {
            if (steps_++ == spec_.most_steps) return false;
            watch();
            const auto h = number(length_) * part_;
            middle_.expand(B(h));
            const double longest = static_cast<double>(length_) * longer();
            next_length_ = static_cast<long>(std::clamp(longest, 1.0, 4.0 * static_cast<double>(length_)));
            if (longest + 1 < static_cast<double>(length_)) {
                length_ = std::max(1L, static_cast<long>(longest));
                continue;
            }
            if (longest < 1 && !std::exchange(is_divided_, true) && divide(4096)) {  // much faster than small swings
                length_ = first_length;
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
        for (int i = 0; i < 4; ++i) {
            const auto size = [&](int k) { return middle_.coefficient(i, k).size(); };
            const double least = spec_.tolerance * B::roundoff * std::max({1.0, size(0), size(1)});
            for (int k = order - 3; k <= order; ++k) factor = std::min(factor, std::pow(least / size(k), 1.0 / k));
        }
        return factor;
    }

    /// The set so many parts after the start of the step.
    Zonotope<Scalar> image(long parts) const {
        const auto tau = number(parts) / number(length_);
        Zonotope<Scalar> all;
        Eigen::Matrix4d middle, spread;  // J = middle ± spread
        Box rounding;
        for (int i = 0; i < 4; ++i) {
            const auto tangent = tangent_.value(i, TangentBall(DoubleBall(tau))).tangent;
            for (int j = 0; j < 4; ++j) {
                middle(i, j) = tangent[j].center;
                spread(i, j) = spec_.counted.nonlinearity * tangent[j].radius;
            }
            const B end = middle_.value(i, B(tau), spec_.counted.truncation != 0);
            all.center[i] = end.center;
            rounding[i] = spec_.counted.rounding * end.radius;
        }
        // what mapping by the middle of the Jacobian leaves out, with its rounding
        const Box missing = ((spread + 0x1p-49 * middle.cwiseAbs()) * set_.hull().matrix()).array();
        const Box box = (missing.unaryExpr(&widened) + rounding).unaryExpr(&widened);
        const Eigen::Index edges = spec_.counted.earlier_boxes == 0 ? 0 : set_.edges.cols();
        all.edges.resize(4, edges + 4);
        all.edges << middle * set_.edges.leftCols(edges), Eigen::Matrix4d(box.matrix().asDiagonal());
        return all;
    }

    static constexpr long first_length = 256;
    EnclosureSpec spec_;
    LinksAndDroplets<B> system_;
    LinksAndDroplets<TangentBall> in_double_;
    BallSeries<B> middle_{order_of<Scalar>};
    BallSeries<TangentBall> tangent_{12};
    Zonotope<Scalar> set_;
    Ball<Wide> part_;  // s
    bool is_divided_ = false;
    long steps_ = 0;                                                       // also those that were too long
    long parts_ = 1, length_ = 0, next_length_ = first_length, done_ = 0;  // of a sample; of the step; since the start
};

}  // namespace

template <class Scalar>
std::vector<EnclosedState<Scalar>> enclosures(const EnclosedSystem& system, const EnclosureSpec& spec,
                                              const Watch& watch) {
    return Enclosure<Scalar>(system, spec).samples(watch);
}

template std::vector<EnclosedState<double>> enclosures(const EnclosedSystem&, const EnclosureSpec&, const Watch&);
template std::vector<EnclosedState<Quad>> enclosures(const EnclosedSystem&, const EnclosureSpec&, const Watch&);
template std::vector<EnclosedState<Wide>> enclosures(const EnclosedSystem&, const EnclosureSpec&, const Watch&);

}  // namespace doppel
