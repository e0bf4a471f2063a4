#include "integrate/mechanism_series.hpp"

namespace doppel {

template <>
std::unique_ptr<Series<double>> series_of_bodies(const PhysicalChain<double>& model, int order) {
    return std::make_unique<BodiesSeries<double>>(model, order);
}
template <>
std::unique_ptr<Series<double>> series_of_mechanism(const Assembly<double>& parts, int order) {
    return std::make_unique<MechanismSeries<double>>(parts, order);
}

}  // namespace doppel
