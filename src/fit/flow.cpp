#include "fit/flow.hpp"

namespace doppel {

template class Flow<double>;
template class Flow<Dual<double, few_directions>>;
template class Flow<Dual<double, all_directions>>;

}  // namespace doppel
