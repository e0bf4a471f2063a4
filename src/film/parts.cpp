#include "film/parts.hpp"

#include "base/embedded.hpp"
#include "film/film.hpp"
#include "output/blocks.hpp"
#include "output/files.hpp"
#include "output/written.hpp"

#include <fmt/ranges.h>

namespace doppel {
namespace {

namespace fs = std::filesystem;

/// "2/8, 5/8": the missing parts, or the first ones.
std::string missing_parts(const std::vector<fs::path>& parts) {
    constexpr std::size_t max_named = 5;
    std::vector<std::string> missing;
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (parts[i].empty()) missing.push_back(fmt::format("{}/{}", i + 1, parts.size()));
    const auto count = missing.size();
    missing.resize(std::min(count, max_named));
    return fmt::format("{}{}", fmt::join(missing, ", "), count > max_named ? fmt::format(" … {} in all", count) : "");
}

Json identity(const Scene& scene) {
    return {{"film", scene.preset.name},
            {"version", version()},
            {"revision", revision()},
            {"preset_sha256", sha256_of_text(resolved_toml(scene.preset))},
            {"libav", libav_description()}};
}

Shard shard_in(const BlockFile& part, const fs::path& path, const Scene& scene) {
    const auto header = Json::parse(part.header(), nullptr, false);
    const auto shard = shard_of(header);
    if (!shard) throw part.damaged();
    check_identity(path, header, identity(scene), *shard, "render");
    return *shard;
}

}  // namespace

std::optional<Shard> shard_of(const Json& header) {
    const auto number = [&](const char* key) { return header.is_object() ? header.value(key, Json()) : Json(); };
    const auto shard = number("shard"), of = number("of");
    if (!shard.is_number_integer() || !of.is_number_integer() || shard < 1 || of < shard || of > max_parts)
        return std::nullopt;
    return Shard{shard, of};
}

void check_identity(const fs::path& path, const Json& header, const Json& wanted, const Shard& shard,
                    std::string_view verb) {
    constexpr std::size_t hash_digits = 12;
    for (const auto& [key, ours] : wanted.items()) {
        const auto theirs = header.value(key, Json());
        if (theirs == ours) continue;
        const bool is_hash = key == "preset_sha256";
        const auto text = [&](const Json& value) {
            const auto words = value.is_string() ? value.get<std::string>() : value.dump();
            return words.substr(0, is_hash ? hash_digits : words.size());
        };
        throw bad_input("{} was made with another {}: {}, not {}; {} it again with --shard {}/{}", path.string(),
                        is_hash ? "preset, --set, --size or --format" : key, text(theirs), text(ours), verb,
                        shard.number, shard.of);
    }
}

std::vector<fs::path> all_parts(const fs::path& folder, const std::string& name,
                                const std::function<Shard(const fs::path&)>& take) {
    std::vector<fs::path> parts;  // by number; empty if not seen yet
    fs::path first;
    if (type_of(folder) == fs::file_type::directory)
        for (const auto& file : names_in(folder)) {
            if (!file.starts_with(name + ".") || !file.ends_with(".shard")) continue;
            const auto path = folder / file;
            const auto shard = take(path);
            const auto of = static_cast<std::size_t>(shard.of);
            if (parts.empty()) first = path, parts.resize(of);
            if (of != parts.size())
                throw bad_input("{} is one of {} shards and {} one of {}; remove those that do not belong",
                                path.string(), of, first.string(), parts.size());
            auto& seen = parts[static_cast<std::size_t>(shard.number) - 1];
            if (!seen.empty())
                throw bad_input("{} and {} are both shard {}/{}; remove one of them", seen.string(), path.string(),
                                shard.number, of);
            seen = path;
        }
    if (parts.empty())
        throw try_again("{} contains no shard of {}; make them with the same command, --shard I/N in place of --merge",
                        folder.string(), name);
    if (const auto missing = missing_parts(parts); !missing.empty())
        throw try_again("{}: missing shards: {}", folder.string(), missing);
    return parts;
}

long max_shards(const Scene& scene) {
    return scene.preset.video.format_row().has_parts() ? video_options(scene).segments() : 1;
}

FrameRange frames_of(const Scene& scene, const Shard& shard) {
    const auto& row = scene.preset.video.format_row();
    if (!row.has_parts())
        throw bad_input("--shard: a film in the format {} cannot be joined from parts; use mp4, webm or png",
                        row.title);
    const auto video = video_options(scene);
    const long segments = video.segments();
    if (shard.of > segments)
        throw bad_input("--shard {}/{}: {} can have {} shard{} at most", shard.number, shard.of, scene.preset.name,
                        segments, segments == 1 ? "" : "s");
    const auto start = [&](long number) {
        return number == shard.of ? video.frames : segments * number / shard.of * video.segment();
    };
    return {start(shard.number - 1), start(shard.number)};
}

std::string part_name(const Scene& scene, const Shard& shard) {
    return fmt::format("{}.{}-of-{}.shard", scene.preset.name, shard.number, shard.of);
}

std::string part_header(const Scene& scene, const Shard& shard, const std::string& gl) {
    Json header{{"file", "doppel film shard"}, {"shard", shard.number}, {"of", shard.of}, {"gl", gl}};
    header.update(identity(scene));
    return header.dump();
}

bool is_part_complete(const Scene& scene, const Shard& shard, const fs::path& folder) {
    const auto path = folder / part_name(scene, shard);
    if (type_of(path) != fs::file_type::regular) return false;
    try {
        BlockFile part(path, film_part);
        shard_in(part, path, scene);
        while (part.next()) continue;
        return true;
    } catch (const Error&) {
        return false;  // made again
    }
}

std::vector<fs::path> parts_in(const Scene& scene, const fs::path& folder) {
    return all_parts(folder, scene.preset.name, [&](const fs::path& path) {
        const auto shard = shard_in(BlockFile(path, film_part), path, scene);
        frames_of(scene, shard);
        return shard;
    });
}

}  // namespace doppel
