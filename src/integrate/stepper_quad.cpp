#include "integrate/angle_series.hpp"
#include "integrate/motion_steppers.hpp"
#include "integrate/taped_series.hpp"

namespace doppel {

template <>
std::unique_ptr<Series<Quad>> series_of(const Pendulum<Quad>& p, int order) {
    return std::make_unique<AngleSeries<Quad>>(p, order);
}
template SeriesOfBodies<Quad> series_of;
template SeriesOfMechanism<Quad> series_of;
template CompiledStepper<State<Quad, Eigen::Dynamic>> compiled_stepper;
template MakeStepper<Quad> make_angles_stepper;
template MakeStepper<Quad> make_constraints_stepper;
template MakeStepper<Quad> make_mechanism_stepper;

}  // namespace doppel
