#include "integrate/taylor.hpp"

namespace doppel {

template class SeriesStepper<double>;
template class SeriesStepper<Quad>;

}  // namespace doppel
