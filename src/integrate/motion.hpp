#pragma once

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

/// What moves, and how it is integrated; everything exact, so that quad means 34 digits of what was written.
struct MotionSpec {
    std::optional<Pendulum<Quad>> chain;             // of every model but a mechanism that is none
    std::optional<PhysicalPendulum<Quad>> physical;  // the same chain, where its links are more than point masses
    std::optional<Assembly<Quad>> parts;             // of a mechanism; those of the chain first, where it has one
    Model model = Model::angles;
    std::string method = "euler";
    Precision precision = Precision::in_double;
    Rational sample_interval{1, 120};  // s
    long steps_per_sample = 250;       // of methods with a fixed step
    Quad tolerance = 0;                // of adaptive methods
    Stabilise stabilise = Stabilise::none;
    Quad stabilise_rate = 0;     // Baumgarte's α = β, 1/s
    bool follows_turns = true;   // false: angles of particles only up to whole turns, and none followed between samples
    bool wants_tension = false;  // the rod tensions observed as well; of point masses alone
};

/// The state at one sample, the same for every model.
struct Observation {
    Bobs<double> bobs;          // angles unwrapped
    Bobs<Quad> exact;           // the same, turns too, to all digits, where the precision is quad; else empty
    Bob<double> pivot{};        // of a chain, where it is and how fast it moves
    double energy = 0;          // J
    double kinetic_energy = 0;  // J
    double work = 0;            // J, of friction and drive on a physical pendulum since the start
    double energy_change = 0;   // J, since the start, less `work`; in quad the difference is taken in quad
    double length_error = 0;    // of the worst rod, m
    /// In each rod, N, > 0 where it pulls, where it was wanted: in the chain's order, or in that of the mechanism's
    /// constraints that are rods. NaN where a constraint depends on others.
    std::vector<double> tension;
};

/// What a motion has cost so far.
struct Effort {
    long steps = 0, evaluations = 0;  // evaluations of the right-hand side
    double smallest_step = 0;         // s
};

/// A mechanism that moves, as the sample loop sees it. Virtual, because it is asked 120 times a second; the steps
/// behind it, 30 000 times a second, are a template.
class Motion {
public:
    virtual ~Motion() = default;
    /// On to the next sample. Throws Error: exit 3 where a step cannot be made, exit 130 soon after `stop` is set.
    virtual void advance(const std::atomic<bool>& stop) = 0;
    /// On to a share, 0…1, of the way from the last sample to the next, of a fixed step to the nearest step; then on to
    /// greater shares, or by advance(). Samples are the same to the bit as without it. Throws as advance().
    virtual void advance_within(double share, const std::atomic<bool>& stop) = 0;
    virtual Observation observe() const = 0;
    virtual Effort effort() const = 0;
};

/// Throws Error (exit 2) where no method has that name, the method cannot step the model, a stabilisation has nothing
/// to do (in angles, or with a method that keeps the constraints itself), forces are wanted in rods that have none (of a
/// physical pendulum), or the system is faulty.
std::unique_ptr<Motion> make_motion(const MotionSpec& spec);

}  // namespace doppel
