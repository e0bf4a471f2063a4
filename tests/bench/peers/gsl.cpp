#include "chain_solver.hpp"
#include "peers.hpp"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

namespace doppel {
namespace {

/// Any stepper of gsl_odeiv2 with its driver.
template <int N>
class GslSolver final : public ChainSolver<N> {
public:
    GslSolver(const Pendulum<double>& chain, double seconds, double tolerance, const gsl_odeiv2_step_type* type)
        : ChainSolver<N>(chain, seconds),
          system_{ChainSolver<N>::slope, nullptr, this->y_.size(), &this->rate_},
          driver_(gsl_odeiv2_driver_alloc_y_new(&system_, type, this->first_step, tolerance, tolerance)) {
        if (!driver_) throw method_failed("gsl: no driver for tolerance = {:.3g}", tolerance);
        gsl_odeiv2_driver_set_nmax(driver_.get(), this->max_steps);
    }

private:
    void integrate() override {
        double t = 0;
        gsl_odeiv2_driver_reset_hstart(driver_.get(), this->first_step);
        const int error = gsl_odeiv2_driver_apply(driver_.get(), &t, this->seconds_, this->y_.data());
        if (error != GSL_SUCCESS) throw method_failed("gsl: {} at t = {:.3g} s", gsl_strerror(error), t);
        this->steps_ = static_cast<long>(driver_->n);
    }

    struct Free {
        void operator()(gsl_odeiv2_driver* driver) const { gsl_odeiv2_driver_free(driver); }
    };
    gsl_odeiv2_system system_;
    std::unique_ptr<gsl_odeiv2_driver, Free> driver_;
};

}  // namespace

std::vector<ExternalMethod> gsl_peers() {
    gsl_set_error_handler_off();  // it would stop the program
    return {peer_of<GslSolver>("GSL rk8pd", true, 1e-14, 1e-1, gsl_odeiv2_step_rk8pd),
            peer_of<GslSolver>("GSL rkf45", true, 1e-13, 1e-1, gsl_odeiv2_step_rkf45),
            peer_of<GslSolver>("GSL msadams", true, 1e-14, 1e-1, gsl_odeiv2_step_msadams)};
}

}  // namespace doppel
