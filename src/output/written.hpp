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
};

/// The files that the manifests in a folder list, by name ("frames/000000.png"); manifests do not list themselves.
using WrittenFiles = std::map<std::string, WrittenFile>;
WrittenFiles written_files(const Folder& folder);

/// The "Software" of a PNG in the folder; empty where it has none, or is no PNG.
std::string maker_of_picture(const Folder& folder, const std::string& name);

/// What follows the end of a PDF of Doppel's, a comment: the program that made it.
inline constexpr std::string_view pdf_mark = "%%EOF\n% Doppel";

/// Whether Doppel made the regular file `name` there: a manifest lists it (as `within` + name), or its contents show it
/// (a PNG of Doppel's, a manifest, the table of a film, the trials of a figure, a report or an SVG with a first comment
/// "<!-- Doppel …", a PDF with a last one).
bool is_written(const Folder& folder, const std::string& name, const WrittenFiles& written,
                const std::string& within = {});

/// SHA-256 of a file's bytes, 64 lower-case hexadecimal digits. Throws Error (exit 4) where it cannot be read.
std::string sha256_of_file(const FilePlace& place);
/// The same of a text.
std::string sha256_of_text(std::string_view text);

}  // namespace doppel
