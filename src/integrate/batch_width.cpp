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

}  // namespace

template <>
BatchBlock* make_batch_block<compiled_width>(const BatchRequest& request, std::size_t first) {
    const auto pendulum = pendulum_of<Pack>(request, first);
    if (request.members->links() == 2)
        return request.constraints ? with_method<RodChain<Pack, 2>>(request, pendulum)
                                   : with_method<DoublePendulum<Pack>>(request, pendulum);
    return request.constraints ? with_method<RodChain<Pack, 3>>(request, pendulum)
                               : with_method<AngleChain<Pack, 3>>(request, pendulum);
}

}  // namespace doppel
