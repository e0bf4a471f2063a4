#include "integrate/motion_angles.hpp"

namespace doppel {

template std::unique_ptr<Motion> make_angles_motion<Quad>(const MotionSpec& spec);

}  // namespace doppel
