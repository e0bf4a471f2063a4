// Compiled once for each register width (cmake/widths.cmake). If several object files define a function, the linker
// keeps one of them, and one for AVX-512 would not run on older processors. So only one function of this file is
// visible to others. All templates are instantiated with a type of this file, and nothing else is called that could be
// compiled out of line here.

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
