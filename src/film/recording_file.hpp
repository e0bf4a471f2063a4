#pragma once

#include "film/recording.hpp"
#include "output/blocks.hpp"

namespace doppel {

/// The file of a recording: a block contains the numbers of a snapshot.
inline constexpr BlockKind recording_file{R"({"file":"doppel recording")", "is no recording of Doppel",
                                          "is damaged or incomplete; make it again with simulate --recording"};

/// Writes the snapshots of a scene to such a file. Throws Error (exit 4).
class RecordingWriter : BlockFile {
public:
    RecordingWriter(const std::filesystem::path& path, const Scene& scene);
    /// `record` = the effort up to this snapshot.
    void add(Snapshot snapshot, MotionRecord record);
    using BlockFile::finish;
};

/// Reads such a file. Throws Error: exit 2 if it belongs to another motion or version, exit 4 if it cannot be read or
/// is damaged.
class RecordingReader : BlockFile {
public:
    RecordingReader(const std::filesystem::path& path, const Scene& scene);
    /// The snapshot of this moment; earlier ones are left out. Sets the effort in `record`.
    Snapshot at(const Moment& moment, MotionRecord& record);
};

}  // namespace doppel
