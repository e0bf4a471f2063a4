#pragma once

#include <vector>

namespace doppel {

/// The register widths, in doubles, that both this processor and this build support, in ascending order.
std::vector<int> register_widths();

/// `requested`, or the widest if it is 0. Throws Error (exit 2) if it is not among register_widths().
int chosen_width(int requested);

/// Calls call.operator()<width>() with the code compiled for that width (cmake/widths.cmake).
template <class Call>
auto at_width(int width, const Call& call) {
    switch (width) {
#ifdef DOPPEL_WIDE_REGISTERS
        case 4:
            return call.template operator()<4>();
        case 8:
            return call.template operator()<8>();
#endif
        default:
            return call.template operator()<2>();
    }
}

}  // namespace doppel
