// Compiled once for every kind of processor (cmake/widths.cmake). The linker keeps one copy of a function that several
// objects define, and one compiled for AVX-512 would stop older processors. So nothing here has a name that others can
// see but the one function: all templates are instantiated for a type of this file alone, and nothing else is called
// that may be compiled out of line here.

#include "integrate/batch_kernel.hpp"
#include "physics/angle_chain.hpp"
#include "physics/rod_chain.hpp"

namespace doppel {
namespace {

struct ThisBuild;
using Pack = Lanes<batch_block(compiled_width), ThisBuild>;

template <int links>
BatchBlock* with_links(const BatchRequest& request, const Pendulum<Pack>& pendulum) {
    if (request.constraints) return with_method<RodChain<Pack, links>>(request, pendulum);
    if constexpr (links == 2) return with_method<DoublePendulum<Pack>>(request, pendulum);
    return with_method<AngleChain<Pack, links>>(request, pendulum);
}

}  // namespace

template <>
BatchBlock* make_batch_block<compiled_width>(const BatchRequest& request, std::size_t first) {
    const auto pendulum = pendulum_of<Pack>(request, first);
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
