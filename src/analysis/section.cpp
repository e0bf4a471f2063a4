#include "analysis/section.hpp"

#include "base/error.hpp"
#include "integrate/taylor.hpp"
#include "numeric/quad.hpp"
#include "numeric/roots.hpp"
#include "physics/canonical.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

/// Steps a double pendulum and finds its crossings of the section.
class Crossings {
public:
    using Model = DoublePendulum<double>;

    Crossings(const Pendulum<double>& p, double tolerance)
        : model_(p), canonical_(model_), stepper_(model_, Model::start(p), tolerance) {}

    double time() const { return static_cast<double>(time_); }  // s; all crossings up to here have been found

    /// Takes a step and adds its crossings in order.
    void step(std::vector<SectionPoint>& points) {
        stepper_.take_step();
        const auto angle = stepper_.on_step(0);
        const auto [minimum, largest] = std::minmax_element(angle.b.begin(), angle.b.end());
        const auto before = static_cast<std::ptrdiff_t>(points.size());
        for (double turns = std::floor(*minimum / (2 * pi)); turns <= std::ceil(*largest / (2 * pi)); ++turns)
            for (const auto& bracket : angle.rises(2 * pi * turns)) points.push_back(crossing(bracket, 2 * pi * turns));
        std::sort(points.begin() + before, points.end(),
                  [](auto& one, auto& other) { return one.time_s < other.time_s; });
        time_ += stepper_.step();
    }

private:
    /// The crossing of θ1 upwards through `level`, rad, inside a bracket.
    SectionPoint crossing(const Bracket& bracket, double level) {
        constexpr double rounding = 1e-15;  // rad, and relative
        const double at = root(bracket, [&](double t) {
            const auto& y = stepper_.at(t);
            const bool is_at_level = std::abs(y[0] - level) <= rounding * (1 + std::abs(y[0]));
            struct Height {
                double value, rate;
            };
            return Height{is_at_level ? 0 : y[0] - level, y[2]};
        });
        canonical_.momenta(stepper_.at(at), z_);
        const double theta2 = std::remainder(z_[1], 2 * pi);
        return {theta2 == -pi ? pi : theta2, z_[3], z_[2], static_cast<double>(time_ + at)};
    }

    Model model_;
    Canonical<Model> canonical_;
    Taylor::Stepper<Model> stepper_;
    Model::State z_ = Model::State::Zero();  // a member, because GCC 12 at -O3 loses what is written to a local one
    Quad time_ = 0;                          // start of the step, s: a sum of tens of thousands of steps
};

}  // namespace

std::vector<SectionPoint> poincare_section(const Pendulum<double>& p, const SectionSpec& spec,
                                           const std::atomic<bool>& stop) {
    Crossings motion(p, spec.tolerance);
    std::vector<SectionPoint> points;
    const auto wanted = static_cast<std::size_t>(spec.crossings);
    while (points.size() < wanted && motion.time() < spec.longest_s) {
        throw_if_set(stop);
        motion.step(points);
    }
    const auto is_late = [&](const SectionPoint& point) { return point.time_s > spec.longest_s; };
    points.erase(std::find_if(points.begin(), points.end(), is_late), points.end());
    if (points.size() > wanted) points.erase(points.begin() + spec.crossings, points.end());
    return points;
}

/// On the section, with D = −θ2, the energy above the hanging equilibrium is
///     E = ½ l1² (m1 + m2 sin²θ2) ω1² + p2² / (2 m2 l2²) + m2 g l2 (1 − cosθ2) ,
/// so that |p2| has a maximum at each θ2, and ω1 follows. Points are at multiples of 1/ρ and 1/ρ² with ρ³ = ρ + 1,
/// which fill the unit square evenly for any number of points.
/// Source  Roberts 2018, The unreasonable effectiveness of quasirandom sequences.
std::vector<Pendulum<double>> releases_of_energy(const Pendulum<double>& p, double energy_J, int count) {
    if (!(energy_J > 0) || !(p.gravity >= 0))
        throw bad_input("a section needs an energy > 0 J and a gravity ≥ 0; they are {} J and {} m/s²", energy_J,
                        p.gravity);
    const double m1 = p.mass[0], m2 = p.mass[1], l1 = p.length[0], l2 = p.length[1];
    const double weight = m2 * p.gravity * l2, inertia = m2 * l2 * l2;
    const double widest = std::acos(std::max(-1.0, 1 - energy_J / weight));
    constexpr double rho = 1.324717957244746;
    std::vector<Pendulum<double>> releases;
    for (int k = 0; k < count; ++k) {
        const double u = 0.5 + k / rho, v = 0.5 + k / (rho * rho);  // fractional parts
        const double theta2 = widest * (2 * (u - std::floor(u)) - 1);
        const SinCos<double> turn(theta2);
        const double kinetic = energy_J - weight * (1 - turn.cos);
        const double p2 = std::sqrt(2 * inertia * kinetic) * (2 * (v - std::floor(v)) - 1);
        const double sin2 = turn.sin;
        const double omega1 = std::sqrt(2 * (kinetic - p2 * p2 / (2 * inertia)) / (m1 + m2 * sin2 * sin2)) / l1;
        releases.push_back(p);
        releases.back().angle = {0, theta2};
        releases.back().rate = {omega1, p2 / inertia - l1 / l2 * omega1 * turn.cos};
    }
    return releases;
}

}  // namespace doppel
