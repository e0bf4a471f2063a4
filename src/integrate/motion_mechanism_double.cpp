#include "integrate/motion_models.hpp"

namespace doppel {

template std::unique_ptr<Motion> make_mechanism_motion<double>(const MotionSpec& spec);

}  // namespace doppel
