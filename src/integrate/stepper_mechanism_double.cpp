#include "integrate/motion_steppers.hpp"

namespace doppel {

template MakeStepper<double> make_mechanism_stepper;

}  // namespace doppel
