#include "fit/start.hpp"

#include "base/error.hpp"
#include "track/regression.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>

namespace doppel {
namespace {

constexpr Eigen::Index unknowns = 6;  // two angles, two rates, two offsets
using Unknowns = Eigen::Matrix<double, unknowns, 1>;

constexpr Rational interval{1, 200};  // s, between the angles that are compared

/// What the encoders show at the first `count` moments of a motion: both arms' angles, moment by moment.
Eigen::VectorXd shown(MotionSpec spec, const Unknowns& x, std::size_t count, const std::atomic<bool>& stop) {
    spec.chain->angle = {Quad(x[0]), Quad(x[1])};
    spec.chain->rate = {Quad(x[2]), Quad(x[3])};
    if (spec.physical) spec.physical->chain = *spec.chain;
    const auto motion = make_motion(spec);
    Eigen::VectorXd angles(2 * static_cast<Eigen::Index>(count));
    for (Eigen::Index k = 0; k < angles.size(); k += 2) {
        if (k > 0) motion->advance(stop);
        const auto bobs = motion->observe().bobs;
        angles[k] = bobs[0].theta + x[4];
        angles[k + 1] = bobs[1].theta + x[5];
    }
    return angles;
}

/// Encoders are set to within a degree or so; where the motion does not tell better, that is all that is known.
Unknowns prior(double scale) {
    constexpr double likely_offset = 0.02;  // rad
    Unknowns weights = Unknowns::Zero();
    weights[4] = weights[5] = scale * scale / (likely_offset * likely_offset);
    return weights;
}

/// One Gauss–Newton step, with derivatives by central differences, halved until it leads down. The rms after it, rad.
double improve(const MotionSpec& spec, const Eigen::VectorXd& measured, Unknowns& x, const std::atomic<bool>& stop) {
    constexpr double small = 1e-4;
    const auto count = static_cast<std::size_t>(measured.size()) / 2;
    const auto rest_at = [&](const Unknowns& at) -> Eigen::VectorXd { return measured - shown(spec, at, count, stop); };
    const auto rms_of = [](const Eigen::VectorXd& rest) {
        return std::sqrt(rest.squaredNorm() / static_cast<double>(rest.size()));
    };
    const auto rest = rest_at(x);
    const double before = rms_of(rest);
    Eigen::MatrixXd slopes(measured.size(), unknowns);
    for (Eigen::Index q = 0; q < unknowns; ++q) {
        Unknowns up = x, down = x;
        up[q] += small;
        down[q] -= small;
        slopes.col(q) = (rest_at(down) - rest_at(up)) / (2 * small);
    }
    const Unknowns weights = prior(before);
    const Eigen::Matrix<double, unknowns, unknowns> normal =
        Eigen::Matrix<double, unknowns, unknowns>(slopes.transpose() * slopes) +
        Eigen::Matrix<double, unknowns, unknowns>(weights.asDiagonal());
    const Unknowns right = slopes.transpose() * rest - weights.cwiseProduct(x);
    Unknowns step = normal.ldlt().solve(right);
    for (int halving = 0; halving < 8 && step.allFinite(); ++halving, step /= 2) {
        const Unknowns tried = x + step;
        if (const double after = rms_of(rest_at(tried)); after < before) {
            x = tried;
            return after;
        }
    }
    return before;
}

}  // namespace

FittedStart fit_start(const MotionSpec& motion, const Replay& replay, const std::atomic<bool>& stop) {
    constexpr double longest_s = 2, followed = 0.1, settled = 0.999;
    constexpr int most_passes = 12;
    constexpr std::size_t first_count = 20;
    auto spec = motion;
    spec.sample_interval = interval;
    const double step = motion.sample_interval.value() / static_cast<double>(motion.steps_per_sample);
    spec.steps_per_sample = std::max(1L, std::lround(interval.value() / step));  // of fixed steps
    const auto most = 1 + static_cast<std::size_t>(std::min(longest_s, replay.length()) / interval.value());
    Eigen::VectorXd measured(2 * static_cast<Eigen::Index>(most));
    Unknowns x = Unknowns::Zero();
    for (std::size_t k = 0; k < most; ++k) {
        const double time = replay.start_s + static_cast<double>(k) * interval.value();
        const auto seen = glimpse_at(*replay.track, replay.samples(), time);
        const auto row = 2 * static_cast<Eigen::Index>(k);
        measured[row] = seen.angle[0], measured[row + 1] = seen.angle[1];
        if (k == 0) x << seen.angle[0], seen.angle[1], seen.rate[0], seen.rate[1], 0, 0;
    }
    FittedStart start;
    const auto keep = [&] { start.angle = {x[0], x[1]}, start.rate = {x[2], x[3]}, start.offset = {x[4], x[5]}; };
    keep();
    for (auto count = std::min(first_count, most);; count = std::min(2 * count, most)) {
        double rms = std::numeric_limits<double>::infinity();
        for (int pass = 0; pass < most_passes; ++pass) {
            const double before = rms;
            rms = improve(spec, measured.head(2 * static_cast<Eigen::Index>(count)), x, stop);
            if (rms > settled * before) break;
        }
        if (!(rms < followed)) return start;
        keep();
        start.seconds = static_cast<double>(count - 1) * interval.value(), start.rms = rms;
        if (count == most) return start;
    }
}

}  // namespace doppel
