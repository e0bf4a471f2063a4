#include "chain_solver.hpp"
#include "peers.hpp"

#include <boost/numeric/odeint.hpp>

#include <functional>

namespace doppel {
namespace {

namespace odeint = boost::numeric::odeint;

template <int N>
auto system_of(ChainRate<N>& rate) {
    return [&rate](const auto& y, auto& dydt, double /*t*/) { rate(y.data(), dydt.data()); };
}

/// An adaptive stepper.
template <int N, class Stepper>
class ControlledSolver : public ChainSolver<N> {
public:
    ControlledSolver(const Pendulum<double>& chain, double seconds, const Stepper& stepper)
        : ChainSolver<N>(chain, seconds), stepper_(stepper) {
        auto y = this->y_;
        double t = 0, step = this->first_step;
        stepper_.try_step(system_of(this->rate_), y, t, step);  // its first step allocates memory
    }

private:
    void integrate() override {
        if constexpr (requires { stepper_.reset(); }) stepper_.reset();
        const auto count = [this](const auto&, double) {
            if (this->steps_++ == this->max_steps)
                throw method_failed("odeint: {} steps are not enough", this->max_steps);
        };
        try {
            this->steps_ = static_cast<long>(odeint::integrate_adaptive(
                std::ref(stepper_), system_of(this->rate_), this->y_, 0.0, this->seconds_, this->first_step, count));
        } catch (const odeint::odeint_error& error) {
            throw method_failed("odeint: {}", error.what());
        }
    }

    Stepper stepper_;
};

template <class State>
using Fehlberg = odeint::runge_kutta_fehlberg78<State>;
template <class State>
using DormandPrince = odeint::runge_kutta_dopri5<State>;
template <int N>
using StateOf = typename ChainSolver<N>::State;

template <int N, template <class> class Pair>
using ControlledPair = ControlledSolver<N, typename odeint::result_of::make_controlled<Pair<StateOf<N>>>::type>;

template <template <class> class Pair>
struct OfPair {
    template <int N>
    struct Solver final : ControlledPair<N, Pair> {
        Solver(const Pendulum<double>& chain, double seconds, double tolerance)
            : ControlledPair<N, Pair>(chain, seconds,
                                      odeint::make_controlled(tolerance, tolerance, Pair<StateOf<N>>())) {}
    };
};

/// Extrapolation of the modified midpoint rule; also adapts its order.
template <int N>
struct BulirschStoer final : ControlledSolver<N, odeint::bulirsch_stoer<StateOf<N>>> {
    BulirschStoer(const Pendulum<double>& chain, double seconds, double tolerance)
        : ControlledSolver<N, odeint::bulirsch_stoer<StateOf<N>>>(
              chain, seconds, odeint::bulirsch_stoer<StateOf<N>>(tolerance, tolerance)) {}
};

/// Adams method with the last eight slopes. Fehlberg's method, of almost the same order, makes the first seven steps;
/// the library's default would have order 4.
template <int N>
class AdamsBashforthMoulton final : public ChainSolver<N> {
public:
    using State = typename ChainSolver<N>::State;

    AdamsBashforthMoulton(const Pendulum<double>& chain, double seconds, double step)
        : ChainSolver<N>(chain, seconds), all_steps_(std::lround(std::ceil(seconds / step - 1e-9))) {
        if (all_steps_ < past) throw method_failed("odeint: step = {:.3g} s leaves fewer than {} steps", step, past);
        stepper_.adjust_size(this->y_);
    }

private:
    static constexpr long past = 8;

    void integrate() override {
        const double step = this->seconds_ / static_cast<double>(all_steps_);
        double t = 0;
        stepper_.reset();
        stepper_.initialize(std::ref(starter_), system_of(this->rate_), this->y_, t, step);
        odeint::integrate_n_steps(std::ref(stepper_), system_of(this->rate_), this->y_, t, step,
                                  static_cast<std::size_t>(all_steps_ - past + 1));
        this->steps_ = all_steps_;
    }

    odeint::adams_bashforth_moulton<past, State> stepper_;
    Fehlberg<State> starter_;
    long all_steps_;
};

}  // namespace

std::vector<ExternalMethod> odeint_peers() {
    return {peer_of<OfPair<Fehlberg>::Solver>("odeint rkf78", true, 1e-14, 1e-1),
            peer_of<OfPair<DormandPrince>::Solver>("odeint dopri5", true, 1e-13, 1e-1),
            peer_of<BulirschStoer>("odeint bulirsch_stoer", true, 1e-14, 1e-1),
            peer_of<AdamsBashforthMoulton>("odeint adams 8", false, 5e-4, 1e-1)};
}

}  // namespace doppel
