#pragma once

#include "output/files.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace doppel {

/// A file that a manifest of Doppel's lists.
struct WrittenFile {
    std::uintmax_t bytes = 0;
    std::string sha256;
    std::string kind = {};  // of the run whose manifest lists the file: "film", "figure", "map of tiles", …
};

/// The files that the manifests in a folder list, by name ("frames/000000.png"), without the manifests. If several
/// manifests list a file, the entry of the run that made it comes first.
using WrittenFiles = std::multimap<std::string, WrittenFile>;
WrittenFiles written_files(const std::filesystem::path& folder);

/// Who made a regular file.
struct Origin {
    bool is_ours = false;     // a manifest lists it, made_by() recognises it, or it is a manifest
    bool is_changed = false;  // manifests list it with SHA-256 sums, and none matches
    std::string kind = {};    // the kind of run that made it; empty if unknown
};
/// The origin of "x.csv" or "frames/000000.png" in the folder whose manifests list `written`.
Origin origin_of(const std::filesystem::path& folder, const std::string& name, const WrittenFiles& written);

/// Whether `program` made the file. This is stated in the "Software" of a PNG, in the comment of an MP4, WebM or GIF, in
/// the first comment of an SVG, HTML or XML page, and in the last one of a PDF. Files with results of a figure count,
/// too.
bool made_by(const std::filesystem::path& path, std::string_view program = "Doppel");

/// SHA-256 of a file, 64 lower-case hexadecimal digits. Throws Error (exit 4) if it cannot be read.
std::string sha256_of_file(const std::filesystem::path& path);
/// SHA-256 of a text.
std::string sha256_of_text(std::string_view text);
/// Its 32 bytes.
std::string sha256_digest(std::string_view text);

}  // namespace doppel
