#pragma once

#include "integrate/motion.hpp"
#include "physics/pendulums.hpp"
#include "track/track.hpp"

#include <fmt/format.h>

#include <random>
#include <string>

namespace doppel::test {

inline const std::atomic<bool> never_stop = false;

/// Two rods with mass and friction, as accurate as double allows.
inline MotionSpec swinging_rods(const Rational& sample_interval = {1, 500}) {
    auto body = rods({{1, 2}, {0.25, 0.375}, {1, -2}, {3, 5}, 9.8}).cast<Quad>();
    body.friction.viscous = {Quad(1) / 100, Quad(1) / 200};
    MotionSpec spec;
    spec.chain = body.chain;
    spec.physical = body;
    spec.method = "taylor";
    spec.tolerance = parse_quad("1e-13");
    spec.sample_interval = sample_interval;
    return spec;
}

/// The file of encoders that show `offset` at rest.
inline std::string csv_of_motion(const MotionSpec& spec, int samples, double noise = 0, double offset = 0) {
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    const auto motion = make_motion(spec);
    std::string text = "time_s,theta1_rad,theta2_rad\n";
    for (int k = 0; k < samples; ++k) {
        if (k > 0) motion->advance(never_stop);
        const auto bobs = motion->observe().bobs;
        text +=
            fmt::format("{},{},{}\n", k * spec.sample_interval.value(), bobs[0].theta + offset + noise * normal(random),
                        bobs[1].theta - offset + noise * normal(random));
    }
    return text;
}

}  // namespace doppel::test
