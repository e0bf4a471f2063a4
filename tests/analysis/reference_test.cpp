#include "analysis/reference.hpp"

#include "analysis/angle_error.hpp"
#include "integrate/pendulums.hpp"
#include "numeric/error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace doppel {
namespace {

const std::atomic<bool> never = false;

MotionSpec chain(std::vector<double> angle_deg) {
    MotionSpec spec;
    spec.chain = from_rest(std::move(angle_deg)).cast<Quad>();
    return spec;
}

TEST(Reference, OfTwoEquationsThatAgree) {
    const auto reference = reference_end(chain({150, 90}), {5, 1}, 1e-26, never);
    EXPECT_LT(reference.disagreement, 1e-28);  // measured 8e-33
    ASSERT_EQ(reference.end.size(), 2u);
    // a method of another family, in double
    auto spec = chain({150, 90});
    spec.method = "dop853";
    spec.tolerance = parse_quad("1e-14");
    spec.sample_interval = {5, 1};
    const auto motion = make_motion(spec);
    motion->advance(never);
    EXPECT_LT(angle_error(motion->observe().bobs, reference.end), 1e-10);  // measured 4e-13
}

TEST(Reference, OfOneLinkAfterItsPeriod) {
    // Gauss 1799: T = 2π √(l/g) / agm(1, cos(A/2)), here of A = 90° in quad
    Quad a = 1, b = sqrt(Quad(0.5));
    for (int i = 0; i < 8; ++i) {
        const Quad mean = (a + b) / 2;
        b = sqrt(Quad(a * b));
        a = mean;
    }
    MotionSpec spec;
    spec.chain = Pendulum<Quad>{{1}, {1}, {pi_of<Quad>() / 2}, {0}, 1};
    // gravity such that the period is one second
    const Quad root = 2 * pi_of<Quad>() / a;
    spec.chain->gravity = root * root;
    const auto reference = reference_end(spec, {1, 1}, 1e-26, never);
    EXPECT_LT(static_cast<double>(abs(Quad(reference.end[0].theta - pi_of<Quad>() / 2))), 1e-29);  // measured 2e-33
}

TEST(Reference, RefusesWhereTheTwoDisagree) {
    try {
        reference_end(chain({90, 90}), {3, 1}, 1e-40, never);
        FAIL() << "it agrees to more digits than there are";
    } catch (const Error& fault) {
        EXPECT_EQ(fault.code(), ExitCode::method_failed);
        EXPECT_NE(std::string(fault.what()).find("no reference"), std::string::npos) << fault.what();
    }
}

TEST(Reference, OfAMechanismByTwoTolerances) {
    // a mass that circles on a spring of rest length 0, without gravity: x = cos t, y = sin t
    MotionSpec spec;
    spec.model = Model::mechanism;
    spec.parts.emplace();
    spec.parts->particles.push_back({1, Place<Quad>(1, 0), Place<Quad>(0, 1)});
    spec.parts->forces.emplace_back(Spring<Quad>{0, Place<Quad>(0, 0), 1, 0, 0});
    const auto reference = reference_end(spec, {2, 1}, 1e-26, never);
    EXPECT_LT(static_cast<double>(abs(Quad(reference.end[0].x - cos(Quad(2))))), 1e-28);  // measured 1e-31
}

TEST(Reference, StopsWhenAsked) {
    const std::atomic<bool> stop = true;
    EXPECT_THROW(reference_end(chain({90, 90}), {10, 1}, 1, stop), Error);
}

}  // namespace
}  // namespace doppel
