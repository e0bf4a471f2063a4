#include "integrate/segment_series.hpp"

#include "integrate/taylor_series.hpp"
#include "integrate/widths.hpp"
#include "numeric/subnormals.hpp"

#include <cmath>

namespace doppel {

SegmentSeries::SegmentSeries(const Pendulum<double>& p, int order, int width)
    : links_(static_cast<int>(p.links())),
      blocks_((links_ + lanes - 1) / lanes),
      order_(order),
      gravity_(p.gravity),
      longest_step_(longest_chain_step(p.reach(), p.gravity)),
      rods_(std::make_unique<Rod[]>(static_cast<std::size_t>(blocks_))),
      terms_(std::make_unique<Term[]>(static_cast<std::size_t>(blocks_) * static_cast<std::size_t>(order + 3))),
      sums_(std::make_unique<std::array<Sums, group>[]>(static_cast<std::size_t>(blocks_))),
      work_(std::make_unique<Work[]>(static_cast<std::size_t>(blocks_))),
      inverse_(std::make_unique<double[]>(static_cast<std::size_t>(order + 3))),
      greatest_(std::make_unique<double[]>(static_cast<std::size_t>(order + 1))),
      kernel_(at_width(chosen_width(width), []<int chosen>() { return segment_kernel<chosen>(); })) {
    for (int k = 1; k < order + 3; ++k) inverse_[static_cast<std::size_t>(k)] = 1 / static_cast<double>(k);
    for (int i = 0; i < blocks_ * lanes; ++i) {
        Rod& rod = rods_[static_cast<std::size_t>(i % blocks_)];
        const auto lane = static_cast<std::size_t>(i / blocks_), link = static_cast<std::size_t>(i);
        const bool is_there = i < links_;  // what fills up the last block hangs on nothing and rests
        rod.between.of[lane] = i + 1 < links_ ? 1 / p.mass[link] : 0;
        rod.both.of[lane] = is_there ? 1 / p.mass[link] : 1;
        if (is_there && i > 0) rod.both.of[lane] += 1 / p.mass[link - 1];
        rod.length.of[lane] = is_there ? p.length[link] : 1;
        rod.by_length.of[lane] = 1 / rod.length.of[lane];
    }
}

SegmentSeries::View SegmentSeries::view() const {
    return {links_,       blocks_,     order_,      gravity_,       rods_.get(),
            terms_.get(), sums_.get(), work_.get(), inverse_.get(), greatest_.get()};
}

void SegmentSeries::move_by(double h, double* change) const {
    const NoSubnormals here;
    kernel_.move(view(), h, change);
}

void SegmentSeries::expand_about(const double* y) {
    const NoSubnormals here;
    kernel_.expand(view(), y);
    amount_ = greatest_[0] + std::sqrt(greatest_[1]);
}

}  // namespace doppel
