#include "fit/uncertainty.hpp"

#include "base/error.hpp"
#include "numeric/portable_math.hpp"
#include "track/regression.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace doppel {
namespace {

/// Σ over shots of r_i r_(i+lag) of one arm, by lag.
std::vector<double> correlations_of(const Fit& fit, std::size_t arm, std::size_t lags, const std::atomic<bool>& stop) {
    std::vector<double> result(lags + 1, 0);
    const double most = Fit::bend * fit.scale[arm];
    for (const auto& shot : fit.shots) {
        std::vector<double> series;
        for (const auto& residual : shot.sums.residuals)
            if (!std::isnan(residual[arm])) series.push_back(std::clamp(residual[arm], -most, most));
        for (std::size_t shift = 0; shift <= lags && shift < series.size(); ++shift) {
            throw_if_set(stop);
            for (std::size_t i = 0; i + shift < series.size(); ++i) result[shift] += series[i] * series[i + shift];
        }
    }
    return result;
}

/// Whether successive residuals know of each other, and for how long.
void look_at_residuals(const FitJob& job, const Fit& fit, Uncertainty& result) {
    constexpr std::size_t lags = 10, furthest = 400;
    constexpr double limit = 29.6;  // χ² of ten at 99.9 %
    double intervals = 0;
    for (const auto& piece : job.track.pieces) intervals += static_cast<double>(piece.size() - 1);
    for (std::size_t arm = 0; arm < 2; ++arm) {
        const auto sums = correlations_of(fit, arm, furthest, job.stop);
        double portmanteau = 0;
        for (std::size_t shift = 1; shift <= lags; ++shift) portmanteau += std::pow(sums[shift] / sums[0], 2);
        result.is_white &= portmanteau * static_cast<double>(fit.residual_count()) / 2 < limit;
        result.neighbour[arm] = sums[1] / sums[0];
        std::size_t shift = 1;
        while (shift < furthest && sums[shift] > sums[0] / std::numbers::e) ++shift;
        result.memory_s[arm] = static_cast<double>(shift) * (job.track.duration() / intervals);
    }
}

/// Σ g gᵀ over stretches of the slope g of the fitted parameters, starts eliminated.
Eigen::MatrixXd scatter_of(const Fit& fit) {
    const auto count = static_cast<Eigen::Index>(fit.model.fitted.size());
    Eigen::MatrixXd scatter = Eigen::MatrixXd::Zero(count, count);
    double stretches = 0;
    for (const auto& shot : fit.shots) {
        const auto& matrix = shot.sums.matrix;
        const Eigen::MatrixXd through =
            matrix.bottomLeftCorner(count, 4).lazyProduct(inverse_of(matrix.topLeftCorner(4, 4)));
        for (const auto& block : shot.sums.blocks) {
            const Eigen::VectorXd slope = block.tail(count) - through * block.head<4>();
            scatter += slope * slope.transpose();
            ++stretches;
        }
    }
    return scatter * (stretches / std::max(stretches - static_cast<double>(count), 1.0));
}

}  // namespace

double Uncertainty::standard_error(std::size_t k) const {
    const auto i = static_cast<Eigen::Index>(k);
    return std::sqrt(std::max(covariance(i, i), 0.0));
}

double Uncertainty::standard_error_of(FitParameter parameter) const {
    const auto found = std::find(parameters.begin(), parameters.end(), parameter);
    return found == parameters.end() ? 0 : standard_error(static_cast<std::size_t>(found - parameters.begin()));
}

Uncertainty uncertainty_of(const FitJob& job, Fit fit) {
    // those at a bound, too: that they could be more makes the others less certain
    Uncertainty result{.parameters = fit.model.fitted, .covariance = {}};
    look_at_residuals(job, fit, result);
    // of white residuals
    const auto count = static_cast<Eigen::Index>(fit.model.fitted.size());
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(count, count);
    double bounded = 0, beyond = 0;
    for (const auto& shot : fit.shots) {
        matrix += reduced(shot.sums).matrix;
        bounded += shot.sums.bounded;
        beyond += static_cast<double>(shot.sums.beyond);
    }
    const double n = static_cast<double>(fit.residual_count());
    const double spent = static_cast<double>(count) + 4 * static_cast<double>(fit.shots.size());
    const double slope = 1 - beyond / n;  // mean of Huber's ψ′
    const Eigen::MatrixXd inverse = inverse_of(matrix);
    result.covariance = inverse * (bounded / (n - spent) / (slope * slope));
    if (result.is_white) return result;
    // of others
    constexpr double shortest_s = 0.3, memories = 4;
    evaluate_fit(job, fit, std::max(shortest_s, memories * std::max(result.memory_s[0], result.memory_s[1])));
    const Eigen::MatrixXd sandwich = inverse.lazyProduct(scatter_of(fit)).eval().lazyProduct(inverse) / (slope * slope);
    const Eigen::ArrayXd white = result.covariance.diagonal();
    const Eigen::VectorXd wider = (white / sandwich.diagonal().array()).max(1).sqrt();
    result.covariance = wider.asDiagonal() * sandwich * wider.asDiagonal();
    const Eigen::ArrayXd ratio = (result.covariance.diagonal().array() / white).sqrt();
    double logarithms = 0;
    for (const double wider_by : ratio) logarithms += portable_log(wider_by);
    result.inflation = portable_exp(logarithms / static_cast<double>(count));
    return result;
}

EnergyLoss energy_loss(const FitJob& job, const Fit& start) {
    Fit fit = start;
    fit.model = model_of(start.model.point_masses, 1, start.model.drag, 2);
    fit.model.may_gain = true;
    fit.is_evaluated = false;  // of fewer parameters
    fit = fit_model(job, std::move(fit), {.step_share = 0.2, .relative = 1e-4});
    const auto uncertainty = uncertainty_of(job, fit);
    // means over the motion, over B: what the friction of both joints takes per unit of b1 and b2, and the energy of motion
    std::array<double, 2> taken{};
    double energy = 0;
    for (const auto& [angle, rate, acceleration] : glimpses_of(job.track, job.stop)) {
        const auto [w1, w2] = rate;
        taken[0] += w1 * w1, taken[1] += (w2 - w1) * (w2 - w1);
        energy +=
            0.5 * (fit.of(inertia) * w1 * w1 + w2 * w2) + fit.of(coupling) * std::cos(angle[0] - angle[1]) * w1 * w2;
    }
    EnergyLoss loss{.rms = fit.rms};
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(uncertainty.covariance.rows());
    for (std::size_t k = 0; k < fit.model.fitted.size(); ++k)
        for (std::size_t joint = 0; joint < 2; ++joint)
            if (fit.model.fitted[k] == viscous_1 + joint) {
                weights[static_cast<Eigen::Index>(k)] = taken[joint] / energy;
                loss.share += taken[joint] / energy * fit.of(fit.model.fitted[k]);
            }
    loss.standard_error = std::sqrt(weights.dot(uncertainty.covariance * weights));
    return loss;
}

}  // namespace doppel
