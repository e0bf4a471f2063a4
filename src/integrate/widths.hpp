#pragma once

#include <vector>

namespace doppel {

/// How many doubles the registers may hold that this processor and this build compute in, narrowest first.
std::vector<int> register_widths();

/// `asked`, or the widest where it is 0. Throws Error (exit 2) where it is none of register_widths().
int chosen_width(int asked);

/// call.operator()<width>(), of the code that was compiled for that width (cmake/widths.cmake).
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
