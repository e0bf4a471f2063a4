#include "integrate/any_stepper.hpp"
#include "integrate/motion_models.hpp"

namespace doppel {

template MakeAnyStepper<State<Quad, 4>> make_any_stepper;
template MakeAnyStepper<State<Quad, Eigen::Dynamic>> make_any_stepper;
template std::unique_ptr<Motion> make_angles_motion<Quad>(const MotionSpec& spec);
template std::unique_ptr<Motion> make_constraints_motion<Quad>(const MotionSpec& spec);
template std::unique_ptr<Motion> make_mechanism_motion<Quad>(const MotionSpec& spec);

}  // namespace doppel
