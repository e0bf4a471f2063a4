#include "fit/energy.hpp"

#include "base/error.hpp"
#include "fit/flow.hpp"
#include "fit/uncertainty.hpp"

#include <cmath>

namespace doppel {
namespace {

/// Means over the motion, over B: what the friction of both joints takes per unit of b1 and b2, and the energy of motion.
struct MeanSquares {
    Eigen::Vector2d taken = Eigen::Vector2d::Zero();
    double energy = 0;
};

MeanSquares mean_squares(const Track& track, const std::vector<TrackSegment>& segments, const Fit& fit,
                         const std::atomic<bool>& stop) {
    const auto arms = arms_of(fit.model, fit.parameters);
    const double step = fit.rules.step_s, inertia = fit.parameters[index_of(FitParameter::inertia)];
    const double coupling = fit.parameters[index_of(FitParameter::coupling)];
    MeanSquares mean;
    double count = 0;
    for (std::size_t k = 0; k < segments.size(); ++k) {
        throw_if_set(stop);
        const auto& times = track.pieces[segments[k].piece].time_s;
        const double length = times[segments[k].last - 1] - times[segments[k].first];
        auto state = fit.starts[k], slope = arms.rate(state);
        for (double t = 0; t < length; t += step, take_step(arms, step, state, slope)) {
            const double w1 = state[2], w2 = state[3];
            mean.taken += Eigen::Vector2d(w1 * w1, (w2 - w1) * (w2 - w1));
            mean.energy += 0.5 * (inertia * w1 * w1 + w2 * w2) + coupling * std::cos(state[0] - state[1]) * w1 * w2;
            ++count;
        }
    }
    return {mean.taken / count, mean.energy / count};
}

}  // namespace

EnergyLoss energy_loss(const Track& track, const std::vector<TrackSegment>& segments, const Fit& start, int jobs,
                       const std::atomic<bool>& stop) {
    Fit fit = start;
    fit.model = model_of(start.model.point_masses, 1, start.model.drag, 2);
    fit.model.may_gain = true;
    fit.sums.clear();  // of fewer parameters
    fit = fit_model(track, segments, std::move(fit), {.step_share = 0.2, .relative = 1e-4, .jobs = jobs}, stop);
    const auto uncertainty = uncertainty_of(track, segments, fit, jobs, stop);
    const auto mean = mean_squares(track, segments, fit, stop);
    EnergyLoss loss{.rms = fit.rms};
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(uncertainty.covariance.rows());
    for (std::size_t k = 0; k < uncertainty.parameters.size(); ++k) {
        const auto parameter = uncertainty.parameters[k];
        if (parameter != FitParameter::viscous_1 && parameter != FitParameter::viscous_2) continue;
        const auto joint = static_cast<Eigen::Index>(index_of(parameter) - index_of(FitParameter::viscous_1));
        const double weight = mean.taken[joint] / mean.energy;
        weights[static_cast<Eigen::Index>(k)] = weight;
        loss.share += weight * fit.parameters[index_of(parameter)];
    }
    loss.standard_error = std::sqrt(weights.dot(uncertainty.covariance * weights));
    return loss;
}

}  // namespace doppel
