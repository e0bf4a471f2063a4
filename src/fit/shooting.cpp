#include "fit/shooting.hpp"

#include "base/error.hpp"
#include "base/threads.hpp"
#include "numeric/portable_math.hpp"
#include "track/regression.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>

namespace doppel {
namespace {

constexpr std::size_t no_unit = std::numeric_limits<std::size_t>::max();

/// The minimum of the model that a matrix and a slope make of the cost, where friction that would be less than 0 is 0.
Eigen::VectorXd bounded_change(const Fit& fit, Eigen::MatrixXd matrix, Eigen::VectorXd slope) {
    const auto& fitted = fit.model.fitted;
    std::vector<bool> held(fitted.size(), false);  // each once: what is not finite would ask for it for ever
    for (;;) {
        Eigen::VectorXd change = matrix.ldlt().solve(slope);
        bool again = false;
        for (std::size_t k = 0; k < held.size(); ++k) {
            const auto place = static_cast<Eigen::Index>(k);
            const double value = fit.of(fitted[k]);
            if (held[k]) change[place] = -value;
            if (held[k] || !fit.is_bounded(fitted[k]) || value + change[place] >= 0) continue;
            slope += matrix.col(place) * value;
            matrix.row(place).setZero(), matrix.col(place).setZero();
            matrix(place, place) = 1;
            slope[place] = -value;
            held[k] = again = true;
        }
        if (!again) return change;
    }
}

/// One damped step of all unknowns by the normal equations of the shots outside two units; `expected` receives by how much the
/// cost should fall.
Fit stepped(const Fit& fit, double damping, double& expected, std::size_t unit, std::size_t other) {
    const auto count = static_cast<Eigen::Index>(fit.model.fitted.size());
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(count, count);
    Eigen::VectorXd slope = Eigen::VectorXd::Zero(count);
    std::vector<Eigen::MatrixXd> of_starts;
    for (const auto& shot : fit.shots) {
        auto part = reduced(shot.sums, damping);
        of_starts.push_back(std::move(part.of_start));
        if (shot.unit == unit || shot.unit == other) continue;
        matrix += part.matrix;
        slope += part.slope;
    }
    const auto change = bounded_change(fit, matrix, slope);
    expected = change.dot(slope) - 0.5 * change.dot(matrix * change);
    Fit next = fit;
    next.is_evaluated = false;
    for (Eigen::Index k = 0; k < count; ++k)
        next.parameters[fit.model.fitted[static_cast<std::size_t>(k)]] += change[k];
    for (std::size_t k = 0; k < fit.shots.size(); ++k) {
        const auto& sums = fit.shots[k].sums;
        const ArmState own = sums.slope.head<4>();
        next.shots[k].start += of_starts[k] * (own - sums.matrix.topRightCorner(4, count) * change);
        expected += 0.5 * own.dot(of_starts[k] * own);
    }
    return next;
}

/// Whether such arms exist: their energy of motion is positive, they hang down, and the clock's lag is small.
bool is_possible(const Fit& fit) {
    return fit.of(inertia) > fit.of(coupling) * fit.of(coupling) && fit.of(coupling) > 0 && fit.of(gravity_1) > 0 &&
           fit.of(gravity_2) > 0 && std::abs(fit.of(lag)) < 0.05 && fit.of(scale_1) > 0.5 && fit.of(scale_2) > 0.5;
}

/// Of each arm: 1.48 times the median size of its residuals, which a few wild ones do not move; no less than `least`.
std::array<double, 2> scale_of(const Fit& fit) {
    constexpr double least = 1e-10;
    std::array<double, 2> scale{};
    for (std::size_t arm = 0; arm < 2; ++arm) {
        std::vector<double> sizes;
        for (const auto& shot : fit.shots)
            for (const auto& residual : shot.sums.residuals)
                if (!std::isnan(residual[arm])) sizes.push_back(std::abs(residual[arm]));
        scale[arm] = sizes.empty() ? fit.scale[arm] : std::max(1.4826 * median_size(std::move(sizes)), least);
    }
    return scale;
}

/// Damped steps until the next would gain nothing that counts: less than a hundredth of what one standard error costs,
/// or than the share `relative` of the cost; or until `most` passes are spent.
void descend(const FitJob& job, Fit& fit, double relative, int most) {
    constexpr double enough = 0.005, least_damping = 1e-9;
    double damping = 1e-8;
    for (int start = fit.passes; fit.passes - start < most;) {
        throw_if_set(job.stop);
        double expected = 0;
        auto next = stepped(fit, damping, expected, no_unit, no_unit);
        if (expected < enough + relative * fit.cost) return;
        next.cost = std::numeric_limits<double>::infinity();
        if (is_possible(next)) evaluate_fit(job, next);
        fit.passes = next.passes;
        if (next.cost < fit.cost) {
            fit = std::move(next);
            damping = std::max(damping / 10, least_damping);
        } else if (damping > 1e6) {
            return;
        } else {
            damping = std::max(damping * 30, 1e-5);
        }
    }
}

/// The largest change of a residual, rad, when the integrator's step is halved.
double step_error(const FitJob& job, const Fit& fit) {
    auto fine = fit;
    fine.model.fitted.clear();
    fine.step_s /= 2;
    evaluate_fit(job, fine);
    double largest = 0;
    for (std::size_t k = 0; k < fit.shots.size(); ++k)
        for (std::size_t i = 0; i < fit.shots[k].size(); ++i)
            for (std::size_t arm = 0; arm < 2; ++arm) {
                const double change = fine.shots[k].sums.residuals[i][arm] - fit.shots[k].sums.residuals[i][arm];
                if (std::abs(change) > largest) largest = std::abs(change);  // not where it is no number
            }
    return largest;
}

}  // namespace

std::size_t Fit::free_count() const {
    return static_cast<std::size_t>(std::count_if(model.fitted.begin(), model.fitted.end(),
                                                  [&](FitParameter parameter) { return !is_at_bound(parameter); }));
}

long Fit::residual_count() const {
    long count = 0;
    for (const auto& shot : shots) count += shot.sums.count;
    return count;
}

std::span<const Shot> Fit::unit(std::size_t number) const {
    const auto first = std::ranges::lower_bound(shots, number, {}, &Shot::unit);
    const auto last = std::ranges::upper_bound(shots, number, {}, &Shot::unit);
    return {first, last};
}

void evaluate_fit(const FitJob& job, Fit& fit, double block_s) {
    ++fit.passes;
    fit.is_evaluated = true;
    auto& p = fit.parameters;
    if (fit.model.point_masses) p[gravity_1] = p[inertia] * p[gravity_2] / p[coupling];
    parallel_for(fit.shots.size(), job.threads, [&](std::size_t k) {
        throw_if_set(job.stop);
        fit.shots[k].sums = evaluate_shot(job.track, fit, fit.shots[k], block_s);
    });
    double squares = 0;
    fit.cost = 0;
    for (const auto& shot : fit.shots) {  // in order, whoever computed them
        fit.cost += shot.sums.cost;
        squares += shot.sums.squares;
    }
    fit.rms = std::sqrt(squares / static_cast<double>(std::max(fit.residual_count(), 1L)));
}

Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& matrix) {
    return matrix.ldlt().solve(Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols()));
}

