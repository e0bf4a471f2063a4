#include "fit/start.hpp"

#include "base/error.hpp"
#include "numeric/solvers.hpp"
#include "track/regression.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace doppel {
namespace {

using Unknowns = Eigen::Matrix<double, 6, 1>;  // two angles, two rates, two offsets

/// The residuals of measured angles for the motion from a start, both links at each time.
using Rest = std::function<Eigen::VectorXd(const Eigen::VectorXd& measured, const Unknowns& x)>;

double rms_of(const Eigen::VectorXd& rest) {
    return std::sqrt(rest.squaredNorm() / static_cast<double>(rest.size()));
}

/// One Gauss–Newton step with derivatives by central differences, halved until the cost decreases. Returns the new rms,
/// rad.
double improve(const Rest& rest_of, const Eigen::VectorXd& measured, Unknowns& x) {
    // the prior of the offsets: encoders are aligned to within a degree or so
    constexpr double small = 1e-4, likely_offset = 0.02;  // rad
    const auto rest = rest_of(measured, x);
    const double before = rms_of(rest);
    Eigen::Matrix<double, Eigen::Dynamic, 6> slopes(measured.size(), 6);
    for (Eigen::Index q = 0; q < 6; ++q) {
        const Unknowns shift = small * Unknowns::Unit(q);
        slopes.col(q) = (rest_of(measured, x - shift) - rest_of(measured, x + shift)) / (2 * small);
    }
    Unknowns prior = Unknowns::Zero();
    prior.tail<2>().setConstant(before * before / (likely_offset * likely_offset));
    Eigen::Matrix<double, 6, 6> normal = slopes.transpose().lazyProduct(slopes);
    normal.diagonal() += prior;
    Unknowns step = slopes.transpose().lazyProduct(rest) - prior.cwiseProduct(x);
    solve_positive_definite(normal, step);
    for (int halving = 0; halving < 8 && step.allFinite(); ++halving, step /= 2)
        if (const double after = rms_of(rest_of(measured, x + step)); after < before) {
            x += step;
            return after;
        }
    return before;
}

}  // namespace

FittedStart fit_start(const MotionSpec& motion, const Replay& replay, const std::atomic<bool>& stop) {
    constexpr double longest_s = 2, followed = 0.1, settled = 0.999;
    constexpr int max_passes = 12;
    constexpr Eigen::Index first_count = 20;
    const Rational interval{1, 200};  // s, between the compared angles
    auto spec = motion;
    spec.sample_interval = interval;
    const double step = motion.sample_interval.value() / static_cast<double>(motion.steps_per_sample);
    spec.steps_per_sample = std::max(1L, std::lround(interval.value() / step));  // for methods with a fixed step
    const Rest rest_of = [&](const Eigen::VectorXd& measured, const Unknowns& x) {
        spec.chain->angle = {Quad(x[0]), Quad(x[1])};
        spec.chain->rate = {Quad(x[2]), Quad(x[3])};
        if (spec.physical) spec.physical->chain = *spec.chain;
        const auto moving = make_motion(spec);
        Eigen::VectorXd rest = measured;
        for (Eigen::Index k = 0; k < rest.size(); k += 2) {
            if (k > 0) moving->advance(stop);
            const auto bobs = moving->observe().bobs;
            for (std::size_t link = 0; link < 2; ++link) rest[k + link] -= bobs[link].theta + x[4 + link];
        }
        return rest;
    };
    const auto maximum = 1 + static_cast<Eigen::Index>(std::min(longest_s, replay.length()) / interval.value());
    Eigen::VectorXd measured(2 * maximum);
    Unknowns x = Unknowns::Zero();
    for (Eigen::Index k = maximum; k-- > 0;) {
        const double time = replay.start_s + static_cast<double>(k) * interval.value();
        const auto [one, two] = estimate_at(*replay.track, replay.samples(), time);
        x.head<4>() << one.angle, two.angle, one.rate, two.rate;
        measured.segment<2>(2 * k) = x.head<2>();
    }
    FittedStart start{.angle = {x[0], x[1]}, .rate = {x[2], x[3]}};
    for (auto count = std::min(first_count, maximum);; count = std::min(2 * count, maximum)) {
        double rms = std::numeric_limits<double>::infinity(), before = rms;
        for (int pass = 0; pass < max_passes && (pass == 0 || rms <= settled * before); ++pass) {
            before = rms;
            rms = improve(rest_of, measured.head(2 * count), x);
        }
        if (!(rms < followed)) return start;
        start = {{x[0], x[1]}, {x[2], x[3]}, {x[4], x[5]}, static_cast<double>(count - 1) * interval.value(), rms};
        if (count == maximum) return start;
    }
}

}  // namespace doppel
