#include "output/written.hpp"

#include "base/error.hpp"
#include "output/libav_encoder.hpp"

extern "C" {
#include <libavutil/mem.h>
#include <libavutil/sha.h>
}

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <utility>

namespace doppel {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// SHA-256, by libavutil, of the blocks that next() returns, up to the first empty one.
template <class Next>
std::string sha256_of(const Next& next) {
    const Owned<AVSHA, av_free> sha(checked(av_sha_alloc()));
    av_sha_init(sha.get(), 256);
    for (std::string_view block = next(); !block.empty(); block = next())
        av_sha_update(sha.get(), reinterpret_cast<const std::uint8_t*>(block.data()), block.size());
    std::string digest(32, '\0');
    av_sha_final(sha.get(), reinterpret_cast<std::uint8_t*>(digest.data()));
    return digest;
}

std::string hexadecimal(const std::string& digest) {
    const std::vector<std::uint8_t> bytes(digest.begin(), digest.end());
    return fmt::format("{:02x}", fmt::join(bytes, ""));
}

/// The contents of a manifest of Doppel; null if the file is none.
Json manifest_of(const fs::path& path) {
    constexpr std::size_t max_bytes = 64 << 20;  // enough for some 400 000 frames
    if (path.extension() != ".json" || type_of(path) != fs::file_type::regular) return nullptr;
    const auto bytes = fs::file_size(path);
    if (bytes > max_bytes) return nullptr;
    auto json = Json::parse(start_of_file(path, bytes), nullptr, false);
    const auto has = [&](const char* key) { return json.is_object() && json.contains(key) && json[key].is_object(); };
    return has("doppel") && has("files") ? json : nullptr;
}

std::string kind_of_manifest(const Json& manifest) {
    if (manifest.contains("certificate") && !manifest.contains("frames")) return "certificate";
    if (manifest.contains("tiles")) return "map of tiles";
    return manifest.contains("models") ? "fit" : manifest.contains("figure") ? "figure" : "film";
}

void add_files(WrittenFiles& written, const Json& files, const std::string& kind) {
    for (const auto& [name, about] : files.items())
        if (about.is_object())
            written.emplace(name,
                            WrittenFile{about.value("bytes", std::uintmax_t{0}), about.value("sha256", ""), kind});
}

/// The last bytes of a file, at most `bytes`.
std::string end_of_file(const fs::path& path, std::size_t bytes) {
    const Stream file = open_file(path);
    std::string end(std::min<std::uintmax_t>(bytes, fs::file_size(path)), '\0');
    std::fseek(file.get(), -static_cast<long>(end.size()), SEEK_END);
    end.resize(std::fread(end.data(), 1, end.size(), file.get()));
    return end;
}

/// The comment in the metadata of a film in a container that libav calls `format`; empty if there is none.
std::string comment_of_film(const fs::path& path, const char* format) {
    capture_libav_log();
    AVFormatContext* input = nullptr;
    if (avformat_open_input(&input, ("file:" + path.string()).c_str(), av_find_input_format(format), nullptr) < 0)
        return {};
    const auto* entry = av_dict_get(input->metadata, "comment", nullptr, 0);
    std::string comment = entry ? entry->value : "";
    avformat_close_input(&input);
    return comment;
}

}  // namespace

WrittenFiles written_files(const fs::path& folder) {
    WrittenFiles written, before;
    for (const auto& name : names_in(folder)) {
        const auto manifest = manifest_of(folder / name);
        if (manifest.is_null()) continue;
        try {
            add_files(written, manifest["files"], kind_of_manifest(manifest));
            add_files(before, manifest.value("earlier_files", Json::object()), {});
        } catch (const Json::exception&) {
            // not as Doppel wrote it: ignored from here on
        }
    }
    written.insert(before.begin(), before.end());  // after those of the same name
    return written;
}

Origin origin_of(const fs::path& folder, const std::string& name, const WrittenFiles& written) {
    const auto path = folder / name;
    if (const auto manifest = manifest_of(path); !manifest.is_null())
        return {.is_ours = true, .kind = kind_of_manifest(manifest)};
    const auto [first, last] = written.equal_range(name);
    if (first == last) return {.is_ours = made_by(path)};
    const auto current = std::find_if(first, last, [&](const auto& entry) {
        const WrittenFile& file = entry.second;
        return file.sha256.empty() || (file.bytes == fs::file_size(path) && file.sha256 == sha256_of_file(path));
    });
    const bool is_changed = current == last;
    return {.is_ours = true, .is_changed = is_changed, .kind = (is_changed ? first : current)->second.kind};
}

bool made_by(const fs::path& path, std::string_view program) {
    if (type_of(path) != fs::file_type::regular) return false;
    const auto head = start_of_file(path, std::size_t{1} << 12);
    if (head.starts_with("\x89PNG\r\n\x1a\n"))
        return head.find(fmt::format("tEXtSoftware{}{}", '\0', program)) != std::string::npos;
    if (head.starts_with("%PDF-"))
        return end_of_file(path, 128).find(fmt::format("%%EOF\n% {}", program)) != std::string::npos;
    if (head.starts_with("GIF89a"))
        return comment_of_film(path, "gif").find(fmt::format("encoder: {} ", program)) != std::string::npos;
    const bool is_mp4 = head.find("ftyp") == 4, is_webm = head.starts_with("\x1a\x45\xdf\xa3");
    if (is_mp4 || is_webm)
        return comment_of_film(path, is_mp4 ? "mov" : "matroska").starts_with(fmt::format("{} ", program));
    const auto begins = [&](std::string_view start) {
        return head.starts_with(fmt::format("{}<!-- {} ", start, program));
    };
    return begins("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n") || begins("<!DOCTYPE html>\n") ||
           head.starts_with(R"({"file":"doppel )");  // a part of a figure or film, or a recording
}

std::string sha256_of_file(const fs::path& path) {
    const Stream file = open_file(path);
    std::array<char, std::size_t{1} << 16> block;
    const auto sum = sha256_of(
        [&] { return std::string_view(block.data(), std::fread(block.data(), 1, block.size(), file.get())); });
    if (std::ferror(file.get())) throw cannot(path, "read");
    return hexadecimal(sum);
}

std::string sha256_digest(std::string_view text) {
    return sha256_of([&] { return std::exchange(text, {}); });
}

std::string sha256_of_text(std::string_view text) {
    return hexadecimal(sha256_digest(text));
}

}  // namespace doppel
