#pragma once

#include <cstddef>

namespace doppel {

// What passes between integrate/ensemble.cpp and the code that was compiled for one kind of processor
// (integrate/ensemble_width.cpp): plain numbers, so that no function of a common type is compiled twice for different
// processors under the same name.

/// Trials of one shape, stored by quantity: quantity j of trial i is at [j · trials + i].
struct EnsembleRequest {
    std::size_t trials, links;
    const double *mass, *length, *angle, *rate;  // of link j
    const double* gravity;                       // one a trial
    double step;                                 // s
    bool constraints;                            // the model: else angles
    std::size_t method;                          // its number in EnsembleMethods
};

inline constexpr std::size_t ensemble_links = 4;  // the longest chain that is stepped in lanes

/// Some trials that are stepped side by side.
class EnsembleBlock {
public:
    virtual ~EnsembleBlock();
    virtual void advance(long steps) = 0;
    virtual std::size_t dimensions() const = 0;
    /// Writes the state of trial `lane` of the block, dimensions() numbers, to `entries`.
    virtual void read(std::size_t lane, double* entries) const = 0;
};

/// The trials of one block: twice the doubles of a register, for while one half waits for its results the other works.
inline constexpr int ensemble_block(int width) {
    return 2 * width;
}

/// The block of the trials from `first`, filled up with the last one, in the code for registers of `width` doubles: 2
/// for every processor, 4 for AVX2, 8 for AVX-512 (cmake/widths.cmake). The caller deletes it.
template <int width>
EnsembleBlock* make_ensemble_block(const EnsembleRequest& request, std::size_t first);
template <>
EnsembleBlock* make_ensemble_block<2>(const EnsembleRequest& request, std::size_t first);
template <>
EnsembleBlock* make_ensemble_block<4>(const EnsembleRequest& request, std::size_t first);
template <>
EnsembleBlock* make_ensemble_block<8>(const EnsembleRequest& request, std::size_t first);

}  // namespace doppel
