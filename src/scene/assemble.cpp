#include "scene/assemble.hpp"

#include "base/error.hpp"
#include "scene/nearest.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

Place<Quad> place(const std::array<Quad, 2>& xy) {
    return {xy[0], xy[1]};
}

/// What parts call the particles, and where those are at the start.
class Cast {
public:
    Cast(std::vector<std::string> names, const Assembly<Quad>& assembly)
        : names_(std::move(names)), assembly_(assembly) {}

    std::size_t index(const PartSpec& part, const std::string& name) const {
        const auto found = std::find(names_.begin(), names_.end(), name);
        if (found != names_.end()) return static_cast<std::size_t>(found - names_.begin());
        const auto meant = nearest(name, std::vector<std::string_view>(names_.begin(), names_.end()));
        throw bad_input("{}{} names the particle \"{}\", which is not there{}", part.kind,
                        part.name.empty() ? "" : fmt::format(" \"{}\"", part.name), name,
                        meant ? fmt::format("; did you mean \"{}\"?", *meant) : "");
    }
    End<Quad> end(const PartSpec& part, const EndSpec& spec) const {
        if (const auto* name = std::get_if<std::string>(&spec)) return index(part, *name);
        return place(std::get<std::array<Quad, 2>>(spec));
    }
    Place<Quad> start(const End<Quad>& end) const {
        const auto* particle = std::get_if<std::size_t>(&end);
        return particle ? assembly_.particles[*particle].place : std::get<Place<Quad>>(end);
    }
    Quad apart(const End<Quad>& one, const End<Quad>& other) const {
        using std::sqrt;
        const Place<Quad> r = start(one) - start(other);
        return sqrt(Quad(r[0] * r[0] + r[1] * r[1]));
    }

private:
    std::vector<std::string> names_;
    const Assembly<Quad>& assembly_;
};

/// From a particle to whatever is at the other end; a fixed end goes second.
std::pair<std::size_t, End<Quad>> ends_of(const Cast& cast, const PartSpec& part) {
    auto from = cast.end(part, *part.from), to = cast.end(part, *part.to);
    if (!std::holds_alternative<std::size_t>(from)) std::swap(from, to);
    if (!std::holds_alternative<std::size_t>(from))
        throw bad_input("a {} joins two fixed places; at least one end must be a particle", part.kind);
    return {std::get<std::size_t>(from), to};
}

Constraint<Quad> constraint_of(const Cast& cast, const PartSpec& part) {
    if (part.kind == "rod") {
        const auto [a, b] = ends_of(cast, part);
        return Rod<Quad>{a, b, part.length_m ? *part.length_m : cast.apart(a, b)};
    }
    const auto particle = cast.index(part, part.particle);
    const auto at = part.position_m ? place(*part.position_m) : cast.start(particle);
    if (part.kind == "anchor") return Anchor<Quad>{particle, at};
    if (part.kind == "slot-line") return SlotLine<Quad>{particle, at, place(part.direction)};
    return SlotCircle<Quad>{particle, at, part.length_m ? *part.length_m : cast.apart(particle, at)};
}

Force<Quad> force_of(const Cast& cast, const PartSpec& part) {
    const auto constant = part.constant.value_or(newton_constant<Quad>());
    if (part.kind == "droplet") return Droplet<Quad>{place(*part.position_m), part.mass_kg, constant};
    const auto [a, b] = ends_of(cast, part);
    if (part.kind == "spring")
        return Spring<Quad>{a, b, part.stiffness_N_per_m, part.length_m ? *part.length_m : cast.apart(a, b),
                            part.damping_N_s_per_m};
    const auto* other = std::get_if<std::size_t>(&b);
    if (!other) throw bad_input("an attraction is between two particles; a body that stays in place is a \"droplet\"");
    return Attraction<Quad>{a, *other, constant};
}

/// Bobs and rods of the chain.
Assembly<Quad> parts_of(const Pendulum<Quad>& chain) {
    const auto start = released_as_particles<Quad, Eigen::Dynamic>(chain);
    const auto n = static_cast<Eigen::Index>(chain.links());
    Assembly<Quad> assembly;
    for (Eigen::Index i = 0; i < n; ++i) {
        const auto k = static_cast<std::size_t>(i);
        assembly.particles.push_back({chain.mass[k], Place<Quad>(start[2 * i], start[2 * i + 1]),
                                      Place<Quad>(start[2 * n + 2 * i], start[2 * n + 2 * i + 1])});
        const End<Quad> above = i == 0 ? End<Quad>(Place<Quad>(Quad(0), Quad(0))) : End<Quad>(k - 1);
        assembly.constraints.push_back(Rod<Quad>{k, above, chain.length[k]});
    }
    return assembly;
}

}  // namespace

Pendulum<Quad> chain_of(const SideSpec& spec) {
    Pendulum<Quad> chain{spec.mass_kg, spec.length_m, {}, {}, spec.gravity_m_per_s2};
    const Quad degree = pi_of<Quad>() / 180;
    for (const auto& angle : spec.angle_deg) chain.angle.push_back(angle * degree);
    for (const auto& rate : spec.omega_deg_per_s) chain.rate.push_back(rate * degree);
    return chain;
}

Assembly<Quad> assembly_of(const SideSpec& spec) {
    Assembly<Quad> assembly;
    std::vector<std::string> names;
    if (spec.particles.empty()) {
        assembly = parts_of(chain_of(spec));
        for (std::size_t i = 1; i <= spec.links(); ++i) names.push_back(fmt::format("bob{}", i));
    }
    for (const auto& particle : spec.particles) {
        assembly.particles.push_back({particle.mass_kg, place(particle.position_m), place(particle.velocity_m_per_s)});
        names.push_back(particle.name);
    }
    const Cast cast(names, assembly);
    for (const auto& part : spec.constraints) assembly.constraints.push_back(constraint_of(cast, part));
    if (spec.gravity_m_per_s2 != 0) assembly.forces.push_back(Gravity<Quad>{spec.gravity_m_per_s2});
    for (const auto& part : spec.forces) assembly.forces.push_back(force_of(cast, part));
    return assembly;
}

}  // namespace doppel
