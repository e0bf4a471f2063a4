#include "output/film_part.hpp"

#include "base/error.hpp"

#include <libdeflate.h>
#include <nlohmann/json.hpp>

#include <array>

namespace doppel {
namespace {

using Json = nlohmann::json;

constexpr std::string_view end_line = "end";
constexpr std::size_t longest_line = 1 << 16, most_bytes = std::size_t{1} << 31;

std::uint32_t checksum_of(const FilmPacket& packet) {
    auto sum = checksum(packet.bytes);
    for (const auto& [type, bytes] : packet.side_data) sum = checksum(bytes, sum);
    return sum;
}

}  // namespace

std::uint32_t checksum(std::string_view bytes, std::uint32_t before) {
    return libdeflate_crc32(before, bytes.data(), bytes.size());
}

FilmPartWriter::FilmPartWriter(const std::filesystem::path& path, const std::string& header) : file_(path) {
    file_.write(header + "\n");
}

/// A line of JSON: [pts, dts, flags, checksum, bytes, [[type, bytes], …]]. The bytes follow.
void FilmPartWriter::add(const FilmPacket& packet) {
    auto sides = Json::array();
    for (const auto& [type, bytes] : packet.side_data) sides.push_back({type, bytes.size()});
    const Json line{packet.pts, packet.dts, packet.flags, checksum_of(packet), packet.bytes.size(), sides};
    file_.write(line.dump() + "\n" + packet.bytes);
    for (const auto& [type, bytes] : packet.side_data) file_.write(bytes);
}

void FilmPartWriter::finish() {
    file_.write(std::string(end_line) + "\n");
    file_.close();
}

FilmPartReader::FilmPartReader(std::filesystem::path path)
    : path_(std::move(path)), file_(open_file(path_)), header_(line()) {
    if (!header_.starts_with(film_part_start)) throw damaged("is no part of a film");
}

std::optional<FilmPacket> FilmPartReader::next() {
    const auto text = line();
    if (text == end_line) return std::nullopt;
    try {
        const auto json = Json::parse(text);
        FilmPacket packet{json.at(0), json.at(1), json.at(2), bytes(json.at(4))};
        for (const auto& side : json.at(5)) packet.side_data.emplace_back(side.at(0), bytes(side.at(1)));
        if (json.at(3) != checksum_of(packet)) throw damaged("is damaged");
        return packet;
    } catch (const Json::exception&) {
        throw damaged("is damaged or incomplete");
    }
}

std::string FilmPartReader::line() {
    std::string text;
    for (int c = 0; (c = getc_unlocked(file_.get())) != EOF && text.size() < longest_line;) {
        if (c == '\n') return text;
        text += static_cast<char>(c);
    }
    throw std::ferror(file_.get()) ? cannot(path_, "read") : damaged("is incomplete, or no part of a film");
}

std::string FilmPartReader::bytes(std::size_t size) {
    if (size > most_bytes) throw damaged("is damaged");
    std::string text;
    std::array<char, std::size_t{1} << 16> block{};
    while (text.size() < size) {
        const auto got = std::fread(block.data(), 1, std::min(block.size(), size - text.size()), file_.get());
        if (got == 0) throw std::ferror(file_.get()) ? cannot(path_, "read") : damaged("is incomplete");
        text.append(block.data(), got);
    }
    return text;
}

Error FilmPartReader::damaged(std::string_view why) const {
    return io_failed("{} {}; remove it, and render this part again", path_.string(), why);
}

}  // namespace doppel
