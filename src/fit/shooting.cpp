#include "fit/shooting.hpp"

#include "base/error.hpp"
#include "base/threads.hpp"
#include "numeric/portable_math.hpp"
#include "track/regression.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

/// A step of all unknowns.
struct Change {
    Eigen::VectorXd parameters;
    std::vector<Eigen::Vector4d> starts;
    double expected = 0;  // decrease of the cost
};

/// The minimum of the model that a matrix and a slope make of the cost, where friction that would be less than 0 is 0.
Eigen::VectorXd bounded_change(const Fit& fit, const Eigen::MatrixXd& matrix, const Eigen::VectorXd& slope) {
    Eigen::MatrixXd left = matrix;
    Eigen::VectorXd right = slope, change;
    std::vector<bool> held(fit.model.fitted.size(), false);  // each once: what is not finite would ask for it for ever
    for (bool again = true; again;) {
        again = false;
        change = left.ldlt().solve(right);
        for (std::size_t k = 0; k < held.size(); ++k) {
            const auto parameter = fit.model.fitted[k];
            const auto place = static_cast<Eigen::Index>(k);
            if (held[k] || !fit.model.is_bounded(parameter) || fit.of(parameter) + change[place] >= 0) continue;
            right += left.col(place) * fit.of(parameter);
            left.row(place).setZero(), left.col(place).setZero();
            left(place, place) = 1;
            right[place] = -fit.of(parameter);
            held[k] = again = true;
        }
        for (std::size_t k = 0; k < held.size(); ++k)
            if (held[k]) change[static_cast<Eigen::Index>(k)] = -fit.of(fit.model.fitted[k]);
    }
    return change;
}

Change step_of(const Fit& fit, double damping, const std::vector<std::size_t>& without = {}) {
    const auto count = static_cast<Eigen::Index>(fit.model.fitted.size());
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(count, count);
    Eigen::VectorXd slope = Eigen::VectorXd::Zero(count);
    std::vector<Eigen::MatrixXd> of_starts;
    for (std::size_t k = 0; k < fit.sums.size(); ++k) {
        auto part = reduced(fit.sums[k], damping);
        of_starts.push_back(std::move(part.of_start));
        if (std::find(without.begin(), without.end(), k) != without.end()) continue;
        matrix += part.matrix;
        slope += part.slope;
    }
    Change change{.parameters = bounded_change(fit, matrix, slope), .starts = {}};
    const auto& d = change.parameters;
    change.expected = d.dot(slope) - 0.5 * d.dot(matrix * d);
    for (std::size_t k = 0; k < fit.sums.size(); ++k) {
        const auto& sums = fit.sums[k];
        const Eigen::Vector4d own = sums.slope.head<4>();
        change.starts.push_back(of_starts[k] * (own - sums.matrix.topRightCorner(4, count) * d));
        change.expected += 0.5 * own.dot(of_starts[k] * own);
    }
    return change;
}

Fit changed(const Fit& fit, const Change& change) {
    Fit next = fit.without_sums();
    for (std::size_t k = 0; k < fit.model.fitted.size(); ++k)
        next.parameters[index_of(fit.model.fitted[k])] += change.parameters[static_cast<Eigen::Index>(k)];
    next.parameters = completed(fit.model, next.parameters);
    for (std::size_t k = 0; k < fit.starts.size(); ++k)
        for (std::size_t q = 0; q < 4; ++q) next.starts[k][q] += change.starts[k][static_cast<Eigen::Index>(q)];
    return next;
}

/// Whether such arms exist: their energy of motion is positive, and the clock's lag small.
bool is_possible(const Fit& fit) {
    using enum FitParameter;
    return fit.of(inertia) > fit.of(coupling) * fit.of(coupling) && std::abs(fit.of(lag)) < 0.05 &&
           fit.of(scale_1) > 0.5 && fit.of(scale_2) > 0.5;
}

/// Of each arm: 1.48 times the median size of its residuals, which a few wild ones do not move; no less than `least`.
std::array<double, 2> scale_of(const Fit& fit) {
    constexpr double least = 1e-10;
    std::array<double, 2> scale{};
    for (std::size_t arm = 0; arm < 2; ++arm) {
        std::vector<double> sizes;
        for (const auto& sums : fit.sums)
            for (const auto& residual : sums.residuals)
                if (!std::isnan(residual[arm])) sizes.push_back(std::abs(residual[arm]));
        scale[arm] = sizes.empty() ? fit.rules.scale[arm] : std::max(1.4826 * median_size(std::move(sizes)), least);
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
        const auto change = step_of(fit, damping);
        if (change.expected < enough + relative * fit.cost) return;
        auto next = changed(fit, change);
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
    fine.rules.step_s /= 2;
    evaluate_fit(job, fine);
    double largest = 0;
    for (std::size_t k = 0; k < fit.segments.size(); ++k)
        for (std::size_t i = 0; i < fit.segments[k].size(); ++i)
            for (std::size_t arm = 0; arm < 2; ++arm) {
                const double change = fine.sums[k].residuals[i][arm] - fit.sums[k].residuals[i][arm];
                if (std::abs(change) > largest) largest = std::abs(change);  // not where it is no number
            }
    return largest;
}

}  // namespace

