#pragma once

#include "figure/part_file.hpp"

#include <atomic>

namespace doppel {

/// The numbers of a figure from its shards in `folder`, each of which must be there once, whole and of this figure.
/// Throws Error: exit 2 where parts are missing, there twice or belong to something else, exit 4 where one cannot be
/// read or is damaged, exit 130 soon after `stop` is set.
KnownTrials merged_parts(const FigurePreset& figure, const std::filesystem::path& folder,
                         const std::atomic<bool>& stop);

}  // namespace doppel
