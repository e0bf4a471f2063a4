#pragma once

#include "output/folder.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace doppel {

/// A file of Doppel's as a manifest has it.
struct WrittenFile {
    std::uintmax_t bytes = 0;
    std::string sha256;
};

/// What Doppel wrote in a folder, by its own manifests there, which are no files of theirs: name, or
/// "frames/000000.png".
using WrittenFiles = std::map<std::string, WrittenFile>;
WrittenFiles written_files(const Folder& folder);

/// What a PNG in the folder says made it, its "Software": nothing where it says none, or is no PNG.
std::string maker_of_picture(const Folder& folder, const std::string& name);

/// Whether Doppel made the regular file `name` there: a manifest names it ("frames/" + name where `within` =
/// "frames/"), or it says so itself (a PNG of Doppel's, a manifest, the table of a film, the trials of a figure).
bool is_written(const Folder& folder, const std::string& name, const WrittenFiles& written,
                const std::string& within = {});

/// SHA-256 of a file's bytes, 64 lower-case hexadecimal digits. Throws Error (exit 4) where it cannot be read.
std::string sha256_of_file(const FilePlace& place);
/// The same of a text.
std::string sha256_of_text(std::string_view text);

}  // namespace doppel
