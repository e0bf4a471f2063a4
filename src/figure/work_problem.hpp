#pragma once

#include "analysis/reference.hpp"
#include "figure/kinds.hpp"
#include "scene/scene.hpp"

#include <memory>
#include <mutex>

namespace doppel {

/// A motion to compute: what moves, and for how long.
struct WorkProblem {
    std::string name, title;  // "P1", "P1 · 90°/90°, 10 s"
    Rational duration;        // s
    Side side;                // what moves, and its measures; how it is stepped does not matter
    Assembly<Quad> parts;     // of the general mechanism
    bool plain;               // a chain under gravity and nothing else: every model serves
    double natural_time;      // s, within which something happens
    bool conserves_energy;

    /// Without a method.
    MotionSpec motion(Model model) const;
    /// How far an end is from the true one: the worst angle, rad, or the worst place as a part of the size.
    double error(const Observation& seen, const Reference& truth) const;
};

/// The release of a chain or mechanism as a problem. Throws Error (exit 2) where the system is faulty.
WorkProblem make_problem(const std::string& name, SideSpec side, const Rational& duration);

/// What is known of a problem's end.
struct Truth {
    Reference reference;
    double sensitivity;  // of its angles; NaN where it is no plain chain

    /// The error that rounding alone makes in double; NaN where it is not known.
    double floor() const { return 0x1p-53 * sensitivity; }
};

/// The truth about every problem, found when it is first asked for, by any thread.
class Truths {
public:
    explicit Truths(std::size_t problems) : found_(problems) {}
    /// Throws as reference_end() does.
    const Truth& of(std::size_t index, const WorkProblem& problem, const std::atomic<bool>& stop) const;

private:
    struct Found {
        std::once_flag once;
        Truth truth;
    };
    mutable std::vector<Found> found_;
};

/// The problems that a preset's [work_precision] asks for.
struct WorkProblems {
    std::vector<WorkProblem> all;
    std::string resolved;  // the keys that name them, TOML
    std::string subtitle;  // what moves
};
WorkProblems read_problems(TomlReader& table);

}  // namespace doppel