std::size_t Fit::free_count() const {
    return static_cast<std::size_t>(std::count_if(model.fitted.begin(), model.fitted.end(),
                                                  [&](FitParameter parameter) { return !is_at_bound(parameter); }));
}

Fit Fit::without_sums() const {
    Fit other{
        .model = model, .rules = rules, .parameters = parameters, .segments = segments, .starts = starts, .sums = {}};
    other.passes = passes;
    return other;
}

long Fit::residual_count() const {
    long count = 0;
    for (const auto& segment : sums) count += segment.count;
    return count;
}

void evaluate_fit(const FitJob& job, Fit& fit, double block_s) {
    ++fit.passes;
    fit.sums.resize(fit.segments.size());
    parallel_for(fit.segments.size(), job.threads, [&](std::size_t k) {
        throw_if_set(job.stop);
        fit.sums[k] =
            evaluate_segment(job.track, fit.segments[k], fit.model, fit.rules, fit.parameters, fit.starts[k], block_s);
    });
    double squares = 0;
    fit.cost = 0;
    for (const auto& sums : fit.sums) {  // in order, whoever computed them
        fit.cost += sums.cost;
        squares += sums.squares;
    }
    fit.rms = std::sqrt(squares / static_cast<double>(std::max(fit.residual_count(), 1L)));
}

Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& matrix) {
    return matrix.ldlt().solve(Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols()));
}

Reduced reduced(const SegmentSums& sums, double damping) {
    const auto count = sums.matrix.rows() - 4;
    Eigen::MatrixXd matrix = sums.matrix;
    matrix.diagonal() *= 1 + damping;
    Reduced result{.of_start = inverse_of(matrix.topLeftCorner(4, 4)), .matrix = {}, .slope = {}};
    const Eigen::MatrixXd mixed = matrix.topRightCorner(4, count), through = mixed.transpose() * result.of_start;
    result.matrix = matrix.bottomRightCorner(count, count) - through * mixed;
    result.slope = sums.slope.tail(count) - through * sums.slope.head<4>();
    return result;
}

Fit fit_without(const Fit& fit, const std::vector<std::size_t>& segments) {
    return changed(fit, step_of(fit, 0, segments));
}

ArmState<double> guessed_start(const Track& track, const TrackSegment& segment) {
    const auto& piece = track.pieces[segment.piece];
    const auto seen = glimpse_at(track, piece, piece.time_s[segment.first]);
    return {seen.angle[0], seen.angle[1], seen.rate[0], seen.rate[1]};
}

Fit fit_model(const FitJob& job, Fit fit, const FitEffort& effort) {
    fit.passes = 0;
    fit.parameters = completed(fit.model, fit.parameters);
    constexpr int rounds = 20, some = 3;
    constexpr double least_step = 0.0005, settled = 0.1, roughly = 1e-4;
    const auto evaluate = [&] {
        evaluate_fit(job, fit);
        // a start from which the motion ran away is guessed anew from the samples, and steps are finer
        while (!std::isfinite(fit.cost) && fit.rules.step_s > least_step) {
            for (std::size_t k = 0; k < fit.segments.size(); ++k)
                if (!std::isfinite(fit.sums[k].cost)) fit.starts[k] = guessed_start(job.track, fit.segments[k]);
            fit.rules.step_s /= 2;
            evaluate_fit(job, fit);
        }
        if (!std::isfinite(fit.cost))
            throw method_failed(
                "{}: no double pendulum moves like this: from its own angles and rates the motion does not stay finite",
                job.track.pieces.front().name);
    };
    if (fit.sums.empty()) evaluate();
    bool is_settled = !effort.finds_scale;
    if (effort.finds_scale) {  // too small a scale is slow
        const auto scale = scale_of(fit), before = fit.rules.scale;
        if (std::max(scale[0] / before[0], scale[1] / before[1]) > 2) {
            fit.rules.scale = scale;
            evaluate();
        }
    }
    for (int round = 0; round < rounds; ++round) {
        descend(job, fit, is_settled ? effort.relative : std::max(effort.relative, roughly),
                std::max(effort.most_passes - fit.passes, 2));
        const double noise = std::min(fit.rules.scale[0], fit.rules.scale[1]);
        // a scale that does not settle may be that of the steps' errors
        const bool is_coarse = (is_settled || round > some) && effort.step_share > 0 && fit.rules.step_s > least_step &&
                               step_error(job, fit) > effort.step_share * noise;
        if (fit.passes >= effort.most_passes || (is_settled && !is_coarse)) break;
        if (is_coarse) fit.rules.step_s /= 2;
        if (effort.finds_scale) {
            const auto before = std::exchange(fit.rules.scale, scale_of(fit));
            is_settled = std::abs(portable_log(fit.rules.scale[0] / before[0])) +
                             std::abs(portable_log(fit.rules.scale[1] / before[1])) <
                         settled;
        }
        evaluate();
    }
    return fit;
}

}  // namespace doppel
