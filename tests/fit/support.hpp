#pragma once

#include "fit/flow.hpp"
#include "fit/ladder.hpp"
#include "fit/physical.hpp"
#include "integrate/motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace doppel::test {

using enum FitParameter;

inline double& at(Parameters& parameters, FitParameter parameter) {
    return parameters[index_of(parameter)];
}

/// A laboratory's arms, some 17 cm and 29 cm long; with friction of all kinds.
inline Parameters lab_arms(bool with_friction = true) {
    Parameters p{};
    at(p, inertia) = 1.8, at(p, coupling) = 0.88, at(p, gravity_1) = 106, at(p, gravity_2) = 50;
    at(p, scale_1) = at(p, scale_2) = 1;
    if (!with_friction) return p;
    at(p, viscous_1) = 0.08, at(p, viscous_2) = 0.03, at(p, coulomb_1) = 0.1, at(p, coulomb_2) = 0.06;
    at(p, quadratic_1) = 0.006, at(p, quadratic_2) = 0.005;
    return p;
}

/// How a swing is measured.
struct Measuring {
    std::size_t pieces = 6;
    double piece_s = 2, hz = 100, noise = 0, amplitude = 1.5;
    unsigned seed = 1;
    double every_s = 0;  // > 0: one swing, of which a piece is measured every so often; each with a clock of its own
};

/// A simulated track: steps of a millisecond, whose own error is some 1e-11 rad without dry friction.
inline Track simulated(const Parameters& truth, Drag drag, const Measuring& measuring) {
    constexpr double step = 0.001;
    std::mt19937_64 random(measuring.seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> even(-1, 1);
    Arms<double> arms{.p = {}, .drag = drag};
    std::copy_n(truth.begin(), dynamic_count, arms.p.begin());
    Track track;
    ArmState<double> start{};
    for (std::size_t k = 0; k < measuring.pieces; ++k) {
        if (k == 0 || measuring.every_s == 0)
            start = {measuring.amplitude * even(random), measuring.amplitude * even(random), 4 * even(random),
                     4 * even(random)};
        TrackPiece piece{.name = "simulated.csv", .time_s = {}, .angle = {}, .is_outlier = {}};
        Flow<double> flow(arms, start, step);
        const auto samples = static_cast<std::size_t>(std::lround(measuring.piece_s * measuring.hz)) + 1;
        for (std::size_t i = 0; i < samples; ++i) {
            const double t = static_cast<double>(i) / measuring.hz;
            flow.reach(t);
            piece.time_s.push_back(t);
            for (std::size_t arm = 0; arm < 2; ++arm)
                piece.angle[arm].push_back(truth[index_of(offset_1) + arm] + flow.angle(arm, t) +
                                           measuring.noise * normal(random));
        }
        for (auto& outliers : piece.is_outlier) outliers.assign(samples, 0);
        track.pieces.push_back(std::move(piece));
        if (measuring.every_s > 0) {
            flow.reach(measuring.every_s);
            start = flow.state();  // at the end of a step that holds this time: a multiple of the step
        }
    }
    track.noise = {measuring.noise, measuring.noise};
    return track;
}

/// Angles as "simulate" has them, sharp dry friction with its events: `samples` of them at `hz` a second.
inline std::vector<std::array<double, 2>> simulated_angles(const FittedPendulum& made, const ArmState<double>& start,
                                                           long hz, std::size_t samples) {
    const auto list = [](const std::array<double, 2>& pair) { return std::vector<double>{pair[0], pair[1]}; };
    PhysicalPendulum<double> pendulum;
    pendulum.chain = {list(made.mass), list(made.length), {start[0], start[1]}, {start[2], start[3]}};
    pendulum.chain.gravity = made.gravity;
    pendulum.center = list(made.center), pendulum.inertia = list(made.inertia);
    pendulum.friction.viscous = list(made.viscous), pendulum.friction.coulomb = list(made.coulomb);
    pendulum.friction.arm_quadratic = list(made.quadratic);
    MotionSpec spec;
    spec.chain = pendulum.chain.cast<Quad>();
    spec.physical = pendulum.cast<Quad>();
    spec.method = "dop853";
    spec.tolerance = Quad(1e-12);
    spec.sample_interval = {1, hz};
    const auto motion = make_motion(spec);
    const std::atomic<bool> never = false;
    std::vector<std::array<double, 2>> angles;
    for (std::size_t i = 0; i < samples; ++i) {
        if (i > 0) motion->advance(never);
        const auto bobs = motion->observe().bobs;
        angles.push_back({bobs[0].theta, bobs[1].theta});
    }
    return angles;
}

/// Every piece, and the order of pieces, backwards in time.
inline Track reversed(Track track) {
    std::reverse(track.pieces.begin(), track.pieces.end());
    for (auto& piece : track.pieces) {
        const double sum = piece.time_s.front() + piece.time_s.back();
        std::reverse(piece.time_s.begin(), piece.time_s.end());
        for (auto& t : piece.time_s) t = sum - t;
        for (std::size_t arm = 0; arm < 2; ++arm) {
            std::reverse(piece.angle[arm].begin(), piece.angle[arm].end());
            std::reverse(piece.is_outlier[arm].begin(), piece.is_outlier[arm].end());
        }
    }
    return track;
}

/// As a file has it.
inline std::string csv_of(const TrackPiece& piece) {
    std::string text = "time_s,theta1_rad,theta2_rad\n";
    for (std::size_t i = 0; i < piece.size(); ++i)
        text += fmt::format("{:.6f},{:.9f},{:.9f}\n", piece.time_s[i], piece.angle[0][i], piece.angle[1][i]);
    return text;
}

/// A fit that stands at the truth, its starts guessed from the samples.
inline Fit fit_at(const ModelSpec& model, const Parameters& parameters, const Track& track, const Division& division) {
    Fit fit{};
    fit.model = model;
    fit.parameters = parameters;
    for (const auto& segment : division.segments) {
        const auto& piece = track.pieces[segment.piece];
        const auto slope = [&](std::size_t arm) {
            const auto& x = piece.angle[arm];
            return (x[segment.first + 1] - x[segment.first]) /
                   (piece.time_s[segment.first + 1] - piece.time_s[segment.first]);
        };
        fit.starts.push_back({piece.angle[0][segment.first], piece.angle[1][segment.first], slope(0), slope(1)});
    }
    return fit;
}

inline const std::atomic<bool> no_stop = false;

}  // namespace doppel::test
