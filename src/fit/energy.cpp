#include "fit/energy.hpp"

#include "fit/ladder.hpp"
#include "fit/uncertainty.hpp"
#include "track/regression.hpp"

#include <cmath>

namespace doppel {

EnergyLoss energy_loss(const FitJob& job, const Fit& start) {
    using enum FitParameter;
    Fit fit = start;
    fit.model = model_of(start.model.point_masses, 1, start.model.drag, 2);
    fit.model.may_gain = true;
    fit.sums.clear();  // of fewer parameters
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
            if (index_of(fit.model.fitted[k]) == index_of(viscous_1) + joint) {
                weights[static_cast<Eigen::Index>(k)] = taken[joint] / energy;
                loss.share += taken[joint] / energy * fit.of(fit.model.fitted[k]);
            }
    loss.standard_error = std::sqrt(weights.dot(uncertainty.covariance * weights));
    return loss;
}

}  // namespace doppel
