#include "integrate/motion_models.hpp"

namespace doppel {

template std::unique_ptr<Motion> make_angles_motion<double>(const MotionSpec& spec);
template std::unique_ptr<Motion> make_constraints_motion<double>(const MotionSpec& spec);

}  // namespace doppel
