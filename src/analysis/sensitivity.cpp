#include "analysis/sensitivity.hpp"

#include "analysis/tangent.hpp"
#include "base/error.hpp"
#include "physics/angle_chain.hpp"
#include "physics/double_pendulum.hpp"

namespace doppel {
namespace {

/// The largest angle of the tangent that starts as one radian in angle `which`.
template <class Model>
double largest_angle(const Pendulum<double>& p, double seconds, Eigen::Index which, const std::atomic<bool>& stop) {
    constexpr double tolerance = 1e-11;
    const auto links = static_cast<Eigen::Index>(p.links());
    auto start = Model::start(p.cast<typename Model::Scalar>());
    start[which].tangent[0] = 1;
    typename TangentMotion<Model>::State y(4 * links);
    TangentFlow<Model>::from_dual(start, y);
    TangentMotion<Model> motion(p, tolerance);
    const long parts = parts_of(seconds, NaturalUnits(p));
    double grown = 1;
    for (long i = 0; i < parts; ++i) {
        if (stop) throw Error(ExitCode::interrupted, "interrupted");
        // the equations are linear in the tangent: its size is kept apart
        const double size = y.tail(2 * links).norm();
        grown *= size;
        y.tail(2 * links) /= size;
        motion.set_down(y);
        motion.advance(seconds / static_cast<double>(parts));
        y = motion.state();
    }
    return grown * y.segment(2 * links, links).cwiseAbs().maxCoeff();
}

template <class Model>
double largest(const Pendulum<double>& p, double seconds, const std::atomic<bool>& stop) {
    double most = 0;
    for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(p.links()); ++i)
        most = std::max(most, largest_angle<Model>(p, seconds, i, stop));
    return most;
}

}  // namespace

double angle_sensitivity(const Pendulum<double>& p, double seconds, const std::atomic<bool>& stop) {
    if (p.links() == 2) return largest<DoublePendulum<Dual<double, 1>>>(p, seconds, stop);
    return largest<AngleChain<Dual<double, 1>, Eigen::Dynamic>>(p, seconds, stop);
}

}  // namespace doppel
