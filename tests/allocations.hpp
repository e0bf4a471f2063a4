#pragma once

namespace doppel {

/// How many times this process has asked for memory so far, by Eigen or by new; always 0 under sanitizers, which keep
/// malloc to themselves.
long allocations();

}  // namespace doppel
