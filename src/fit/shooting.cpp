#include "fit/shooting.hpp"

#include "base/error.hpp"
#include "base/threads.hpp"
#include "fit/flow.hpp"
#include "numeric/portable_math.hpp"
#include "track/regression.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

constexpr double least_damping = 1e-9;

/// A step of all unknowns.
struct Change {
    Eigen::VectorXd parameters;
    std::vector<Eigen::Vector4d> starts;
    double expected = 0;  // decrease of the cost
};

/// The damped normal equations of one segment, solved for its start.
struct Eliminated {
    Eigen::Matrix4d inverse;
    Eigen::MatrixXd mixed;
};

/// Solves a positive semidefinite system, scaled to ones on its diagonal.
Eigen::VectorXd solved(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& slope) {
    const Eigen::VectorXd scale = matrix.diagonal().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 0.0; });
    const Eigen::MatrixXd even = scale.asDiagonal() * matrix * scale.asDiagonal();
    Eigen::MatrixXd safe = even;
    for (Eigen::Index i = 0; i < safe.rows(); ++i)
        if (scale[i] == 0) safe(i, i) = 1;  // nothing depends on it
    return scale.asDiagonal() * safe.ldlt().solve(scale.asDiagonal() * slope);
}

Eigen::Matrix4d inverse_of_start(const SegmentSums& sums, double damping) {
    Eigen::Matrix4d matrix = sums.starts;
    matrix.diagonal() *= 1 + damping;
    // scaled, as rates and angles differ in size
    const Eigen::Vector4d scale = matrix.diagonal().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 0.0; });
    const Eigen::Matrix4d even = scale.asDiagonal() * matrix * scale.asDiagonal();
    return scale.asDiagonal() * even.ldlt().solve(Eigen::Matrix4d(scale.asDiagonal()));
}

Change step_of(const Fit& fit, double damping) {
    const auto count = static_cast<Eigen::Index>(fit.model.fitted.size());
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(count, count);
    Eigen::VectorXd slope = Eigen::VectorXd::Zero(count);
    std::vector<Eigen::Matrix4d> inverses;
    for (const auto& sums : fit.sums) {
        const auto& inverse = inverses.emplace_back(inverse_of_start(sums, damping));
        const Eigen::MatrixXd through = sums.mixed.transpose() * inverse;
        matrix += sums.shared - through * sums.mixed;
        matrix.diagonal() += damping * sums.shared.diagonal();
        slope += sums.shared_slope - through * sums.start_slope;
    }
    // friction at 0 that wants to be less stays there
    Change change;
    std::vector<bool> held(fit.model.fitted.size(), false);
    for (bool again = true; again;) {
        again = false;
        change.parameters = solved(matrix, slope);
        for (std::size_t k = 0; k < held.size(); ++k) {
            const auto parameter = fit.model.fitted[k];
            const auto place = static_cast<Eigen::Index>(k);
            const bool leaves = fit.model.is_bounded(parameter) && fit.parameters[index_of(parameter)] <= 0 &&
                                change.parameters[place] < 0;
            if (held[k] || !leaves) continue;
            held[k] = again = true;
            matrix.row(place).setZero();
            matrix.col(place).setZero();
            slope[place] = 0;
        }
    }
    // others that would pass 0 stop there
    for (std::size_t k = 0; k < held.size(); ++k) {
        const auto parameter = fit.model.fitted[k];
        auto& d = change.parameters[static_cast<Eigen::Index>(k)];
        if (fit.model.is_bounded(parameter)) d = std::max(d, -fit.parameters[index_of(parameter)]);
    }
    change.expected = 0.5 * change.parameters.dot(slope);
    for (std::size_t k = 0; k < fit.sums.size(); ++k) {
        const auto& sums = fit.sums[k];
        change.starts.push_back(inverses[k] * (sums.start_slope - sums.mixed * change.parameters));
        change.expected += 0.5 * sums.start_slope.dot(inverses[k] * sums.start_slope);
    }
    return change;
}

void apply(Fit& fit, const Change& change) {
    for (std::size_t k = 0; k < fit.model.fitted.size(); ++k)
        fit.parameters[index_of(fit.model.fitted[k])] += change.parameters[static_cast<Eigen::Index>(k)];
    fit.parameters = completed(fit.model, fit.parameters);
    for (std::size_t k = 0; k < fit.starts.size(); ++k)
        for (std::size_t q = 0; q < 4; ++q) fit.starts[k][q] += change.starts[k][static_cast<Eigen::Index>(q)];
}

