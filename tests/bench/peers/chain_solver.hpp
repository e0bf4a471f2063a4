#pragma once

#include "base/error.hpp"
#include "chain_rate.hpp"
#include "external_method.hpp"

#include <algorithm>
#include <type_traits>
#include <vector>

namespace doppel {

/// The common part of the solvers of all libraries: a chain in angles, from its release over `seconds` in one
/// advance(); each further call starts at the release again.
template <int N>
class ChainSolver : public Motion {
public:
    static constexpr long max_steps = 2'000'000;  // above this number, a method has failed
    static constexpr double first_step = 0.01;    // s, for libraries that require it

    using State = std::conditional_t<N == Eigen::Dynamic, std::vector<double>,
                                     std::array<double, static_cast<std::size_t>(N == Eigen::Dynamic ? 0 : 2 * N)>>;

    ChainSolver(const Pendulum<double>& chain, double seconds) : seconds_(seconds), rate_(chain), chain_(chain) {
        if constexpr (N == Eigen::Dynamic) start_.resize(2 * chain.links());
        std::copy(chain.angle.begin(), chain.angle.end(), start_.begin());
        std::copy(chain.rate.begin(), chain.rate.end(), start_.begin() + static_cast<std::ptrdiff_t>(chain.links()));
        y_ = start_;
        start_energy_ = observe().energy;
    }

    void advance(const std::atomic<bool>& /*stop*/) final {
        y_ = start_;
        rate_.evaluations = steps_ = 0;
        integrate();
        for (const double x : y_)
            if (!std::isfinite(x)) throw method_failed("the motion diverged");
    }
    void advance_within(double /*share*/, const std::atomic<bool>& /*stop*/) final {}
    Observation observe() const final {
        Observation seen;
        seen.bobs = bobs_of_angles(chain_, Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(
                                               y_.data(), static_cast<Eigen::Index>(y_.size()))));
        seen.energy = energy(seen.bobs, chain_.gravity);
        seen.kinetic_energy = kinetic_energy(seen.bobs);
        seen.energy_change = seen.energy - start_energy_;
        return seen;
    }
    Effort effort() const final { return {.steps = steps_, .evaluations = rate_.evaluations}; }

protected:
    /// Sets y to the state at the end; counts steps.
    virtual void integrate() = 0;

    /// The right-hand side in the form of C libraries.
    static int slope(double /*t*/, const double* y, double* dydt, void* rate) {
        (*static_cast<ChainRate<N>*>(rate))(y, dydt);
        return 0;
    }

    double seconds_;
    ChainRate<N> rate_;
    State start_{}, y_{};
    long steps_ = 0;

private:
    Pendulum<double> chain_;
    double start_energy_ = 0;  // J
};

/// A peer whose solver is a class template over the number of links, made from (chain, seconds, setting, more …).
template <template <int> class Solver, class... More>
ExternalMethod peer_of(std::string name, bool adaptive, double minimum, double maximum, More... more) {
    return {std::move(name), adaptive, minimum, maximum,
            [more...](const Pendulum<double>& chain, double seconds, double setting) -> std::unique_ptr<Motion> {
                if (chain.links() == 2) return std::make_unique<Solver<2>>(chain, seconds, setting, more...);
                if (chain.links() == 3) return std::make_unique<Solver<3>>(chain, seconds, setting, more...);
                return std::make_unique<Solver<Eigen::Dynamic>>(chain, seconds, setting, more...);
            }};
}

}  // namespace doppel
