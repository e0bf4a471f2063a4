#include "integrate/motion.hpp"

#include "integrate/methods.hpp"
#include "integrate/simulation.hpp"

namespace doppel {
namespace {

template <class Scalar>
std::unique_ptr<Motion> made(const MotionSpec& spec) {
    switch (spec.model) {
        case Model::angles:
            return make_angles_motion<Scalar>(spec);
        case Model::constraints:
            return make_constraints_motion<Scalar>(spec);
        case Model::mechanism:
            break;
    }
    return make_mechanism_motion<Scalar>(spec);
}

}  // namespace

std::unique_ptr<Motion> make_motion(const MotionSpec& spec) {
    const auto* method = find_method(spec.method);
    if (!method) throw bad_input("there is no method \"{}\"", spec.method);
    if (spec.stabilise != Stabilise::none && spec.model == Model::angles)
        throw bad_input("in angles the rods keep their length by themselves; there is nothing to stabilise");
    if (spec.stabilise != Stabilise::none && !method->stabilised)
        throw bad_input("the method \"{}\" keeps the constraints itself; there is nothing to stabilise", spec.method);
    return spec.precision == Precision::in_double ? made<double>(spec) : made<Quad>(spec);
}

}  // namespace doppel
