// Compiled once for every kind of processor (cmake/widths.cmake). The linker keeps one copy of a function that several
// objects define, and one compiled for AVX-512 would stop older processors. So nothing here has a name that others can
// see but the one function: all templates are instantiated for a type of this file alone, and nothing else is called
// that may be compiled out of line.

#include "integrate/ensemble_block.hpp"
#include "physics/angle_chain.hpp"
#include "physics/double_pendulum.hpp"
#include "physics/rod_chain.hpp"

#ifndef DOPPEL_ENSEMBLE_WIDTH
#define DOPPEL_ENSEMBLE_WIDTH 2
#endif

namespace doppel {
namespace {

constexpr int width = DOPPEL_ENSEMBLE_WIDTH;

struct ThisBuild;
using Side = Lanes<ensemble_block(width), ThisBuild>;

template <int links>
EnsembleBlock* with_links(const EnsembleRequest& request, const Pendulum<Side>& pendulum) {
    if (request.constraints) return with_method<RodChain<Side, links>>(request, pendulum);
    if constexpr (links == 2) return with_method<DoublePendulum<Side>>(request, pendulum);
    return with_method<AngleChain<Side, links>>(request, pendulum);
}

}  // namespace

template <>
EnsembleBlock* make_ensemble_block<width>(const EnsembleRequest& request, std::size_t first) {
    const auto pendulum = pendulum_of<Side>(request, first);
    switch (request.links) {
        case 1:
            return with_links<1>(request, pendulum);
        case 2:
            return with_links<2>(request, pendulum);
        case 3:
            return with_links<3>(request, pendulum);
        case 4:
            return with_links<4>(request, pendulum);
        default:
            return nullptr;
    }
}

}  // namespace doppel
