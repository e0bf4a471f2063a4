#include "fit/uncertainty.hpp"

#include "base/error.hpp"
#include "numeric/portable_math.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace doppel {
namespace {

/// Σ over segments of r_i r_(i+lag) of one arm, by lag.
std::vector<double> correlations_of(const Fit& fit, std::size_t arm, std::size_t lags, const std::atomic<bool>& stop) {
    std::vector<double> result(lags + 1, 0);
    const double most = FitRules::bend * fit.rules.scale[arm];
    for (const auto& sums : fit.sums) {
        std::vector<double> series;
        for (const auto& residual : sums.residuals)
            if (!std::isnan(residual[arm])) series.push_back(std::clamp(residual[arm], -most, most));
        for (std::size_t lag = 0; lag <= lags && lag < series.size(); ++lag) {
            throw_if_set(stop);
            for (std::size_t i = 0; i + lag < series.size(); ++i) result[lag] += series[i] * series[i + lag];
        }
    }
    return result;
}

double mean_interval(const Track& track) {
    double time = 0, count = 0;
    for (const auto& piece : track.pieces) time += piece.duration(), count += static_cast<double>(piece.size() - 1);
    return time / count;
}

/// Σ g gᵀ over stretches of the slope g of the fitted parameters, starts eliminated.
Eigen::MatrixXd scatter_of(const Fit& fit) {
    const auto count = static_cast<Eigen::Index>(fit.model.fitted.size());
    Eigen::MatrixXd scatter = Eigen::MatrixXd::Zero(count, count);
    double stretches = 0;
    for (const auto& sums : fit.sums) {
        const Eigen::MatrixXd through =
            sums.matrix.bottomLeftCorner(count, 4) * inverse_of(sums.matrix.topLeftCorner(4, 4));
        for (const auto& block : sums.blocks) {
            const Eigen::VectorXd slope = block.tail(count) - through * block.head<4>();
            scatter += slope * slope.transpose();
            ++stretches;
        }
    }
    const double spent = static_cast<double>(count);
    return scatter * (stretches / std::max(stretches - spent, 1.0));
}

}  // namespace

double Uncertainty::standard_error(std::size_t k) const {
    const auto i = static_cast<Eigen::Index>(k);
    return std::sqrt(std::max(covariance(i, i), 0.0));
}

double Uncertainty::standard_error(FitParameter parameter) const {
    const auto found = std::find(parameters.begin(), parameters.end(), parameter);
    return found == parameters.end() ? 0 : standard_error(static_cast<std::size_t>(found - parameters.begin()));
}

Uncertainty uncertainty_of(const FitJob& job, Fit fit) {
    // those at a bound, too: that they could be more makes the others less certain
    Uncertainty result{.parameters = fit.model.fitted, .covariance = {}};
    const auto count = static_cast<Eigen::Index>(fit.model.fitted.size());
    const double n = static_cast<double>(fit.residual_count());
    // whether successive residuals know of each other
    constexpr std::size_t lags = 10, furthest = 400;
    constexpr double limit = 29.6;  // χ² of ten at 99.9 %
    const double interval = mean_interval(job.track);
    for (std::size_t arm = 0; arm < 2; ++arm) {
        const auto sums = correlations_of(fit, arm, furthest, job.stop);
        double portmanteau = 0;
        for (std::size_t lag = 1; lag <= lags; ++lag) portmanteau += std::pow(sums[lag] / sums[0], 2);
        result.is_white &= portmanteau * n / 2 < limit;
        result.neighbour[arm] = sums[1] / sums[0];
        std::size_t lag = 1;
        while (lag < furthest && sums[lag] > sums[0] / std::numbers::e) ++lag;
        result.memory_s[arm] = static_cast<double>(lag) * interval;
    }
    // of white residuals
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(count, count);
    double bounded = 0, beyond = 0;
    for (const auto& sums : fit.sums) {
        matrix += reduced(sums).matrix;
        bounded += sums.bounded;
        beyond += static_cast<double>(sums.beyond);
    }
    const double spent = static_cast<double>(count) + 4 * static_cast<double>(fit.segments.size());
    const double slope = 1 - beyond / n;  // mean of Huber's ψ′
    const Eigen::MatrixXd inverse = inverse_of(matrix);
    result.covariance = inverse * (bounded / (n - spent) / (slope * slope));
    if (result.is_white) return result;
    // of others
    constexpr double shortest_s = 0.3, memories = 4;
    const double block_s = std::max(shortest_s, memories * std::max(result.memory_s[0], result.memory_s[1]));
    evaluate_fit(job, fit, block_s);
    const Eigen::MatrixXd sandwich = inverse * scatter_of(fit) * inverse / (slope * slope);
    const Eigen::VectorXd white = result.covariance.diagonal();
    const Eigen::VectorXd wider = (white.array() / sandwich.diagonal().array()).max(1).sqrt();
    result.covariance = wider.asDiagonal() * sandwich * wider.asDiagonal();
    const Eigen::ArrayXd ratio = (result.covariance.diagonal().array() / white.array()).sqrt();
    double logarithms = 0;
    for (const double wider_by : ratio) logarithms += portable_log(wider_by);
    result.inflation = portable_exp(logarithms / static_cast<double>(count));
    return result;
}

}  // namespace doppel
