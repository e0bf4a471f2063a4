#include "integrate/motion_mechanism.hpp"

namespace doppel {

template std::unique_ptr<Motion> make_mechanism_motion<Quad>(const MotionSpec& spec);

}  // namespace doppel
