#include "analysis/section.hpp"

#include "analysis/natural_units.hpp"
#include "integrate/taylor.hpp"
#include "numeric/error.hpp"
#include "physics/canonical.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace doppel {
namespace {

void check_links(const Pendulum<double>& p) {
    if (p.links() != 2) throw bad_input("a Poincaré section is of 2 links; there are {}", p.links());
}

/// A double pendulum on its way from crossing to crossing.
class Crossings {
public:
    using Model = DoublePendulum<double>;

    Crossings(const Pendulum<double>& p, double tolerance)
        : model_(p), canonical_(model_), stepper_(model_, Model::start(p), tolerance), turns_(turns()) {}

    /// Goes on by so many seconds; whether θ1 has passed 0 (mod 2π) upwards meanwhile.
    bool advance(double seconds) {
        stepper_.advance(seconds);
        const double before = turns_;
        turns_ = turns();
        return turns_ > before;
    }

    /// The crossing within the seconds just gone by; `time` is now. Newton's method, kept within brackets. A series
    /// holds on both sides of the state that it is about, so the stepper can look back.
    SectionPoint crossing(double seconds, double time) {
        constexpr double close = 1e-15;  // rad, and relative
        double low = -seconds, high = 0, at = 0;
        for (int i = 0; i < 60; ++i) {
            const auto& y = stepper_.state();
            const double beyond = y[0] - 2 * pi * turns_;
            if (std::abs(beyond) <= close * (1 + std::abs(y[0]))) break;
            (beyond < 0 ? low : high) = at;
            double next = at - beyond / y[2];
            if (!(next > low && next < high)) next = 0.5 * (low + high);
            stepper_.advance(next - at);
            at = next;
        }
        Model::State z;
        canonical_.momenta(stepper_.state(), z);
        stepper_.advance(-at);
        const double theta2 = std::remainder(z[1], 2 * pi);
        return {theta2 == -pi ? pi : theta2, z[3], z[2], time + at};
    }

private:
    double turns() const { return std::floor(stepper_.state()[0] / (2 * pi)); }

    Model model_;
    Canonical<Model> canonical_;
    Taylor::Stepper<Model> stepper_;
    double turns_;
};

/// Point number k of a sequence that fills the unit square evenly, however many are taken.
/// Source  Roberts 2018, The unreasonable effectiveness of quasirandom sequences: multiples of 1/ρ and 1/ρ², ρ³ = ρ
/// + 1.
std::pair<double, double> spread(int k) {
    constexpr double rho = 1.324717957244746;
    const auto part = [](double x) { return x - std::floor(x); };
    return {part(0.5 + k / rho), part(0.5 + k / (rho * rho))};
}

}  // namespace

std::vector<SectionPoint> poincare_section(const Pendulum<double>& p, const SectionSpec& spec,
                                           const std::atomic<bool>& stop) {
    check_links(p);
    if (spec.crossings < 1 || !(spec.longest_s > 0))
        throw bad_input("a section takes at least one crossing and a time > 0 s; they are {} and {} s", spec.crossings,
                        spec.longest_s);
    const double look = NaturalUnits(p).time / 16;
    Crossings motion(p, spec.tolerance);
    std::vector<SectionPoint> points;
    for (long k = 1; static_cast<double>(k) * look <= spec.longest_s; ++k) {
        if (stop) throw Error(ExitCode::interrupted, "interrupted");
        if (!motion.advance(look)) continue;
        points.push_back(motion.crossing(look, static_cast<double>(k) * look));
        if (points.size() == static_cast<std::size_t>(spec.crossings)) break;
    }
    return points;
}

/// On the section, with D = −θ2, the energy above that of hanging is
///     E = ½ l1² (m1 + m2 sin²θ2) ω1² + p2² / (2 m2 l2²) + m2 g l2 (1 − cosθ2) ,
/// so that |p2| has a greatest value at each θ2, and ω1 follows.
std::vector<Pendulum<double>> releases_of_energy(const Pendulum<double>& p, double energy_J, int count) {
    check_links(p);
    if (!(energy_J > 0) || !(p.gravity >= 0))
        throw bad_input("a section takes an energy > 0 J and a gravity ≥ 0; they are {} J and {} m/s²", energy_J,
                        p.gravity);
    const double m1 = p.mass[0], m2 = p.mass[1], l1 = p.length[0], l2 = p.length[1];
    const double weight = m2 * p.gravity * l2, inertia = m2 * l2 * l2;
    const double widest = std::acos(std::max(-1.0, 1 - energy_J / weight));
    std::vector<Pendulum<double>> releases;
    for (int k = 0; k < count; ++k) {
        const auto [u, v] = spread(k);
        const double theta2 = widest * (2 * u - 1);
        const double kinetic = energy_J - weight * (1 - std::cos(theta2));
        const double p2 = std::sqrt(2 * inertia * kinetic) * (2 * v - 1);
        const double sin2 = std::sin(theta2);
        const double omega1 = std::sqrt(2 * (kinetic - p2 * p2 / (2 * inertia)) / (m1 + m2 * sin2 * sin2)) / l1;
        releases.push_back(p);
        releases.back().angle = {0, theta2};
        releases.back().rate = {omega1, p2 / inertia - l1 / l2 * omega1 * std::cos(theta2)};
    }
    return releases;
}

}  // namespace doppel
