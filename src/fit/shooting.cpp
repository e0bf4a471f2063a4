#include "fit/shooting.hpp"

#include "base/threads.hpp"
#include "fit/flow.hpp"
#include "numeric/portable_math.hpp"
#include "track/regression.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace doppel {
namespace {

/// The sums of a shot with N derivatives: by its start, or also by all parameters.
template <int N>
ShotSums evaluate(const Track& track, const Fit& fit, const Shot& shot, double block_s) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    constexpr int size = N == start_directions ? 5 : ShotSums::Row::SizeAtCompileTime;
    const auto& piece = track.pieces[shot.piece];
    const auto& p = fit.parameters;
    const auto& fitted = fit.model.fitted;
    Flow<N> flow(fit.model, p, shot.start, fit.step_s);
    ShotSums sums;
    sums.residuals.assign(shot.size(), {none, none});
    Eigen::Matrix<double, size, Eigen::Dynamic> rows(size, 2 * shot.size());
    ShotSums::Row row = ShotSums::Row::Zero();
    const auto read = [&](std::size_t sample, std::size_t link, double t) {
        const auto angle = flow.angle(link, t);
        const double scale = p[scale_1 + link];
        const double residual = piece.angle[link][sample] - (p[offset_1 + link] + scale * angle[0]);
        row.template head<4>() = scale * angle.template segment<4>(1);
        row[4] = residual;
        if constexpr (size > 5) {
            row.template segment<dynamic_count>(5) = scale * angle.template tail<dynamic_count>();
            row.template tail<parameter_count - dynamic_count>().setZero();
            row[5 + offset_1 + link] = fitted[offset_1 + link];
            if (fitted[scale_1 + link]) row[5 + scale_1 + link] = angle[0];
            if (fitted[lag] && link == 1) row[5 + lag] = scale * flow.rate(1, t);
        }
        const double unit = fit.scale[link], magnitude = std::abs(residual / unit), bend = Fit::bend;
        const bool beyond = magnitude > bend;
        sums.cost += beyond ? bend * magnitude - 0.5 * bend * bend : 0.5 * magnitude * magnitude;
        sums.bounded += beyond ? bend * bend : magnitude * magnitude;
        sums.squares += residual * residual;
        sums.beyond += beyond;
        sums.residuals[sample - shot.first][link] = residual;
        row *= std::sqrt(beyond ? bend / magnitude : 1) / unit;
        rows.col(sums.count++) = row.template head<size>();
        if (block_s > 0) sums.blocks.back() += row[4] * row;
    };
    for (std::size_t sample = shot.first; sample < shot.last; ++sample) {
        const double t = piece.time_s[sample] - piece.time_s[shot.first];
        while (block_s > 0 && static_cast<double>(sums.blocks.size()) * block_s <= t)
            sums.blocks.emplace_back(ShotSums::Row::Zero());
        for (std::size_t link = 0; link < 2 && std::isfinite(sums.cost); ++link) {
            const double at = link == 1 ? t + p[lag] : t;
            if (piece.is_outlier[link][sample]) continue;
            if (flow.reach(at))
                read(sample, link, at);
            else
                sums.cost = std::numeric_limits<double>::infinity();
        }
    }
    if (!std::isfinite(sums.cost)) sums.cost = sums.squares = std::numeric_limits<double>::infinity();
    Eigen::Matrix<double, size, size> lower = decltype(lower)::Zero();
    lower.template selfadjointView<Eigen::Lower>().rankUpdate(rows.leftCols(sums.count));
    sums.normal.template topLeftCorner<size, size>() = lower.template selfadjointView<Eigen::Lower>();
    return sums;
}

/// The minimum of the quadratic model of the cost given by its matrix and slope. Friction that would become negative is
/// held at 0.
Parameters bounded_change(const Fit& fit, ParameterMatrix matrix, Parameters slope) {
    std::bitset<parameter_count> held;  // each at most once: numbers that are not finite would repeat for ever
    for (;;) {
        Parameters change = inverse_of(matrix).lazyProduct(slope);
        bool again = false;
        for (std::size_t k = 0; k < parameter_count; ++k) {
            const double value = fit.parameters[k];
            if (held[k]) change[k] = -value;
            if (held[k] || !fit.is_bounded(k) || value + change[k] >= 0) continue;
            slope += matrix.col(k) * value;
            matrix.row(k).setZero(), matrix.col(k).setZero();
            matrix(k, k) = 1;
            slope[k] = -value;
            held[k] = again = true;
        }
        if (!again) return change;
    }
}

