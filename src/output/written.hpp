#pragma once

#include "output/folder.hpp"

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
WrittenFiles written_files(const Folder& folder);

/// The "Software" of a PNG in the folder; empty where it has none, or is no PNG.
std::string maker_of_picture(const Folder& folder, const std::string& name);

/// Whether a file there begins with these bytes.
bool begins_with(const Folder& folder, const std::string& name, std::string_view start);

/// What follows the end of a PDF of Doppel's, a comment: the program that made it.
inline constexpr std::string_view pdf_mark = "%%EOF\n% Doppel";

/// Whether Doppel made the regular file `name` there: a manifest lists it (as `within` + name), or its contents show it
/// (a PNG of Doppel's, a manifest, the trials of a figure, a report or an SVG with a first comment "<!-- Doppel …", a PDF
/// with a last one).
bool is_written(const Folder& folder, const std::string& name, const WrittenFiles& written,
                const std::string& within = {});
/// Whether manifests list it with a SHA-256, and it has none of these: somebody changed or replaced it.
bool is_changed(const Folder& folder, const std::string& name, const WrittenFiles& written,
                const std::string& within = {});
/// The kind of run that it is of; empty where that is not known.
std::string kind_of_file(const Folder& folder, const std::string& name, const WrittenFiles& written);

/// SHA-256 of a file's bytes, 64 lower-case hexadecimal digits. Throws Error (exit 4) where it cannot be read.
std::string sha256_of_file(const FilePlace& place);
/// The same of a text.
std::string sha256_of_text(std::string_view text);

}  // namespace doppel
