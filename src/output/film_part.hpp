#pragma once

#include "output/files.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace doppel {

/// An encoded packet of a video, or the file of one picture.
struct FilmPacket {
    std::int64_t pts = 0, dts = 0;  // frames since the start of the film
    int flags = 0;                  // libav's
    std::string bytes;
    std::vector<std::pair<int, std::string>> side_data = {};  // libav's type, bytes
};

/// The first characters of a part's header. The header is one line of JSON.
inline constexpr std::string_view film_part_start = R"({"file":"doppel film shard")";

/// CRC-32 of the bytes that follow those with the checksum `before`.
std::uint32_t checksum(std::string_view bytes, std::uint32_t before = 0);

/// Writes a part of a film for a merge: the header, then the packets with checksums, then a line that marks the end.
/// Throws Error (exit 4).
class FilmPartWriter {
public:
    FilmPartWriter(const std::filesystem::path& path, const std::string& header);
    void add(const FilmPacket& packet);
    void finish();

private:
    OutputFile file_;
};

/// Reads such a file. Throws Error (exit 4) if it cannot be read, is damaged, or is something else.
class FilmPartReader {
public:
    explicit FilmPartReader(std::filesystem::path path);
    /// Without the end of the line.
    const std::string& header() const { return header_; }
    /// The next packet; nothing after the last one.
    std::optional<FilmPacket> next();

private:
    std::string line();
    std::string bytes(std::size_t size);
    Error damaged(std::string_view why) const;

    std::filesystem::path path_;
    Stream file_;
    std::string header_;
};

}  // namespace doppel
