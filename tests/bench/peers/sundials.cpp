#include "chain_solver.hpp"
#include "peers.hpp"

#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

namespace doppel {
namespace {

/// Frees an object of SUNDIALS with its own function.
template <auto free>
struct Freed {
    template <class Pointer>
    void operator()(Pointer pointer) const {
        free(pointer);
    }
};
struct FreedContext {
    void operator()(SUNContext context) const { SUNContext_Free(&context); }
};
template <auto free>
struct FreedMemory {
    void operator()(void* memory) const { free(&memory); }
};

void check(int error, const char* what) {
    if (error < 0) throw method_failed("sundials: {} answers {}", what, error);
}

/// The context and the vector of every SUNDIALS solver.
template <int N>
class SundialsSolver : public ChainSolver<N> {
public:
    SundialsSolver(const Pendulum<double>& chain, double seconds) : ChainSolver<N>(chain, seconds) {
        SUNContext context = nullptr;
        check(SUNContext_Create(nullptr, &context), "SUNContext_Create");
        context_.reset(context);
        vector_.reset(N_VMake_Serial(static_cast<sunindextype>(this->y_.size()), this->y_.data(), context));
        check(N_VEnableFusedOps_Serial(vector_.get(), SUNTRUE), "N_VEnableFusedOps_Serial");
    }

protected:
    static int slope(double t, N_Vector y, N_Vector dydt, void* rate) {
        return ChainSolver<N>::slope(t, N_VGetArrayPointer(y), N_VGetArrayPointer(dydt), rate);
    }

    std::unique_ptr<std::remove_pointer_t<SUNContext>, FreedContext> context_;
    std::unique_ptr<std::remove_pointer_t<N_Vector>, Freed<N_VDestroy>> vector_;  // the numbers of y_
};

/// CVODE: Adams methods of orders 1 to 12 with fixed-point iteration of the corrector.
template <int N>
class Cvode final : public SundialsSolver<N> {
public:
    Cvode(const Pendulum<double>& chain, double seconds, double tolerance)
        : SundialsSolver<N>(chain, seconds),
          memory_(CVodeCreate(CV_ADAMS, this->context_.get())),
          iteration_(SUNNonlinSol_FixedPoint(this->vector_.get(), 0, this->context_.get())) {
        void* const cvode = memory_.get();
        CVodeSetErrFile(cvode, nullptr);
        check(CVodeInit(cvode, this->slope, 0, this->vector_.get()), "CVodeInit");
        check(CVodeSStolerances(cvode, tolerance, tolerance), "CVodeSStolerances");
        check(CVodeSetUserData(cvode, &this->rate_), "CVodeSetUserData");
        check(CVodeSetNonlinearSolver(cvode, iteration_.get()), "CVodeSetNonlinearSolver");
        check(CVodeSetMaxNumSteps(cvode, this->max_steps), "CVodeSetMaxNumSteps");
    }

private:
    void integrate() override {
        double t = 0;
        check(CVodeReInit(memory_.get(), 0, this->vector_.get()), "CVodeReInit");
        check(CVode(memory_.get(), this->seconds_, this->vector_.get(), &t, CV_NORMAL), "CVode");
        check(CVodeGetNumSteps(memory_.get(), &this->steps_), "CVodeGetNumSteps");
    }

    std::unique_ptr<void, FreedMemory<CVodeFree>> memory_;
    std::unique_ptr<std::remove_pointer_t<SUNNonlinearSolver>, Freed<SUNNonlinSolFree>> iteration_;
};

/// ARKODE: its default explicit pair of order 8, Fehlberg's 8(7) in 13 stages.
template <int N>
class Arkode final : public SundialsSolver<N> {
public:
    Arkode(const Pendulum<double>& chain, double seconds, double tolerance)
        : SundialsSolver<N>(chain, seconds),
          memory_(ERKStepCreate(this->slope, 0, this->vector_.get(), this->context_.get())) {
        void* const arkode = memory_.get();
        ERKStepSetErrFile(arkode, nullptr);
        check(ERKStepSStolerances(arkode, tolerance, tolerance), "ERKStepSStolerances");
        check(ERKStepSetUserData(arkode, &this->rate_), "ERKStepSetUserData");
        check(ERKStepSetOrder(arkode, 8), "ERKStepSetOrder");
        check(ERKStepSetMaxNumSteps(arkode, this->max_steps), "ERKStepSetMaxNumSteps");
    }

private:
    void integrate() override {
        double t = 0;
        void* const arkode = memory_.get();
        check(ERKStepReInit(arkode, this->slope, 0, this->vector_.get()), "ERKStepReInit");
        // exactly at the end: its interpolation has order 5, and seven times the error at 1e-13 on P1
        check(ERKStepSetStopTime(arkode, this->seconds_), "ERKStepSetStopTime");
        check(ERKStepEvolve(arkode, this->seconds_, this->vector_.get(), &t, ARK_NORMAL), "ERKStepEvolve");
        check(ERKStepGetNumSteps(arkode, &this->steps_), "ERKStepGetNumSteps");
    }

    std::unique_ptr<void, FreedMemory<ERKStepFree>> memory_;
};

}  // namespace

std::vector<ExternalMethod> sundials_peers() {
    return {peer_of<Cvode>("CVODE adams", true, 1e-14, 1e-1), peer_of<Arkode>("ARKODE rkf78", true, 1e-14, 1e-1)};
}

}  // namespace doppel