/// Whether such links can exist: their kinetic energy is positive, they hang down, and the lag is small.
bool is_possible(const Parameters& p) {
    return p[inertia] > p[coupling] * p[coupling] && p[coupling] > 0 && p[gravity_1] > 0 && p[gravity_2] > 0 &&
           std::abs(p[lag]) < 0.05 && p[scale_1] > 0.5 && p[scale_2] > 0.5;
}

/// For each link 1.48 times the median size of its residuals, which is insensitive to outliers; at least `minimum`.
std::array<double, 2> scale_of(const Fit& fit) {
    constexpr double minimum = 1e-10;
    std::array<double, 2> scale{};
    for (std::size_t link = 0; link < 2; ++link) {
        std::vector<double> sizes;
        for (const auto& shot : fit.shots)
            for (const auto& residual : shot.sums.residuals)
                if (!std::isnan(residual[link])) sizes.push_back(std::abs(residual[link]));
        scale[link] = sizes.empty() ? fit.scale[link] : std::max(1.4826 * median_size(std::move(sizes)), minimum);
    }
    return scale;
}

/// Damped steps until the expected gain is negligible: less than a hundredth of that of one standard error, or than
/// `relative` of the cost. Takes at most `maximum` passes.
void descend(const FitJob& job, Fit& fit, double relative, int maximum) {
    constexpr double negligible = 0.005, min_damping = 1e-9;
    double damping = 1e-8;
    for (int start = fit.passes; fit.passes - start < maximum;) {
        throw_if_set(job.stop);
        auto next = stepped(fit, damping, no_unit, no_unit);
        if (fit.cost - next.cost < negligible + relative * fit.cost) return;
        next.cost = std::numeric_limits<double>::infinity();
        if (is_possible(next.parameters)) evaluate_fit(job, next);
        fit.passes = next.passes;
        if (next.cost < fit.cost) {
            fit = std::move(next);
            damping = std::max(damping / 10, min_damping);
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
    fine.model.fitted.reset();
    fine.step_s /= 2;
    evaluate_fit(job, fine);
    double largest = 0;
    for (std::size_t k = 0; k < fit.shots.size(); ++k)
        for (std::size_t i = 0; i < fit.shots[k].size(); ++i)
            for (std::size_t link = 0; link < 2; ++link)  // a comparison with NaN is false
                largest = std::max(
                    largest, std::abs(fine.shots[k].sums.residuals[i][link] - fit.shots[k].sums.residuals[i][link]));
    return largest;
}

}  // namespace

std::size_t Fit::free_count() const {
    std::size_t count = 0;
    for (const auto k : model.list()) count += !is_at_bound(k);
    return count;
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
    const auto sums_of = fit.model.fitted.none() ? evaluate<start_directions> : evaluate<all_directions>;
    parallel_for(fit.shots.size(), job.threads, [&](std::size_t k) {
        throw_if_set(job.stop);
        fit.shots[k].sums = sums_of(job.track, fit, fit.shots[k], block_s);
    });
    double squares = 0;
    fit.cost = 0;
    for (const auto& shot : fit.shots) {  // in order, whichever thread computed them
        fit.cost += shot.sums.cost;
        squares += shot.sums.squares;
    }
    fit.rms = std::sqrt(squares / static_cast<double>(std::max(fit.residual_count(), 1L)));
}

Eigen::Matrix4d ShotSums::inverse_of_start(double damping) const {
    Eigen::Matrix4d matrix = normal.topLeftCorner<4, 4>();
    matrix.diagonal() *= 1 + damping;
    return inverse_of(matrix);
}

Eigen::Matrix<double, 1 + parameter_count, 1 + parameter_count> ShotSums::reduced(double damping) const {
    auto all = normal;
    all.diagonal() *= 1 + damping;
    const auto below = all.bottomLeftCorner<1 + parameter_count, 4>();
    return all.bottomRightCorner<1 + parameter_count, 1 + parameter_count>() -
           (below * inverse_of_start(damping)).eval().lazyProduct(below.transpose());
}

Fit stepped(const Fit& fit, double damping, std::size_t without, std::size_t other) {
    Eigen::Matrix<double, 1 + parameter_count, 1 + parameter_count> sum = decltype(sum)::Zero();
    for (const auto& shot : fit.shots)
        if (shot.unit != without && shot.unit != other) sum += shot.sums.reduced(damping);
    const ParameterMatrix matrix = sum.bottomRightCorner<parameter_count, parameter_count>();
    const Parameters slope = sum.col(0).tail<parameter_count>();
    const auto change = bounded_change(fit, matrix, slope);
    Fit next = fit;
    next.is_evaluated = false;
    next.parameters += change;
    next.cost -= change.dot(slope) - 0.5 * change.dot(matrix.lazyProduct(change));
    for (auto& shot : next.shots) {
        const auto of_start = shot.sums.inverse_of_start(damping);
        const LinkState own = shot.sums.normal.col(4).head<4>();
        shot.start += of_start * (own - shot.sums.normal.topRightCorner<4, parameter_count>() * change);
        next.cost -= 0.5 * own.dot(of_start * own);
    }
    return next;
}

LinkState estimated_start(const Track& track, std::size_t piece, std::size_t sample) {
    const auto [one, two] = estimate_at(track, track.pieces[piece], track.pieces[piece].time_s[sample]);
    return {one.angle, two.angle, one.rate, two.rate};
}

std::optional<Fit> fit_starts(const FitJob& job, const Fit& fit, std::span<const Shot> shots, int max_passes,
                              double relative) {
    auto alone = fit;
    alone.is_evaluated = false;
    alone.model.fitted.reset();
    alone.shots.assign(shots.begin(), shots.end());
    return fit_model(job, std::move(alone),
                     {.max_passes = max_passes, .finds_scale = false, .step_share = 0, .relative = relative});
}

Error no_motion(const Track& track) {
    return method_failed(
        "{}: this is not the motion of a double pendulum: from its angles and rates the simulation does not stay "
        "finite",
        track.pieces.front().name);
}

std::optional<Fit> fit_model(const FitJob& job, Fit fit, const FitEffort& effort) {
    fit.passes = 0;
    constexpr int rounds = 20, some = 3;
    constexpr double min_step = 0.0005, settled = 0.1, roughly = 1e-4;
    // starts from which the motion diverged are estimated again from the samples, and steps become finer
    const auto evaluate = [&] {
        for (evaluate_fit(job, fit); !std::isfinite(fit.cost) && fit.step_s > min_step; evaluate_fit(job, fit)) {
            for (auto& shot : fit.shots)
                if (!std::isfinite(shot.sums.cost)) shot.start = estimated_start(job.track, shot.piece, shot.first);
            fit.step_s /= 2;
        }
        return std::isfinite(fit.cost);
    };
    if (!fit.is_evaluated && !evaluate()) return std::nullopt;
    bool is_settled = !effort.finds_scale;
    if (effort.finds_scale) {  // a scale that is too small is slow
        const auto before = std::exchange(fit.scale, scale_of(fit));
        if (std::max(fit.scale[0] / before[0], fit.scale[1] / before[1]) <= 2)
            fit.scale = before;
        else if (!evaluate())
            return std::nullopt;
    }
    for (int round = 0; round < rounds; ++round) {
        descend(job, fit, is_settled ? effort.relative : std::max(effort.relative, roughly),
                std::max(effort.max_passes - fit.passes, 2));
        const double noise = std::min(fit.scale[0], fit.scale[1]);
        // if the scale does not settle, it may be that of the integration errors
        const bool is_coarse = (is_settled || round > some) && effort.step_share > 0 && fit.step_s > min_step &&
                               step_error(job, fit) > effort.step_share * noise;
        if (fit.passes >= effort.max_passes || (is_settled && !is_coarse)) break;
        if (is_coarse) fit.step_s /= 2;
        if (effort.finds_scale) {
            const auto before = std::exchange(fit.scale, scale_of(fit));
            is_settled =
                std::abs(portable_log(fit.scale[0] / before[0])) + std::abs(portable_log(fit.scale[1] / before[1])) <
                settled;
        }
        if (!evaluate()) return std::nullopt;
    }
    return fit;
}

}  // namespace doppel
