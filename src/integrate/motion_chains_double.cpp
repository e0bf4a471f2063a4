#include "integrate/motion_angles.hpp"
#include "integrate/motion_constraints.hpp"

namespace doppel {

template std::unique_ptr<Motion> make_angles_motion<double>(const MotionSpec& spec);
template std::unique_ptr<Motion> make_constraints_motion<double>(const MotionSpec& spec);

}  // namespace doppel