/// Whether such arms exist: their energy of motion is positive, and the clock's lag small.
bool is_possible(const Parameters& p) {
    const double coupling = p[index_of(FitParameter::coupling)], inertia = p[index_of(FitParameter::inertia)];
    return inertia > coupling * coupling && std::abs(p[index_of(FitParameter::lag)]) < 0.05 &&
           p[index_of(FitParameter::scale_1)] > 0.5 && p[index_of(FitParameter::scale_2)] > 0.5;
}

/// Of each arm: 1.48 times the median size of its residuals, which a few wild ones do not move; no less than `least`.
void find_scale(Fit& fit) {
    for (std::size_t arm = 0; arm < 2; ++arm) {
        std::vector<double> sizes;
        for (const auto& r : fit.residuals)
            if (r.arm == arm) sizes.push_back(std::abs(r.residual));
        if (sizes.empty()) continue;
        const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
        std::nth_element(sizes.begin(), middle, sizes.end());
        constexpr double least = 1e-10;
        fit.rules.scale[arm] = std::max(1.4826 * *middle, least);
    }
}

/// Damped steps until the next would gain nothing that counts: less than a hundredth of what one standard error costs,
/// or than the share `relative` of the cost; or until `most` passes are spent.
void descend(const Track& track, const std::vector<TrackSegment>& segments, Fit& fit, double relative, int most,
             int jobs, const std::atomic<bool>& stop) {
    constexpr double enough = 0.005;
    double damping = 1e-8;
    Fit next;  // outside the loop, as its memory serves again
    for (int start = fit.passes; fit.passes - start < most;) {
        throw_if_set(stop);
        const auto change = step_of(fit, damping);
        if (change.expected < enough + relative * fit.cost) return;
        next.model = fit.model, next.rules = fit.rules, next.parameters = fit.parameters, next.starts = fit.starts;
        next.passes = fit.passes;
        apply(next, change);
        if (is_possible(next.parameters))
            evaluate_fit(track, segments, next, jobs, stop);
        else
            next.cost = std::numeric_limits<double>::infinity();
        fit.passes = next.passes;
        if (next.cost < fit.cost) {
            std::swap(fit, next);
            damping = std::max(damping / 10, least_damping);
        } else if (damping > 1e6) {
            return;
        } else {
            damping = std::max(damping * 30, 1e-5);
        }
    }
}

void note_bounds(Fit& fit) {
    fit.at_bound.clear();
    for (const auto parameter : fit.model.fitted)
        if (fit.model.is_bounded(parameter) && fit.parameters[index_of(parameter)] <= 0)
            fit.at_bound.push_back(parameter);
}

}  // namespace

std::vector<FitParameter> Fit::free() const {
    std::vector<FitParameter> all;
    for (const auto parameter : model.fitted)
        if (std::find(at_bound.begin(), at_bound.end(), parameter) == at_bound.end()) all.push_back(parameter);
    return all;
}

std::vector<Eigen::Index> Fit::free_places() const {
    std::vector<Eigen::Index> places;
    for (std::size_t k = 0; k < model.fitted.size(); ++k)
        if (std::find(at_bound.begin(), at_bound.end(), model.fitted[k]) == at_bound.end())
            places.push_back(static_cast<Eigen::Index>(k));
    return places;
}

void evaluate_fit(const Track& track, const std::vector<TrackSegment>& segments, Fit& fit, int jobs,
                  const std::atomic<bool>& stop, double block_s) {
    ++fit.passes;
    fit.sums.resize(segments.size());
    std::vector<std::size_t> begins(segments.size() + 1, 0);
    for (std::size_t k = 0; k < segments.size(); ++k) begins[k + 1] = begins[k] + residual_count(track, segments[k]);
    fit.residuals.resize(begins.back());
    parallel_for(segments.size(), jobs, [&](std::size_t k) {
        throw_if_set(stop);
        fit.sums[k] = evaluate_segment(track, fit.model, fit.rules, fit.parameters, fit.starts[k], segments[k], k,
                                       {fit.residuals.data() + begins[k], block_s});
    });
    double squares = 0;
    fit.cost = 0;
    for (const auto& sums : fit.sums) {  // in order, whoever computed them
        fit.cost += sums.cost;
        squares += sums.squares;
    }
    fit.rms = std::sqrt(squares / static_cast<double>(std::max<std::size_t>(fit.residuals.size(), 1)));
}

Reduced reduced(const SegmentSums& sums, const std::vector<Eigen::Index>& places) {
    const auto inverse = inverse_of_start(sums, 0);
    const Eigen::MatrixXd mixed = sums.mixed(Eigen::seqN(0, 4), places), through = mixed.transpose() * inverse;
    return {sums.shared(places, places) - through * mixed, sums.shared_slope(places) - through * sums.start_slope};
}

