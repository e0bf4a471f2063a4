#include "integrate/taylor.hpp"

#include "integrate/taped_series.hpp"

namespace doppel {

template class SeriesStepper<double>;
template class SeriesStepper<Quad>;
template SeriesOfBodies<double> series_of;
template SeriesOfMechanism<double> series_of;

}  // namespace doppel
