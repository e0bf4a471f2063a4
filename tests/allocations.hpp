#pragma once

namespace doppel {

/// The number of memory allocations of this process to date, by Eigen or by new; always 0 under sanitizers, which
/// replace malloc.
long allocations();

}  // namespace doppel
