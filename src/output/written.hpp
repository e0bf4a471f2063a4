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
    std::string kind = {};  // of the run whose manifest lists it as its own: "film", "figure", "fit"
};

/// The files that the manifests in a folder list, by name ("frames/000000.png"); manifests do not list themselves. Where
/// several list one, what a run's own manifest says comes first.
using WrittenFiles = std::multimap<std::string, WrittenFile>;
WrittenFiles written_files(const std::filesystem::path& folder);

/// Who made a regular file.
struct Origin {
    bool is_ours = false;     // a manifest lists it, its contents show it (see made_by()), or it is a manifest
    bool is_changed = false;  // manifests list it with a SHA-256, and it has none of these
    std::string kind = {};    // of the run that it is of; empty where that is not known
};
/// Of "x.csv" or "frames/000000.png" in the folder whose manifests list `written`.
Origin origin_of(const std::filesystem::path& folder, const std::string& name, const WrittenFiles& written);

/// Whether the contents are by this program: a PNG whose "Software" begins so, an SVG, an HTML or XML page with a first
/// comment "<!-- Doppel …", a PDF with a last one, or the trials of a figure.
bool made_by(const std::filesystem::path& path, std::string_view program = "Doppel");

/// SHA-256 of a file's bytes, 64 lower-case hexadecimal digits. Throws Error (exit 4) where it cannot be read.
std::string sha256_of_file(const std::filesystem::path& path);
/// The same of a text.
std::string sha256_of_text(std::string_view text);

}  // namespace doppel
