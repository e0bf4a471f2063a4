#include "integrate/widths.hpp"

#include "base/error.hpp"

#include <algorithm>

namespace doppel {

std::vector<int> register_widths() {
    std::vector<int> widths{2};
#ifdef DOPPEL_WIDE_REGISTERS
    if (__builtin_cpu_supports("avx2")) widths.push_back(4);
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) widths.push_back(8);
#endif
    return widths;
}

int chosen_width(int requested) {
    const auto all = register_widths();
    if (requested == 0) return all.back();
    if (std::find(all.begin(), all.end(), requested) == all.end())
        throw bad_input("this processor has no registers of {} doubles; the widest have {}", requested, all.back());
    return requested;
}

}  // namespace doppel
