#include "output/written.hpp"

#include "base/error.hpp"

extern "C" {
#include <libavutil/mem.h>
#include <libavutil/sha.h>
}

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <new>
#include <string_view>

namespace doppel {
namespace {

using Json = nlohmann::json;

/// SHA-256, by libavutil.
class Hash {
public:
    Hash() : sha_(av_sha_alloc()) {
        if (!sha_) throw std::bad_alloc();
        av_sha_init(sha_.get(), 256);
    }

    void add(const void* bytes, std::size_t count) {
        av_sha_update(sha_.get(), static_cast<const std::uint8_t*>(bytes), count);
    }

    std::string digits() {
        std::array<std::uint8_t, 32> digest;
        av_sha_final(sha_.get(), digest.data());
        return fmt::format("{:02x}", fmt::join(digest, ""));
    }

private:
    Owned<AVSHA, av_free> sha_;
};

/// The bytes of a file from `begin` on, at most `most`; none where it cannot be read.
std::string bytes_of(const Folder& folder, const std::string& name, std::size_t most, std::size_t begin = 0) {
    try {
        const FilePlace place{folder, name};
        const Stream file = stream_of(open_file(place), "rb", place.path, "read");
        if (std::fseek(file.get(), static_cast<long>(begin), SEEK_SET) != 0) return {};
        std::string bytes(std::min<std::size_t>(most, folder.entry(name).bytes), '\0');
        bytes.resize(std::fread(bytes.data(), 1, bytes.size(), file.get()));
        return bytes;
    } catch (const Error&) {
        return {};
    }
}

/// A manifest of Doppel's; null where the file is none.
Json manifest_of(const Folder& folder, const std::string& name) {
    constexpr std::size_t most_bytes = 64 << 20;  // some 400 000 frames
    if (!name.ends_with(".json") || folder.entry(name).kind != Entry::Kind::file) return nullptr;
    if (folder.entry(name).bytes > most_bytes) return nullptr;
    auto json = Json::parse(bytes_of(folder, name, most_bytes), nullptr, false);
    const auto has = [&](const char* key) { return json.is_object() && json.contains(key) && json[key].is_object(); };
    if (!has("doppel") || !has("files")) return nullptr;
    return json;
}

/// Of the run that wrote the manifest.
std::string kind_of_manifest(const Json& manifest) {
    return manifest.contains("ladder") ? "fit" : manifest.contains("figure") ? "figure" : "film";
}

void add_files(WrittenFiles& written, const Json& files, const std::string& kind) {
    for (const auto& [name, about] : files.items())
        if (about.is_object())
            written.emplace(name,
                            WrittenFile{about.value("bytes", std::uintmax_t{0}), about.value("sha256", ""), kind});
}

}  // namespace

WrittenFiles written_files(const Folder& folder) {
    WrittenFiles written, before;
    for (const auto& name : folder.names()) {
        const auto manifest = manifest_of(folder, name);
        if (manifest.is_null()) continue;
        try {
            add_files(written, manifest["files"], kind_of_manifest(manifest));
            if (const auto earlier = manifest.find("earlier_files"); earlier != manifest.end())
                add_files(before, *earlier, {});
        } catch (const Json::exception&) {
            // not as Doppel wrote it: the rest is ignored
        }
    }
    written.insert(before.begin(), before.end());  // behind those of the same name
    return written;
}

std::string maker_of_picture(const Folder& folder, const std::string& name) {
    constexpr std::string_view png = "\x89PNG\r\n\x1a\n", key{"tEXtSoftware\0", 13};
    const auto head = bytes_of(folder, name, 4096);
    const auto at = head.find(key);
    if (!head.starts_with(png) || at == std::string::npos || at < 4) return {};
    // the chunk's length, big-endian, is before its type
    std::size_t length = 0;
    for (std::size_t i = at - 4; i < at; ++i) length = length << 8 | static_cast<unsigned char>(head[i]);
    const auto start = at + key.size(), end = at + 4 + length;
    return end >= start && end <= head.size() ? head.substr(start, end - start) : std::string();
}

bool begins_with(const Folder& folder, const std::string& name, std::string_view start) {
    return bytes_of(folder, name, start.size()) == start;
}

bool is_written(const Folder& folder, const std::string& name, const WrittenFiles& written, const std::string& within) {
    if (written.contains(within + name)) return true;
    if (name.ends_with(".json")) return !manifest_of(folder, name).is_null();
    if (maker_of_picture(folder, name).starts_with("Doppel")) return true;
    const auto head = bytes_of(folder, name, 64);
    for (const std::string_view start : {"<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n", "<!DOCTYPE html>\n"})
        if (head.starts_with(start) && std::string_view(head).substr(start.size()).starts_with("<!-- Doppel "))
            return true;
    if (head.starts_with("%PDF-")) {
        const std::size_t bytes = folder.entry(name).bytes, most = pdf_mark.size() + 64;
        return bytes_of(folder, name, most, bytes - std::min(bytes, most)).find(pdf_mark) != std::string::npos;
    }
    return head.starts_with(R"({"file":"doppel trials")");
}

bool is_changed(const Folder& folder, const std::string& name, const WrittenFiles& written, const std::string& within) {
    const auto [first, last] = written.equal_range(within + name);
    std::string found;
    for (auto record = first; record != last; ++record) {
        const auto& [bytes, sha256, kind] = record->second;
        if (sha256.empty()) return false;
        if (bytes != folder.entry(name).bytes) continue;
        if (found.empty()) found = sha256_of_file({folder, name});
        if (found == sha256) return false;
    }
    return first != last;
}

std::string kind_of_file(const Folder& folder, const std::string& name, const WrittenFiles& written) {
    if (const auto manifest = manifest_of(folder, name); !manifest.is_null()) return kind_of_manifest(manifest);
    const auto record = written.find(name);  // the first
    return record == written.end() ? "" : record->second.kind;
}

std::string sha256_of_file(const FilePlace& place) {
    const Stream file = stream_of(open_file(place), "rb", place.path, "read");
    Hash hash;
    std::array<std::uint8_t, std::size_t{1} << 16> block;
    while (const std::size_t n = std::fread(block.data(), 1, block.size(), file.get())) hash.add(block.data(), n);
    if (std::ferror(file.get())) throw cannot(place.path, "read");
    return hash.digits();
}

std::string sha256_of_text(std::string_view text) {
    Hash hash;
    hash.add(text.data(), text.size());
    return hash.digits();
}

}  // namespace doppel
