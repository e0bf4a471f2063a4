#pragma once

#include "film/recording.hpp"
#include "output/files.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace doppel {

/// The first characters of a recording's file.
inline constexpr std::string_view recording_start = R"({"file":"doppel recording")";

/// Writes the snapshots of a scene to a file: a line of JSON, then the numbers of each with a checksum. Throws Error
/// (exit 4).
class RecordingWriter {
public:
    RecordingWriter(const std::filesystem::path& path, const Scene& scene);
    /// `record` = the effort up to this snapshot.
    void add(Snapshot snapshot, const MotionRecord& record);
    void finish() { file_.close(); }

private:
    OutputFile file_;
};

/// Reads such a file. Throws Error: exit 2 if it belongs to another motion or version, exit 4 if it cannot be read or
/// is damaged.
class RecordingReader {
public:
    RecordingReader(std::filesystem::path path, const Scene& scene);
    /// The snapshot of this moment; earlier ones are left out. Sets the effort in `record`.
    Snapshot at(const Moment& moment, MotionRecord& record);

private:
    std::string bytes(std::uint64_t size);

    std::filesystem::path path_;
    Stream file_;
};

}  // namespace doppel
