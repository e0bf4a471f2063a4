#include "integrate/any_stepper.hpp"
#include "integrate/motion_steppers.hpp"

namespace doppel {

template MakeAnyStepper<State<Quad, 4>> make_any_stepper;
template MakeAnyStepper<State<Quad, Eigen::Dynamic>> make_any_stepper;
template MakeStepper<Quad> make_angles_stepper;
template MakeStepper<Quad> make_constraints_stepper;
template MakeStepper<Quad> make_mechanism_stepper;

}  // namespace doppel
