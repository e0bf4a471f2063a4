#include "fit/uncertainty.hpp"

#include "base/error.hpp"
#include "numeric/portable_math.hpp"
#include "track/regression.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace doppel {
namespace {

/// Σ over shots of r_i r_(i+lag) of one link, for each lag.
std::vector<double> correlations_of(const Fit& fit, std::size_t link, std::size_t lags, const std::atomic<bool>& stop) {
    std::vector<double> result(lags + 1, 0);
    const double maximum = Fit::bend * fit.scale[link];
    for (const auto& shot : fit.shots) {
        std::vector<double> series;
        for (const auto& residual : shot.sums.residuals)
            if (!std::isnan(residual[link])) series.push_back(std::clamp(residual[link], -maximum, maximum));
        for (std::size_t shift = 0; shift <= lags && shift < series.size(); ++shift) {
            throw_if_set(stop);
            for (std::size_t i = 0; i + shift < series.size(); ++i) result[shift] += series[i] * series[i + shift];
        }
    }
    return result;
}

/// Tests whether successive residuals are correlated, and for how long.
void test_residuals(const FitJob& job, const Fit& fit, Uncertainty& result) {
    constexpr std::size_t lags = 10, furthest = 400;
    constexpr double limit = 29.6, limit_of_one = 3.29;  // 99.9 %: χ² with ten degrees of freedom; σ
    // fitting p numbers to n residuals of white noise gives the nearest ones a correlation of about −p / (n − p), those
    // further apart one between that and 0
    const auto n = static_cast<double>(fit.residual_count());
    const auto p = static_cast<double>(fit.model.fitted.count() + 4 * fit.shots.size());
    double intervals = 0;
    for (const auto& piece : job.track.pieces) intervals += static_cast<double>(piece.size() - 1);
    for (std::size_t link = 0; link < 2; ++link) {
        const auto sums = correlations_of(fit, link, furthest, job.stop);
        const auto significance = [&](std::size_t shift) {
            const double r = sums[shift] / sums[0];
            return (r - std::clamp(r, -p / (n - p), 0.0)) * std::sqrt(n / 2);
        };
        double portmanteau = 0;
        for (std::size_t shift = 1; shift <= lags; ++shift) portmanteau += std::pow(significance(shift), 2);
        result.is_white &= portmanteau < limit && std::abs(significance(1)) < limit_of_one;
        result.neighbour[link] = sums[1] / sums[0];
        std::size_t shift = 1;
        while (shift < furthest && sums[shift] > sums[0] / std::numbers::e) ++shift;
        result.memory_s[link] = static_cast<double>(shift) * (job.track.duration() / intervals);
    }
}

/// Σ g gᵀ over stretches, with the slope g by the parameters, starts eliminated.
ParameterMatrix scatter_of(const Fit& fit) {
    ParameterMatrix scatter = ParameterMatrix::Zero();
    double stretches = 0;
    for (const auto& shot : fit.shots) {
        const Eigen::Matrix<double, parameter_count, 4> through =
            shot.sums.normal.bottomLeftCorner<parameter_count, 4>() * shot.sums.inverse_of_start();
        for (const auto& block : shot.sums.blocks) {
            const Parameters slope = block.tail<parameter_count>() - through * block.head<4>();
            scatter += slope * slope.transpose();
            ++stretches;
        }
    }
    return scatter * (stretches / std::max(stretches - static_cast<double>(fit.model.fitted.count()), 1.0));
}

}  // namespace

Uncertainty uncertainty_of(const FitJob& job, Fit fit) {
    Uncertainty result;
    test_residuals(job, fit, result);
    // for white residuals; includes parameters at a bound, whose possible increase makes the others less certain
    ParameterMatrix matrix = ParameterMatrix::Zero();
    double bounded = 0, beyond = 0;
    for (const auto& shot : fit.shots) {
        matrix += shot.sums.reduced().bottomRightCorner<parameter_count, parameter_count>();
        bounded += shot.sums.bounded;
        beyond += static_cast<double>(shot.sums.beyond);
    }
    const double n = static_cast<double>(fit.residual_count()), count = static_cast<double>(fit.model.fitted.count());
    const double slope = 1 - beyond / n;  // mean of Huber's ψ′
    const ParameterMatrix inverse = inverse_of(matrix);
    result.covariance =
        inverse * (bounded / (n - (count + 4 * static_cast<double>(fit.shots.size()))) / (slope * slope));
    if (result.is_white) return result;
    // for correlated residuals
    constexpr double shortest_s = 0.3, memories = 4;
    evaluate_fit(job, fit, std::max(shortest_s, memories * std::max(result.memory_s[0], result.memory_s[1])));
    const ParameterMatrix sandwich = inverse.lazyProduct(scatter_of(fit)).eval().lazyProduct(inverse) / (slope * slope);
    Parameters wider = Parameters::Ones();
    double logarithms = 0;
    for (const auto k : fit.model.list()) {
        const double ratio = sandwich(k, k) / result.covariance(k, k);
        wider[k] = std::sqrt(std::max(1 / ratio, 1.0));
        logarithms += 0.5 * portable_log(std::max(ratio, 1.0));
    }
    result.covariance = wider.asDiagonal() * sandwich * wider.asDiagonal();
    result.inflation = portable_exp(logarithms / count);
    return result;
}

std::optional<EnergyLoss> energy_loss(const FitJob& job, Fit start) {
    start.model = model_of(start.model.point_masses, 1, start.model.drag, 2);
    start.model.may_gain = true;
    start.is_evaluated = false;  // it was evaluated with fewer parameters
    const auto fit = fit_model(job, std::move(start), {.step_share = 0.2, .relative = 1e-4});
    if (!fit) return std::nullopt;
    // sums over the motion, divided by B: energy lost to the friction of both joints per unit of b1 and b2, and kinetic
    // energy
    const auto& p = fit->parameters;
    Parameters taken = Parameters::Zero();
    double energy = 0;
    for (const auto& [one, two] : estimates_of(job.track, job.stop)) {
        const double w1 = one.rate, w2 = two.rate;
        taken[viscous_1] += w1 * w1, taken[viscous_2] += (w2 - w1) * (w2 - w1);
        energy += 0.5 * (p[inertia] * w1 * w1 + w2 * w2) + p[coupling] * std::cos(one.angle - two.angle) * w1 * w2;
    }
    taken /= energy;
    const auto covariance = uncertainty_of(job, *fit).covariance;
    return EnergyLoss{taken.dot(p), std::sqrt(taken.dot(covariance.lazyProduct(taken))), fit->rms};
}

}  // namespace doppel
