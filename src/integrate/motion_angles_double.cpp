#include "integrate/motion_angles.hpp"

namespace doppel {

template std::unique_ptr<Motion> make_angles_motion<double>(const MotionSpec& spec);

}  // namespace doppel
