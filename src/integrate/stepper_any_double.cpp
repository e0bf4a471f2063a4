#include "integrate/registry.hpp"

namespace doppel {

template CompiledStepper<State<double, 4>> compiled_stepper;
template CompiledStepper<State<double, 6>> compiled_stepper;
template CompiledStepper<State<double, Eigen::Dynamic>> compiled_stepper;

}  // namespace doppel
