#include "fit/flow.hpp"
#include "fit/shooting.hpp"

#include <cmath>
#include <limits>

namespace doppel {
namespace {

template <int N>
ShotSums evaluate(const Track& track, const Fit& fit, const Shot& shot, double block_s) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN(),
                     infinite = std::numeric_limits<double>::infinity();
    const auto& piece = track.pieces[shot.piece];
    const auto& p = fit.parameters;
    const auto& fitted = fit.model.fitted;
    const auto columns = 4 + static_cast<Eigen::Index>(fitted.size()), moving = 4 + fit.model.moving();
    Flow<N> flow(fit.model, p, shot.start, fit.step_s);
    ShotSums sums;
    sums.residuals.assign(shot.size(), {none, none});
    // of each residual the derivatives of what is shown, then itself, by the root of its weight
    Eigen::MatrixXd rows(columns + 1, 2 * static_cast<Eigen::Index>(shot.size()));
    Eigen::VectorXd row(columns);
    const auto read = [&](std::size_t sample, std::size_t arm, double t) {
        const auto angle = flow.angle(static_cast<Eigen::Index>(arm), t);
        const double scale = p[scale_1 + arm];
        row.head(moving) = scale * angle.segment(1, moving);
        for (auto k = moving; k < columns; ++k) {
            const auto parameter = fitted[static_cast<std::size_t>(k - 4)];
            row[k] = parameter == offset_1 + arm    ? 1
                     : parameter == scale_1 + arm   ? angle[0]
                     : parameter == lag && arm == 1 ? scale * flow.rate(1, t)
                                                    : 0;
        }
        const double residual = piece.angle[arm][sample] - (p[offset_1 + arm] + scale * angle[0]);
        const double unit = fit.scale[arm], size = std::abs(residual / unit), bend = Fit::bend;
        const bool beyond = size > bend;
        sums.cost += beyond ? bend * size - 0.5 * bend * bend : 0.5 * size * size;
        sums.bounded += beyond ? bend * bend : size * size;
        sums.squares += residual * residual;
        sums.beyond += beyond;
        sums.residuals[sample - shot.first][arm] = residual;
        const double root = std::sqrt(beyond ? bend / size : 1) / unit;
        rows.col(sums.count++) << root * row, root * residual;
        if (block_s > 0) sums.blocks.back() += (root * root * residual) * row;
    };
    for (std::size_t sample = shot.first; sample < shot.last; ++sample) {
        const double t = piece.time_s[sample] - piece.time_s[shot.first];
        while (block_s > 0 && static_cast<double>(sums.blocks.size()) * block_s <= t)
            sums.blocks.emplace_back(Eigen::VectorXd::Zero(columns));
        for (std::size_t arm = 0; arm < 2 && std::isfinite(sums.cost); ++arm) {
            const double at = arm == 1 ? t + p[lag] : t;
            if (piece.is_outlier[arm][sample]) continue;
            if (flow.reach(at))
                read(sample, arm, at);
            else
                sums.cost = infinite;
        }
    }
    if (!std::isfinite(sums.cost)) sums.cost = sums.squares = infinite;
    Eigen::MatrixXd lower = Eigen::MatrixXd::Zero(columns + 1, columns + 1);
    lower.selfadjointView<Eigen::Lower>().rankUpdate(rows.leftCols(sums.count));
    const Eigen::MatrixXd whole = lower.selfadjointView<Eigen::Lower>();
    sums.matrix = whole.topLeftCorner(columns, columns);
    sums.slope = whole.col(columns).head(columns);
    return sums;
}

}  // namespace

ShotSums evaluate_shot(const Track& track, const Fit& fit, const Shot& shot, double block_s) {
    const bool is_few = 4 + fit.model.moving() <= few_directions;
    return (is_few ? evaluate<few_directions> : evaluate<all_directions>)(track, fit, shot, block_s);
}

}  // namespace doppel
