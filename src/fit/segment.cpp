#include "fit/segment.hpp"

#include "fit/flow.hpp"

#include <limits>

namespace doppel {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

template <int N>
SegmentSums evaluate(const Track& track, const TrackSegment& segment, const ModelSpec& model, const FitRules& rules,
                     const Parameters& p, const ArmState<double>& start, double block_s) {
    using enum FitParameter;
    const auto& piece = track.pieces[segment.piece];
    const auto of = [&](FitParameter parameter, std::size_t arm) { return p[index_of(parameter) + arm]; };
    const auto columns = 4 + static_cast<Eigen::Index>(model.fitted.size());
    const auto moving = 4 + std::count_if(model.fitted.begin(), model.fitted.end(), is_dynamic);
    auto flow = varied_flow<N>(model, p, start, rules.step_s);
    SegmentSums sums;
    sums.residuals.assign(segment.size(), {none, none});
    // of each residual the derivatives of what is shown, then itself, by the root of its weight
    Eigen::MatrixXd rows(columns + 1, 2 * static_cast<Eigen::Index>(segment.size()));
    Eigen::VectorXd row(columns);
    const auto read = [&](std::size_t sample, std::size_t arm, double t) {
        const auto angle = flow.angle(arm, t);
        const double scale = of(scale_1, arm);
        row.head(moving) = scale * angle.tangent.head(moving);
        for (auto k = moving; k < columns; ++k) {
            const auto parameter = model.fitted[static_cast<std::size_t>(k - 4)];
            const auto is = [&](FitParameter one) { return index_of(parameter) == index_of(one) + arm; };
            const bool is_lag = parameter == lag && arm == 1;
            row[k] = is(offset_1) ? 1 : is(scale_1) ? angle.value : is_lag ? scale * flow.rate(arm, t) : 0;
        }
        const double residual = piece.angle[arm][sample] - (of(offset_1, arm) + scale * angle.value);
        const double unit = rules.scale[arm], size = std::abs(residual / unit), bend = FitRules::bend;
        const bool beyond = size > bend;
        sums.cost += beyond ? bend * size - 0.5 * bend * bend : 0.5 * size * size;
        sums.bounded += beyond ? bend * bend : size * size;
        sums.squares += residual * residual;
        sums.beyond += beyond;
        sums.residuals[sample - segment.first][arm] = residual;
        const double root = std::sqrt(beyond ? bend / size : 1) / unit;
        rows.col(sums.count++) << root * row, root * residual;
        if (block_s > 0) sums.blocks.back() += (root * root * residual) * row;
    };
    for (std::size_t sample = segment.first; sample < segment.last; ++sample) {
        const double t = piece.time_s[sample] - piece.time_s[segment.first];
        while (block_s > 0 && static_cast<double>(sums.blocks.size()) * block_s <= t)
            sums.blocks.emplace_back(Eigen::VectorXd::Zero(columns));
        for (std::size_t arm = 0; arm < 2 && std::isfinite(sums.cost); ++arm) {
            const double at = arm == 1 ? t + of(lag, 0) : t;
            if (piece.is_outlier[arm][sample]) continue;
            if (flow.reach(at))
                read(sample, arm, at);
            else
                sums.cost = sums.squares = std::numeric_limits<double>::infinity();
        }
    }
    if (!std::isfinite(sums.cost)) sums.cost = sums.squares = std::numeric_limits<double>::infinity();
    Eigen::MatrixXd lower = Eigen::MatrixXd::Zero(columns + 1, columns + 1);
    lower.selfadjointView<Eigen::Lower>().rankUpdate(rows.leftCols(sums.count));
    const Eigen::MatrixXd whole = lower.selfadjointView<Eigen::Lower>();
    sums.matrix = whole.topLeftCorner(columns, columns);
    sums.slope = whole.col(columns).head(columns);
    return sums;
}

}  // namespace

SegmentSums evaluate_segment(const Track& track, const TrackSegment& segment, const ModelSpec& model,
                             const FitRules& rules, const Parameters& parameters, const ArmState<double>& start,
                             double block_s) {
    const auto moving = 4 + std::count_if(model.fitted.begin(), model.fitted.end(), is_dynamic);
    return (moving <= few_directions ? evaluate<few_directions> : evaluate<all_directions>)(track, segment, model,
                                                                                            rules, parameters, start,
                                                                                            block_s);
}

}  // namespace doppel
