#include "integrate/batch.hpp"

#include "base/error.hpp"
#include "integrate/batch_kernel.hpp"
#include "integrate/batch_table.hpp"
#include "integrate/widths.hpp"
#include "physics/angle_chain.hpp"
#include "physics/rod_chain.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>

namespace doppel {

BatchBlock::~BatchBlock() = default;

namespace {

constexpr auto method_names = []<std::size_t... I>(std::index_sequence<I...>) {
    return std::array{std::tuple_element_t<I, BatchMethods>::method.name...};
}
(std::make_index_sequence<std::tuple_size_v<BatchMethods>>());

/// The number of a method in BatchMethods; their count where it is none of them.
std::size_t method_number(std::string_view name) {
    return static_cast<std::size_t>(std::find(method_names.begin(), method_names.end(), name) - method_names.begin());
}

/// A long chain on its own.
BatchBlock* make_lone_block(const BatchRequest& request, std::size_t member) {
    const auto pendulum = pendulum_of<double>(request, member);
    return request.constraints ? with_method<RodChain<double, Eigen::Dynamic>>(request, pendulum)
                               : with_method<AngleChain<double, Eigen::Dynamic>>(request, pendulum);
}

}  // namespace

bool Batch::serves(std::string_view method) {
    return method_number(method) < method_names.size();
}

Batch::Batch(std::span<const Pendulum<double>> members, Model model, std::string_view method, double step, int width) {
    const BatchTable table(members);
    auto* make = make_lone_block;
    if (table.links <= batch_links) {
        width_ = chosen_width(width);
        block_ = static_cast<std::size_t>(batch_block(width_));
        make = at_width(width_, []<int chosen>() { return make_batch_block<chosen>; });
    }
    if (!serves(method))
        throw bad_input("\"{}\" does not step many pendulums side by side; these do: {}", method,
                        fmt::join(method_names, ", "));
    const BatchRequest request{.members = members.size(),
                               .links = table.links,
                               .mass = table.mass.data(),
                               .length = table.length.data(),
                               .angle = table.angle.data(),
                               .rate = table.rate.data(),
                               .gravity = table.gravity.data(),
                               .step = step,
                               .constraints = model == Model::constraints,
                               .method = method_number(method)};
    for (std::size_t first = 0; first < members.size(); first += block_) blocks_.emplace_back(make(request, first));
}

Batch::~Batch() = default;
Batch::Batch(Batch&&) noexcept = default;

void Batch::advance(long steps) {
    for (auto& block : blocks_) block->advance(steps);
}

State<double, Eigen::Dynamic> Batch::state(std::size_t member) const {
    State<double, Eigen::Dynamic> y;
    read(member, y);
    return y;
}

void Batch::read(std::size_t member, State<double, Eigen::Dynamic>& y) const {
    const auto& block = *blocks_[member / block_];
    y.resize(static_cast<Eigen::Index>(block.dimensions()));
    block.read(member % block_, y.data());
}

}  // namespace doppel
