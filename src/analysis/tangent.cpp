#include "analysis/tangent.hpp"

#include "integrate/dormand_prince.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace doppel {

NaturalUnits::NaturalUnits(const PhysicalPendulum<double>& p)
    : length(p.chain.reach() / static_cast<double>(p.chain.links())) {
    const auto& chain = p.chain;
    const double nu = p.pivot.frequency, mass = std::accumulate(chain.mass.begin(), chain.mass.end(), 0.0);
    const double unit = mass * chain.reach() / static_cast<double>(chain.links());
    double drive = nu * nu * std::hypot(p.pivot.x, p.pivot.y);
    for (const auto& motor : p.torques) drive += std::abs(motor.amplitude) / unit;
    double fastest = std::sqrt((std::abs(chain.gravity) + drive) / length);
    for (const double rate : chain.rate) fastest = std::max(fastest, std::abs(rate));
    time = fastest > 0 ? 1 / fastest : 1;
}

long parts_of(double seconds, const NaturalUnits& units) {
    return std::max(1L, std::lround(std::ceil(seconds / (4 * units.time))));
}

struct TangentMotion::Stepper {
    TangentFlow flow;
    Eigen::Index angles;
    double tolerance;
    std::optional<Dop853::Stepper<TangentFlow>> dop853{};  // contains the address of the flow
};

TangentMotion::TangentMotion(TangentFlow flow, std::size_t angles, double tolerance)
    : stepper_(new Stepper{std::move(flow), static_cast<Eigen::Index>(angles), tolerance}) {}
TangentMotion::~TangentMotion() = default;

void TangentMotion::restart(TangentState y) {
    auto& [flow, angles, tolerance, dop853] = *stepper_;
    for (Eigen::Index i = 0; i < angles; ++i) y[i] = std::remainder(y[i], 2 * pi);
    if (dop853)
        dop853->reset(y);
    else
        dop853.emplace(flow, y, tolerance);
}

const TangentState& TangentMotion::advance(double seconds) {
    stepper_->dop853->advance(seconds);
    return stepper_->dop853->state();
}

}  // namespace doppel
