#include "integrate/any_stepper.hpp"

namespace doppel {

template MakeAnyStepper<State<double, 4>> make_any_stepper;
template MakeAnyStepper<State<double, 6>> make_any_stepper;
template MakeAnyStepper<State<double, Eigen::Dynamic>> make_any_stepper;

}  // namespace doppel