Fit moved(const Fit& fit, const std::vector<Eigen::Index>& places, const Eigen::VectorXd& change) {
    Change all;
    all.parameters = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(fit.model.fitted.size()));
    all.parameters(places) = change;
    for (std::size_t k = 0; k < fit.model.fitted.size(); ++k) {
        const auto parameter = fit.model.fitted[k];
        auto& d = all.parameters[static_cast<Eigen::Index>(k)];
        if (fit.model.is_bounded(parameter)) d = std::max(d, -fit.parameters[index_of(parameter)]);
    }
    for (const auto& sums : fit.sums)
        all.starts.push_back(inverse_of_start(sums, 0) * (sums.start_slope - sums.mixed * all.parameters));
    Fit result{.model = fit.model, .rules = fit.rules, .parameters = fit.parameters, .starts = fit.starts};
    apply(result, all);
    return result;
}

double step_error(const Track& track, const std::vector<TrackSegment>& segments, const Fit& fit,
                  const std::atomic<bool>& stop) {
    const auto arms = arms_of(fit.model, fit.parameters);
    double largest = 0;
    for (std::size_t k = 0; k < segments.size(); ++k) {
        throw_if_set(stop);
        const auto& times = track.pieces[segments[k].piece].time_s;
        const double length = times[segments[k].last - 1] - times[segments[k].first];
        Flow<double> whole(arms, fit.starts[k], fit.rules.step_s), half(arms, fit.starts[k], fit.rules.step_s / 2);
        constexpr int looks = 16;
        for (int look = 1; look <= looks; ++look) {
            const double t = length * look / looks;
            if (!whole.reach(t) || !half.reach(t)) return std::numeric_limits<double>::infinity();
            for (std::size_t arm = 0; arm < 2; ++arm)
                largest = std::max(largest, std::abs(whole.angle(arm, t) - half.angle(arm, t)));
        }
    }
    return largest;
}

Fit fit_model(const Track& track, const std::vector<TrackSegment>& segments, Fit start, const FitEffort& effort,
              const std::atomic<bool>& stop) {
    auto fit = std::move(start);
    fit.passes = 0;
    fit.parameters = completed(fit.model, fit.parameters);
    constexpr int rounds = 20;
    constexpr double least_step = 0.0005, settled = 0.1, roughly = 1e-4;
    const auto evaluate = [&] {
        evaluate_fit(track, segments, fit, effort.jobs, stop);
        // a start from which the motion ran away is guessed anew from the samples, and steps are finer
        while (!std::isfinite(fit.cost) && fit.rules.step_s > least_step) {
            for (std::size_t k = 0; k < segments.size(); ++k)
                if (!std::isfinite(fit.sums[k].cost)) fit.starts[k] = guessed_start(track, segments[k]);
            fit.rules.step_s /= 2;
            evaluate_fit(track, segments, fit, effort.jobs, stop);
        }
        if (!std::isfinite(fit.cost))
            throw method_failed(
                "{}: no double pendulum moves like this: from its own angles and rates the motion does not stay finite",
                track.pieces.front().name);
    };
    if (fit.sums.size() != segments.size() || fit.residuals.empty()) evaluate();
    bool is_settled = !effort.finds_scale;
    if (const auto before = fit.rules.scale; effort.finds_scale) {  // too small a scale is slow
        find_scale(fit);
        if (std::max(fit.rules.scale[0] / before[0], fit.rules.scale[1] / before[1]) > 2)
            evaluate();
        else
            fit.rules.scale = before;
    }
    for (int round = 0; round < rounds; ++round) {
        descend(track, segments, fit, is_settled ? effort.relative : std::max(effort.relative, roughly),
                std::max(effort.most_passes - fit.passes, 2), effort.jobs, stop);
        const double noise = std::min(fit.rules.scale[0], fit.rules.scale[1]);
        const bool is_coarse = is_settled && effort.finds_step && fit.rules.step_s > least_step &&
                               step_error(track, segments, fit, stop) > effort.step_share * noise;
        if (is_coarse) fit.rules.step_s /= 2;
        const bool was_settled = is_settled;
        if (effort.finds_scale && (!is_settled || is_coarse)) {
            const auto before = fit.rules.scale;
            find_scale(fit);
            is_settled = std::abs(portable_log(fit.rules.scale[0] / before[0])) +
                             std::abs(portable_log(fit.rules.scale[1] / before[1])) <
                         settled;
        }
        if (fit.passes >= effort.most_passes || (was_settled && !is_coarse)) break;
        evaluate();
    }
    note_bounds(fit);
    return fit;
}

}  // namespace doppel
