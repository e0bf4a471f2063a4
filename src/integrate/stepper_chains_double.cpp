#include "integrate/motion_steppers.hpp"

namespace doppel {

template MakeStepper<double> make_angles_stepper;
template MakeStepper<double> make_constraints_stepper;

}  // namespace doppel
