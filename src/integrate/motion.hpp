#pragma once

#include "integrate/methods.hpp"
#include "numeric/quad.hpp"
#include "numeric/rational.hpp"
#include "physics/bob.hpp"
#include "physics/mechanism_assembly.hpp"

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace doppel {

enum class Model { angles, constraints, mechanism };
enum class Precision { in_double, in_quad };
enum class Stabilise { none, baumgarte, projection };

/// A system and how it is integrated, in exact numbers: in quad they have all written digits, up to 34.
struct MotionSpec {
    std::optional<Pendulum<Quad>> chain;             // for every model except a mechanism that is no chain
    std::optional<PhysicalPendulum<Quad>> physical;  // the same chain, if its links are not just point masses
    std::optional<Assembly<Quad>> parts;             // of a mechanism; a chain's parts come first
    Model model = Model::angles;
    std::string method = "euler";
    Precision precision = Precision::in_double;
    Rational sample_interval{1, 120};  // s
    long steps_per_sample = 250;       // for methods with a fixed step
    Quad tolerance = 0;                // for adaptive methods
    Stabilise stabilise = Stabilise::none;
    Quad stabilise_rate = 0;     // Baumgarte's α = β, 1/s
    bool follows_turns = true;   // false: angles of particles are only computed modulo whole turns
    bool wants_tension = false;  // rod tensions are observed, too; only for point masses
};

/// The state at a sample, the same for every model.
struct Observation {
    Bobs<double> bobs;          // angles unwrapped
    Bobs<Quad> exact;           // the same in quad, including turns, if the precision is quad; otherwise empty
    Bob<double> pivot{};        // position and velocity of a chain's pivot
    double energy = 0;          // J
    double kinetic_energy = 0;  // J
    double work = 0;            // J, by friction and drive on a rigid-body chain since the start
    double energy_change = 0;   // J, since the start, without `work`; in quad the difference is computed in quad
    double length_error = 0;    // of the rod with the largest error, m
    /// Tension of each rod, N, > 0 if it pulls, on request: in the order of the chain, or of the mechanism's
    /// constraints that are rods. NaN if a constraint depends on others.
    std::vector<double> tension;
};

/// A system that moves, advanced from sample to sample. The interface is virtual, with some 120 calls per second of
/// motion; the steps behind it, 30 000 per second, are templates.
class Motion {
public:
    virtual ~Motion() = default;
    /// Advances to the next sample. Throws Error: exit 3 if a step cannot be made, exit 130 soon after `stop` is set.
    virtual void advance(const std::atomic<bool>& stop) = 0;
    /// Advances to a fraction, 0…1, of the interval from the last sample to the next; with a fixed step, to the nearest
    /// step. Later calls must have larger fractions, or be advance(). Samples have the same bits as without these
    /// calls. Throws as advance().
    virtual void advance_within(double share, const std::atomic<bool>& stop) = 0;
    virtual Observation observe() const = 0;
    virtual Effort effort() const = 0;
};

/// Throws Error (exit 2) for an unknown method, one that does not support the model, or an invalid system. Also for a
/// stabilisation without effect (in angles, or with a method that preserves the constraints), and for tensions of rigid
/// bodies.
std::unique_ptr<Motion> make_motion(const MotionSpec& spec);

}  // namespace doppel
