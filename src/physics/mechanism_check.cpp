#include "physics/mechanism.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace doppel {
namespace {

using Places = State<double, Eigen::Dynamic>;  // (x1, y1, x2, y2 …), m

constexpr double tolerance = 1e-9;  // relative to the size, or to the largest speed

std::string text(const Place<double>& place) {
    return fmt::format("({}, {})", place[0], place[1]);
}

/// "1, 2 and 4", counted from 1.
std::string listed(const std::vector<std::size_t>& indices) {
    std::string all;
    for (std::size_t i = 0; i < indices.size(); ++i) {
        if (i > 0) all += i + 1 == indices.size() ? " and " : ", ";
        all += fmt::to_string(indices[i] + 1);
    }
    return (indices.size() == 1 ? "constraint " : "constraints ") + all;
}

/// Throws unless the numbers of the named part are valid, and every particle that it refers to exists.
class PartCheck {
public:
    PartCheck(std::string name, const std::vector<Particle<double>>& particles)
        : name_(std::move(name)), particles_(particles) {}

    void operator()(const Particle<double>& particle) const {
        positive("mass", particle.mass, "kg");
        finite("place", particle.place, " m");
        finite("velocity", particle.velocity, " m/s");
    }
    void operator()(const Anchor<double>& anchor) const {
        exists(anchor.particle);
        finite("place", anchor.place);
    }
    void operator()(const Rod<double>& rod) const {
        joins(rod.a, rod.b);
        positive("length", rod.length, "m");
    }
    void operator()(const SlotLine<double>& slot) const {
        exists(slot.particle);
        finite("point", slot.point);
        finite("direction", slot.direction);
        if (slot.direction.isZero(0)) throw bad_input("{}: its direction is (0, 0); it must not be zero", name_);
    }
    void operator()(const SlotCircle<double>& slot) const {
        exists(slot.particle);
        finite("centre", slot.centre);
        positive("radius", slot.radius, "m");
    }
    void operator()(const Gravity<double>& gravity) const { finite("g", gravity.g, "m/s²"); }
    void operator()(const Spring<double>& spring) const {
        joins(spring.a, spring.b);
        positive("stiffness", spring.stiffness, "N/m");
        not_negative("rest length", spring.length, "m");
        not_negative("damping", spring.damping, "N s/m");
    }
    void operator()(const Attraction<double>& attraction) const {
        joins(attraction.a, attraction.b);
        finite("G", attraction.constant, "m³/(kg s²)");
        require_distance(attraction.a, particles_[attraction.b].place);
    }
    void operator()(const Droplet<double>& droplet) const {
        finite("place", droplet.place);
        positive("mass", droplet.mass, "kg");
        finite("G", droplet.constant, "m³/(kg s²)");
        for (std::size_t i = 0; i < particles_.size(); ++i) require_distance(i, droplet.place);
    }

private:
    void exists(std::size_t particle) const {
        if (particle >= particles_.size())
            throw bad_input("{}: there is no particle {}; the mechanism has 1 to {}", name_, particle + 1,
                            particles_.size());
    }
    void joins(std::size_t a, const End<double>& b) const {
        exists(a);
        const auto* particle = std::get_if<std::size_t>(&b);
        if (!particle) return finite("fixed end", std::get<Place<double>>(b));
        exists(*particle);
        if (*particle == a)
            throw bad_input("{}: it joins particle {} to itself; it needs two different particles", name_, a + 1);
    }
    void require_distance(std::size_t particle, const Place<double>& place) const {
        if (particles_[particle].place == place)
            throw bad_input("{}: particle {} starts at {} m, the place of what attracts it; start it elsewhere", name_,
                            particle + 1, text(place));
    }
    void finite(std::string_view what, const Place<double>& value, std::string_view unit = "") const {
        if (!value.allFinite())
            throw bad_input("{}: its {} is {}{}; both must be finite numbers", name_, what, text(value), unit);
    }
    void finite(std::string_view what, double value, std::string_view unit) const {
        number(what, value, unit, true, "be a finite number");
    }
    void positive(std::string_view what, double value, std::string_view unit) const {
        number(what, value, unit, value > 0, "be greater than 0");
    }
    void not_negative(std::string_view what, double value, std::string_view unit) const {
        number(what, value, unit, value >= 0, "not be negative");
    }
    void number(std::string_view what, double value, std::string_view unit, bool is_right,
                std::string_view must) const {
        if (!is_right || !std::isfinite(value))
            throw bad_input("{}: its {} is {} {}; it must {}", name_, what, value, unit, must);
    }

