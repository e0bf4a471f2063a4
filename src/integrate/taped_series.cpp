#include "integrate/mechanism_series.hpp"

namespace doppel {

template SeriesOfBodies<double> series_of;
template SeriesOfMechanism<double> series_of;

}  // namespace doppel
