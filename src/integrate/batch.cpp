#include "integrate/batch.hpp"

#include "base/error.hpp"
#include "integrate/batch_kernel.hpp"
#include "integrate/widths.hpp"

namespace doppel {

BatchBlock::~BatchBlock() = default;

bool Batch::supports(std::string_view method, std::size_t links) {
    return (method == Euler::method.name || method == Rk4::method.name) && (links == 2 || links == 3);
}

Batch::Batch(std::span<const Pendulum<double>> members, Model model, std::string_view method, double step, int width)
    : width_(chosen_width(width)), block_(static_cast<std::size_t>(batch_block(width_))) {
    if (members.empty()) throw bad_input("a batch needs at least one pendulum");
    const auto links = members[0].links();
    for (const auto& member : members)
        if (member.links() != links)
            throw bad_input("all pendulums of a batch must have the same number of links; they have {} and {}", links,
                            member.links());
    if (!supports(method, links))
        throw bad_input("a batch needs two or three links and euler or rk4; it has {} and {}", links, method);
    const auto make = at_width(width_, []<int chosen>() { return make_batch_block<chosen>; });
    const BatchRequest request{.members = members.data(),
                               .count = members.size(),
                               .step = step,
                               .constraints = model == Model::constraints,
                               .by_rk4 = method == Rk4::method.name};
    for (std::size_t first = 0; first < members.size(); first += block_) blocks_.emplace_back(make(request, first));
}

Batch::~Batch() = default;
Batch::Batch(Batch&&) noexcept = default;

void Batch::advance(long steps) {
    for (auto& block : blocks_) block->advance(steps);
}

void Batch::read(std::size_t member, State<double, Eigen::Dynamic>& y) const {
    const auto& block = *blocks_[member / block_];
    y.resize(static_cast<Eigen::Index>(block.dimensions()));
    block.read(member % block_, y.data());
}

}  // namespace doppel
