#pragma once

#include "errors.hpp"
#include "fit/flow.hpp"
#include "fit/initial_fit.hpp"
#include "fit/result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

namespace doppel::test {

/// The links of a laboratory pendulum, about 17 cm and 29 cm long; optionally with all kinds of friction.
inline Parameters lab_arms(bool with_friction = true) {
    Parameters p = Parameters::Zero();
    p[inertia] = 1.8, p[coupling] = 0.88, p[gravity_1] = 106, p[gravity_2] = 50;
    p[scale_1] = p[scale_2] = 1;
    if (!with_friction) return p;
    p[viscous_1] = 0.08, p[viscous_2] = 0.03, p[coulomb_1] = 0.1, p[coulomb_2] = 0.06;
    p[quadratic_1] = 0.006, p[quadratic_2] = 0.005;
    return p;
}

/// The measurement of a motion.
struct Measuring {
    std::size_t pieces = 6;
    double piece_s = 2, hz = 100, noise = 0, amplitude = 1.5;
    unsigned seed = 1;
    double every_s = 0;  // > 0: one long motion with a piece measured at this interval; each piece has its own clock
};

/// A simulated track in steps of 1 ms, with an error of about 1e-11 rad without Coulomb friction.
inline Track simulated(const Parameters& truth, Drag drag, const Measuring& measuring) {
    constexpr double step = 0.001;
    const auto& [pieces, piece_s, hz, noise, amplitude, seed, every_s] = measuring;
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> even(-1, 1);
    Track track{.noise = {noise, noise}};
    LinkState start;
    for (std::size_t k = 0; k < pieces; ++k) {
        if (k == 0 || every_s == 0)
            start = {amplitude * even(random), amplitude * even(random), 4 * even(random), 4 * even(random)};
        auto& piece = track.pieces.emplace_back(TrackPiece{.name = "simulated.csv"});
        // the second angle is measured later by the lag: only then it needs a flow of its own
        std::vector<Flow<>> flows(truth[lag] == 0 ? 1 : 2, Flow<>({.drag = drag}, truth, start, step));
        const auto samples = static_cast<std::size_t>(std::lround(piece_s * hz)) + 1;
        for (std::size_t i = 0; i < samples; ++i) {
            piece.time_s.push_back(static_cast<double>(i) / hz);
            for (std::size_t arm = 0; arm < 2; ++arm) {
                const double t = piece.time_s[i] + static_cast<double>(arm) * truth[lag];
                auto& flow = flows[std::min(arm, flows.size() - 1)];
                flow.reach(t);
                piece.angle[arm].push_back(truth[offset_1 + arm] + flow.angle(arm, t)[0] + noise * normal(random));
                piece.is_outlier[arm].push_back(0);
            }
        }
        if (every_s > 0) {
            flows[0].reach(every_s);
            start = flows[0].values_at(every_s);
        }
    }
    return track;
}

/// A, B, C, D1, D2 of a pendulum, and its friction, divided by B: the inverse of fitted_pendulum().
inline Parameters ratios_of(const PhysicalPendulum<double>& pendulum) {
    const auto &m = pendulum.chain.mass, &a = pendulum.center, &i = pendulum.inertia;
    const double l1 = pendulum.chain.length[0], g = pendulum.chain.gravity, b = i[1] + m[1] * a[1] * a[1];
    Parameters p = Parameters::Zero();
    p.head<4>() << (i[0] + m[0] * a[0] * a[0] + m[1] * l1 * l1) / b, m[1] * l1 * a[1] / b,
        (m[0] * a[0] + m[1] * l1) * g / b, m[1] * a[1] * g / b;
    const auto take = [&](FitParameter first, const std::vector<double>& list) {
        for (std::size_t k = 0; k < list.size(); ++k) p[first + k] = list[k] / b;
    };
    const auto& friction = pendulum.friction;
    take(viscous_1, friction.viscous);
    take(coulomb_1, friction.coulomb);
    take(quadratic_1, friction.link_quadratic.empty() ? friction.air_quadratic : friction.link_quadratic);
    p[scale_1] = p[scale_2] = 1;
    return p;
}
inline PhysicalPendulum<double> pendulum_of(const FittedPendulum& fitted) {
    std::map<std::string, std::vector<double>> lists;
    for (const auto& [key, both] : fitted.links) lists[key] = {both[0], both[1]};
    return {.chain = {.mass = lists["mass_kg"], .length = lists["length_m"], .gravity = fitted.gravity},
            .center = lists["center_m"],
            .inertia = lists["inertia_kg_m2"],
            .friction = {.viscous = lists["joint_viscous_N_m_s"],
                         .coulomb = lists["joint_coulomb_N_m"],
                         .link_quadratic = lists["arm_drag_quadratic_N_m_s2"],
                         .air_quadratic = lists["air_drag_quadratic_N_m_s2"]}};
}
inline PhysicalPendulum<double> point_masses(double m1, double m2, double l1, double l2) {
    return physical(Pendulum<double>{.mass = {m1, m2}, .length = {l1, l2}, .angle = {}, .rate = {}, .gravity = 9.8});
}

/// Angles as in "simulate", with the events of Coulomb friction: `samples` of them at `hz` per second.
inline std::vector<std::array<double, 2>> simulated_angles(PhysicalPendulum<double> pendulum, const LinkState& start,
                                                           long hz, std::size_t samples) {
    pendulum.chain.angle = {start[0], start[1]}, pendulum.chain.rate = {start[2], start[3]};
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

/// The same with time reversed: every piece, and the order of the pieces.
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

/// The text of the piece's file.
inline std::string csv_of(const TrackPiece& piece) {
    std::string text = "time_s,theta1_rad,theta2_rad\n";
    for (std::size_t i = 0; i < piece.size(); ++i)
        text += fmt::format("{:.6f},{:.9f},{:.9f}\n", piece.time_s[i], piece.angle[0][i], piece.angle[1][i]);
    return text;
}

inline const std::atomic<bool> no_stop = false;

/// A fit with the true parameters and starts guessed from the samples; fitted() returns the result from there.
inline Fit fit_at(const ModelSpec& model, const Parameters& parameters, const Track& track) {
    return {.model = model, .parameters = parameters, .shots = divide(track)};
}
inline Fit fitted(const ModelSpec& model, const Parameters& parameters, const Track& track, FitEffort effort = {}) {
    return fit_model({track, no_stop, 2}, fit_at(model, parameters, track), effort).value();
}

inline FitResult answered(const Track& track, Bodies bodies = Bodies::automatic) {
    return analyse(track, {.bodies = bodies, .jobs = 2}, no_stop, [](const Progress&) {});
}

/// How the fit of a track from work() ends.
template <class Work>
Thrown ending(const Work& work, Bodies bodies = Bodies::automatic) {
    return thrown_by([&] { answered(work(), bodies); });
}

}  // namespace doppel::test
