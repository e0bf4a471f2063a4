#include "integrate/taylor_batch.hpp"

#include "base/error.hpp"
#include "integrate/batch_table.hpp"
#include "integrate/taylor_batch_kernel.hpp"
#include "integrate/widths.hpp"

#include <algorithm>

namespace doppel {

TaylorLanes::~TaylorLanes() = default;

TaylorBatch::TaylorBatch(std::span<const Pendulum<double>> members, double tolerance, double interval, int width)
    : members_(members.size()) {
    const BatchTable table(members);
    if (!serves(Model::angles, table.links))
        throw bad_input("Taylor series step pendulums of two or three links side by side, not of {}", table.links);
    if (!(tolerance >= least_tolerance))
        throw bad_input("taylor: tolerance = {:.3g} cannot be met in double; the finest is {:.1g}", tolerance,
                        least_tolerance);
    const TaylorBatchRequest request{
        .members = members.size(),
        .links = table.links,
        .mass = table.mass.data(),
        .length = table.length.data(),
        .angle = table.angle.data(),
        .rate = table.rate.data(),
        .gravity = table.gravity.data(),
        .tolerance = tolerance,
        .order = std::clamp(taylor_order(tolerance), watched_coefficients + 1, most_batch_orders),
        .interval = interval};
    lanes_.reset(at_width(chosen_width(width), []<int chosen>() { return make_taylor_lanes<chosen>; })(request));
    numbers_ = 2 * table.links;
    states_.resize(static_cast<std::size_t>(window) * members_ * numbers_);
    compute();
}

TaylorBatch::~TaylorBatch() = default;
TaylorBatch::TaylorBatch(TaylorBatch&&) noexcept = default;

void TaylorBatch::compute() {
    lanes_->compute(first_, window, states_.data());
}

void TaylorBatch::advance() {
    if (++sample_ < first_ + window) return;
    first_ += window;
    compute();
}

void TaylorBatch::read(std::size_t member, State<double, Eigen::Dynamic>& y) const {
    const auto row = static_cast<std::size_t>(sample_ - first_);
    y = Eigen::Map<const Eigen::VectorXd>(states_.data() + (row * members_ + member) * numbers_,
                                          static_cast<Eigen::Index>(numbers_));
}

}  // namespace doppel