Reduced reduced(const ShotSums& sums, double damping) {
    const auto count = sums.matrix.rows() - 4;
    Eigen::MatrixXd matrix = sums.matrix;
    matrix.diagonal() *= 1 + damping;
    Reduced result{.of_start = inverse_of(matrix.topLeftCorner(4, 4)), .matrix = {}, .slope = {}};
    const Eigen::MatrixXd mixed = matrix.topRightCorner(4, count);
    const Eigen::MatrixXd through = mixed.transpose().lazyProduct(result.of_start);
    result.matrix = matrix.bottomRightCorner(count, count) - through.lazyProduct(mixed);
    result.slope = sums.slope.tail(count) - through.lazyProduct(sums.slope.head<4>());
    return result;
}

Fit fit_without(const Fit& fit, std::size_t unit, std::size_t other) {
    double expected = 0;
    return stepped(fit, 0, expected, unit, other);
}

ArmState guessed_start(const Track& track, std::size_t piece, std::size_t sample) {
    const auto seen = glimpse_at(track, track.pieces[piece], track.pieces[piece].time_s[sample]);
    return {seen.angle[0], seen.angle[1], seen.rate[0], seen.rate[1]};
}

std::optional<Fit> fit_starts(const FitJob& job, const Fit& fit, std::span<const Shot> shots, int most_passes,
                              double relative) {
    auto alone = fit;
    alone.is_evaluated = false;
    alone.model.fitted.clear();
    alone.shots.assign(shots.begin(), shots.end());
    try {
        return fit_model(job, std::move(alone),
                         {.most_passes = most_passes, .finds_scale = false, .step_share = 0, .relative = relative});
    } catch (const Error& error) {  // of these alone
        if (error.code() != ExitCode::method_failed) throw;
        return std::nullopt;
    }
}

Fit fit_model(const FitJob& job, Fit fit, const FitEffort& effort) {
    fit.passes = 0;
    constexpr int rounds = 20, some = 3;
    constexpr double least_step = 0.0005, settled = 0.1, roughly = 1e-4;
    const auto evaluate = [&] {
        evaluate_fit(job, fit);
        // a start from which the motion ran away is guessed anew from the samples, and steps are finer
        while (!std::isfinite(fit.cost) && fit.step_s > least_step) {
            for (auto& shot : fit.shots)
                if (!std::isfinite(shot.sums.cost)) shot.start = guessed_start(job.track, shot.piece, shot.first);
            fit.step_s /= 2;
            evaluate_fit(job, fit);
        }
        if (!std::isfinite(fit.cost))
            throw method_failed(
                "{}: no double pendulum moves like this: from its own angles and rates the motion does not stay finite",
                job.track.pieces.front().name);
    };
    if (!fit.is_evaluated) evaluate();
    bool is_settled = !effort.finds_scale;
    if (effort.finds_scale) {  // too small a scale is slow
        const auto scale = scale_of(fit), before = fit.scale;
        if (std::max(scale[0] / before[0], scale[1] / before[1]) > 2) {
            fit.scale = scale;
            evaluate();
        }
    }
    for (int round = 0; round < rounds; ++round) {
        descend(job, fit, is_settled ? effort.relative : std::max(effort.relative, roughly),
                std::max(effort.most_passes - fit.passes, 2));
        const double noise = std::min(fit.scale[0], fit.scale[1]);
        // a scale that does not settle may be that of the steps' errors
        const bool is_coarse = (is_settled || round > some) && effort.step_share > 0 && fit.step_s > least_step &&
                               step_error(job, fit) > effort.step_share * noise;
        if (fit.passes >= effort.most_passes || (is_settled && !is_coarse)) break;
        if (is_coarse) fit.step_s /= 2;
        if (effort.finds_scale) {
            const auto before = std::exchange(fit.scale, scale_of(fit));
            is_settled =
                std::abs(portable_log(fit.scale[0] / before[0])) + std::abs(portable_log(fit.scale[1] / before[1])) <
                settled;
        }
        evaluate();
    }
    return fit;
}

}  // namespace doppel
