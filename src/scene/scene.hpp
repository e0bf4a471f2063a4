#pragma once

#include "integrate/methods.hpp"
#include "integrate/motion.hpp"
#include "scene/preset.hpp"

#include <atomic>
#include <memory>
#include <string>

namespace doppel {

/// One side with everything chosen.
struct Side {
    Pendulum pendulum;
    Model model;
    std::string why;  // this model
    Method method;
    Rational step;          // s
    long steps_per_sample;  // exact
};

/// What a preset comes to: the models chosen, the clock in whole numbers.
struct Scene {
    Preset preset;
    Side a, b;
    long samples;            // of the run: 0 … samples, both ends included
    Rational fps;            // frames/s of the video
    long samples_per_frame;  // frame k shows sample k · samples_per_frame

    double time(long sample) const;  // s
};

Scene make_scene(const Preset& preset);

std::string_view name_of(Model model);  // as in presets: "angles", "constraints"

/// Both sides and how they differ at one sample.
struct Moment {
    long sample = 0;
    Observation a, b;
    double energy_error_a = 0, energy_error_b = 0;  // relative, analysis/energy_error.hpp
    double distance = 0;                            // state space, analysis/distance.hpp
};

/// Steps the pair from sample to sample.
class PairRun {
public:
    explicit PairRun(const Scene& scene);

    /// Sample 0, then 1, 2, … Throws Error: exit 3 with side and time where a state is no longer finite, exit 130 soon
    /// after `stop` is set.
    Moment next(const std::atomic<bool>& stop);

private:
    struct Runner {
        const Side& side;
        std::unique_ptr<Motion> motion;
        double start_energy, energy_scale;  // J
    };
    static Runner runner(const Side& side);
    Observation advanced(Runner& runner, std::string_view name, const std::atomic<bool>& stop) const;

    const Scene& scene_;
    Runner a_, b_;
    long sample_ = -1;
};

}  // namespace doppel
