#pragma once

#include "scene/method_choice.hpp"
#include "scene/support.hpp"

#include <cmath>
#include <random>
#include <string>
#include <vector>

// Random scenes of all kinds.

namespace doppel::drawn {

/// Random numbers in whole thousandths, the same with every standard library.
class Lot {
public:
    explicit Lot(unsigned seed) : numbers_(seed) {}

    std::size_t of(std::size_t many) { return numbers_() % many; }
    Quad between(double low, double high) {
        return Quad(std::round(1000 * (low + (high - low) * static_cast<double>(numbers_()) / 4294967296.0))) / 1000;
    }
    std::string text(double low, double high) { return text_of(between(low, high)); }

private:
    std::mt19937 numbers_;
};

/// Links with random masses, lengths, angles and rates, and random gravity.
inline SideSpec chain_by(Lot& lot, std::size_t links, double fastest) {
    SideSpec side;
    side.set_links(links);
    for (std::size_t i = 0; i < links; ++i) {
        side.mass_kg[i] = lot.between(0.2, 3);
        side.length_m[i] = lot.between(0.3, 2);
        side.angle_deg[i] = lot.between(-180, 180);
        side.omega_deg_per_s[i] = lot.between(-fastest, fastest);
    }
    side.gravity_m_per_s2 = lot.between(1.6, 25);
    return side;
}

inline SideSpec mechanism_of(const std::string& parts) {
    return preset_from("[system]\nintegrator = \"taylor\"\n" + parts).a;
}
inline std::string particle(const char* name, const std::string& mass, const std::string& x, const std::string& y) {
    return fmt::format("[[system.particle]]\nname = \"{}\"\nmass_kg = {}\nposition_m = [{}, {}]\n", name, mass, x, y);
}
inline std::string rod(const char* from, const char* to) {
    return fmt::format("[[system.constraint]]\nkind = \"rod\"\nfrom = \"{}\"\nto = {}\n", from, to);
}

inline SideSpec of_model(SideSpec side, ModelChoice model) {
    side.model = model;
    return side;
}

/// Two links with mass, and friction in their joints.
inline SideSpec bodies_by(Lot& lot) {
    auto side = chain_by(lot, 2, 200);
    for (std::size_t i = 0; i < 2; ++i) {
        side.physical.rod_mass_kg[i] = lot.between(0.1, 1);
        side.physical.joint_viscous_N_m_s[i] = lot.between(0, 0.3);
    }
    return side;
}

/// A kind of systems for random samples.
struct Kind {
    const char* name;
    SideSpec (*drawn)(Lot&);
    bool is_slow = false;  // slow in quadruple precision
};
inline const std::vector<Kind> kinds{
    {"chain", [](Lot& lot) { return chain_by(lot, 1 + lot.of(4), 200); }},
    {"chain as particles on rods",
     [](Lot& lot) { return of_model(chain_by(lot, 1 + lot.of(3), 200), ModelChoice::constraints); }},
    {"chain as a mechanism",
     [](Lot& lot) { return of_model(chain_by(lot, 1 + lot.of(3), 200), ModelChoice::mechanism); }, true},
    {"chain on a spring",
     [](Lot& lot) {
         auto side = chain_by(lot, 1 + lot.of(3), 200);
         side.forces.push_back({.kind = PartKind::spring,
                                .from = EndSpec("bob1"),
                                .to = EndSpec(QuadPair{Quad(1), Quad(-1)}),
                                .stiffness_N_per_m = lot.between(1, 30)});
         return side;
     }},
    {"light mass",
     [](Lot& lot) {
         auto side = chain_by(lot, 2 + lot.of(2), 200);
         side.mass_kg[lot.of(side.links())] /= lot.of(2) == 0 ? 1000 : 10'000;
         return side;
     }},
    {"heavy third link",
     [](Lot& lot) {
         auto side = chain_by(lot, 3, 200);
         side.mass_kg[2] *= 30;
         return side;
     }},
    {"whirling", [](Lot& lot) { return chain_by(lot, 1 + lot.of(3), 2500); }},
    {"bead in a slot",
     [](Lot& lot) {
         return mechanism_of(
             particle("bead", lot.text(0.3, 2), lot.text(-0.5, 0.5), "0") +
             particle("bob", lot.text(0.3, 2), lot.text(0.6, 1.2), lot.text(-0.8, 0.8)) + rod("bob", "\"bead\"") +
             "[[system.constraint]]\nkind = \"slot-line\"\nparticle = \"bead\"\nposition_m = [0, 0]\n"
             "direction = [1, 0]\n[[system.force]]\nkind = \"spring\"\nfrom = \"bead\"\nto = [-9, 0]\nlength_m = 9\n"
             "stiffness_N_per_m = " +
             lot.text(2, 30) + "\n");
     }},
    {"loop",
     [](Lot& lot) {
         return mechanism_of(particle("crank", lot.text(0.5, 2), "0.6", "0.8") +
                             particle("rocker", lot.text(0.5, 2), lot.text(1.7, 2.2), lot.text(0.6, 1)) +
                             particle("bob", lot.text(0.3, 2), lot.text(0.9, 1.4), lot.text(1.3, 1.8)) +
                             rod("crank", "[0, 0]") + rod("rocker", "[0.5, 0]") + rod("crank", "\"rocker\"") +
                             rod("bob", "\"crank\""));
     }},
    {"attraction",
     [](Lot& lot) {
         return mechanism_of(
             particle("sun", lot.text(0.5, 2), "0.1", "-0.2") +
             particle("planet", lot.text(0.5, 2), lot.text(0.8, 1.2), lot.text(-0.5, 0.5)) + rod("sun", "[0, 1]") +
             rod("planet", "[0, 2]") +
             "[[system.force]]\nkind = \"attraction\"\nfrom = \"sun\"\nto = \"planet\"\nconstant_m3_per_kg_s2 = " +
             lot.text(0.5, 3) + "\n");
     }},
    {"long chain", [](Lot& lot) { return chain_by(lot, 5 + lot.of(8), 100); }, true},
    {"long chain as a mechanism",
     [](Lot& lot) { return of_model(chain_by(lot, 5 + lot.of(8), 100), ModelChoice::mechanism); }, true},
    {"bodies", bodies_by, true},
    {"bodies without friction",
     [](Lot& lot) {
         auto side = bodies_by(lot);
         side.physical.joint_viscous_N_m_s.assign(2, Quad(0));
         return side;
     },
     true},
    {"shaken bodies",
     [](Lot& lot) {
         auto side = bodies_by(lot);
         side.physical.pivot.amplitude_m = lot.between(0.02, 0.2);
         side.physical.pivot.frequency_hz = lot.between(0.5, 5);
         return side;
     },
     true},
    {"bodies that stick",
     [](Lot& lot) {
         auto side = bodies_by(lot);
         side.physical.joint_coulomb_N_m.assign(2, lot.between(0.1, 1));
         return side;
     },
     true}};

/// Calls use(preset, side) for so many random scenes of a kind, of `least_s` to `most_s`, with an accuracy that can be
/// kept.
template <class Use>
void choose_for_each(const Kind& kind, Lot& lot, int enough, std::size_t most_tenths, long least_s, long most_s,
                     const Rational& hz, const Use& use) {
    int reached = 0;
    for (int drawing = 0; reached < enough && drawing < 4 * enough; ++drawing) {
        auto spec = kind.drawn(lot);
        spec.accuracy = Quad(1);
        for (std::size_t tenths = 2 + lot.of(most_tenths); tenths > 0; --tenths) *spec.accuracy /= 10;
        const Rational seconds{least_s + static_cast<long>(lot.of(static_cast<std::size_t>(most_s - least_s + 1))), 1};
        const Preset preset{.duration_s = seconds, .sample_hz = hz, .a = spec, .b = spec};
        std::optional<Side> side;
        const auto [code, message] = error_of([&] { side = *MethodChooser(preset, never).choose(1, never)[0]; });
        if (side) use(preset, *side), ++reached;
        EXPECT_TRUE(side || code == ExitCode::bad_input) << kind.name << ": " << message;  // not achievable
    }
    EXPECT_EQ(reached, enough) << kind.name;
}

}  // namespace doppel::drawn