    std::string name_;
    const std::vector<Particle<double>>& particles_;
};

/// How the initial positions violate a constraint, by `error` m, and what would satisfy it.
std::string remedy(const Constraint<double>& constraint, const Places& q, double error) {
    const auto row = rows_of(constraint)[0];
    const auto place = part_of(q, row.a);
    if (const auto* anchor = std::get_if<Anchor<double>>(&constraint))
        return fmt::format("the particle starts at {} m, {:.3g} m from its anchor {} m; anchor it at {}", text(place),
                           error, text(anchor->place), text(place));
    if (const auto* slot = std::get_if<SlotLine<double>>(&constraint)) {
        const Place<double> foot =
            slot->point + slot->direction * (slot->direction.dot(place - slot->point) / slot->direction.squaredNorm());
        return fmt::format("the particle starts at {} m, {:.3g} m off the line; start it at {}", text(place), error,
                           text(foot));
    }
    const double length = row.distance_of_ends(q).norm();
    if (std::holds_alternative<Rod<double>>(constraint))
        return fmt::format("its ends start {} m apart, {:.3g} m from its length {} m; make the length {}", length,
                           error, row.length, length);
    return fmt::format("the particle starts {} m from the centre, {:.3g} m from the radius {} m; make the radius {}",
                       length, error, row.length, length);
}

void check_places(const Assembly<double>& assembly, const Places& q) {
    const double size = std::max(q.lpNorm<Eigen::Infinity>(), size_of(assembly));
    for (std::size_t i = 0; i < assembly.constraints.size(); ++i) {
        const auto& constraint = assembly.constraints[i];
        if (const double error = error_of(constraint, q); error > tolerance * size)
            throw bad_input("{}: {}", name_of(i, constraint), remedy(constraint, q, error));
    }
}

/// An error suggests a velocity for the last particle of a row, without the component that violates the row. With it,
/// and the other velocities unchanged, the row is satisfied.
void check_velocities(const Assembly<double>& assembly, const Places& q) {
    const auto& particles = assembly.particles;
    double speed = 0;
    for (const auto& particle : particles) speed = std::max(speed, particle.velocity.norm());
    for (std::size_t i = 0; i < assembly.constraints.size(); ++i)
        for (const auto& row : rows_of(assembly.constraints[i])) {
            std::size_t last = row.a;
            Place<double> gradient = row.gradient(q);
            double slip = gradient.dot(particles[last].velocity);
            if (const auto* other = row.other_particle()) {
                last = *other;
                gradient = -gradient;
                slip += gradient.dot(particles[last].velocity);
            }
            const double length = gradient.norm();
            if (!(std::abs(slip) > tolerance * speed * length)) continue;
            const Place<double> velocity = particles[last].velocity - gradient * (slip / gradient.squaredNorm());
            throw bad_input("{}: the start violates it at {:.3g} m/s; start particle {} at {} m/s",
                            name_of(i, assembly.constraints[i]), std::abs(slip) / length, last + 1, text(velocity));
        }
}

}  // namespace

double size_of(const Assembly<double>& assembly) {
    const auto place = [&](std::size_t particle) -> const auto& {
        return assembly.particles[particle].place;
    };
    Place<double> low = place(0), high = low;
    for (const auto& particle : assembly.particles) {
        low = low.cwiseMin(particle.place);
        high = high.cwiseMax(particle.place);
    }
    double size = (high - low).norm();
    for (const auto& constraint : assembly.constraints) {
        if (const auto rod = rod_of(constraint)) size = std::max(size, rod->length);
        if (const auto* slot = std::get_if<SlotLine<double>>(&constraint))
            size = std::max(size, (place(slot->particle) - slot->point).norm());
    }
    double nearest = std::numeric_limits<double>::infinity();  // distance of droplets
    for (const auto& force : assembly.forces) {
        if (const auto* spring = std::get_if<Spring<double>>(&force)) {
            const auto* other = std::get_if<std::size_t>(&spring->b);
            const auto& end = other ? place(*other) : std::get<Place<double>>(spring->b);
            size = std::max({size, spring->length, (place(spring->a) - end).norm()});
        }
        if (const auto* droplet = std::get_if<Droplet<double>>(&force))
            nearest = std::min(nearest, (low - droplet->place).norm());
    }
    if (size > 0) return size;
    return std::isfinite(nearest) ? nearest : 1;
}

void check(const Assembly<double>& assembly) {
    const auto& [particles, constraints, forces] = assembly;
    if (particles.empty()) throw bad_input("the mechanism has no particles; it needs at least one");
    for (std::size_t i = 0; i < particles.size(); ++i)
        PartCheck(fmt::format("particle {}", i + 1), particles)(particles[i]);
    for (std::size_t i = 0; i < constraints.size(); ++i)
        std::visit(PartCheck(name_of(i, constraints[i]), particles), constraints[i]);
    for (std::size_t i = 0; i < forces.size(); ++i) std::visit(PartCheck(name_of(forces, i), particles), forces[i]);

    const auto start = Mechanism<double>::start(assembly);
    const Places q = start.head(start.size() / 2);
    check_places(assembly, q);
    check_velocities(assembly, q);
    if (const auto found = Mechanism<double>(assembly).dependence(q))
        throw ConstraintError(
            bad_input("{} is redundant: it follows from {}; leave it out, or start elsewhere",
                      name_of(found->constraint, constraints[found->constraint]), listed(found->others)),
            found->constraint);
}

Error singular_configuration(const std::string& name, const Dependence& dependence, const std::vector<double>& places,
                             double relative_error) {
    std::string where;
    for (std::size_t i = 0; i + 1 < places.size(); i += 2)
        where += fmt::format("{}({:.6g}, {:.6g})", i == 0 ? "" : ", ", places[i], places[i + 1]);
    constexpr double torn = 0.1;        // relative to the longest rod; drift is less where forces are determined
    constexpr double farthest = 1e100;  // m; squares of larger numbers could overflow
    if (!(relative_error < torn && std::ranges::all_of(places, [](double x) { return std::abs(x) < farthest; })))
        return method_failed(
            "the particles are at {} m, where a constraint has an error of {:.2g} times the longest rod: the motion "
            "diverged; use a smaller step",
            where, relative_error);
    return method_failed(
        "singular configuration: {} now follows from {}, so the forces are not determined; the particles are at {} m; "
        "choose a start that does not lead there, or leave the constraint out",
        name, listed(dependence.others), where);
}

}  // namespace doppel
