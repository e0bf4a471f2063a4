#include "integrate/mechanism_series.hpp"

namespace doppel {

template SeriesOfBodies<double> series_of_bodies;
template SeriesOfMechanism<double> series_of_mechanism;

}  // namespace doppel
