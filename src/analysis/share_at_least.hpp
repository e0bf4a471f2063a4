#pragma once

namespace doppel {

/// From `hits` of `trials` drawn by lot: the share of all that are hits, with 95 % confidence at least; 0 without
/// trials. Source  Clopper & Pearson 1934, Biometrika 26:404, one-sided.
double share_at_least(int hits, int trials);

}  // namespace doppel
