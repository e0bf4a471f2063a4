#include "film/parts.hpp"

#include "base/embedded.hpp"
#include "base/error.hpp"
#include "film/film.hpp"
#include "output/film_part.hpp"
#include "output/written.hpp"
#include "scene/resolved.hpp"

#include <algorithm>
#include <optional>
#include <set>

namespace doppel {
namespace {

namespace fs = std::filesystem;

/// What a part must agree on with the film.
Json identity(const Scene& scene) {
    return {{"film", scene.preset.name},
            {"version", version()},
            {"revision", revision()},
            {"preset_sha256", sha256_of_text(resolved_toml(scene.preset))},
            {"libav", libav_description()}};
}

/// Throws if the part belongs to something else.
void check_identity(const fs::path& path, const Json& header, const Json& wanted) {
    for (const auto& [key, ours] : wanted.items())
        if (const auto theirs = header.value(key, Json()); theirs != ours)
            throw bad_input("{} was made with another {}: {}, not {}; render it again with --shard {}/{}",
                            path.string(), key == "preset_sha256" ? "preset, or other --set" : key,
                            theirs.dump().substr(0, 40), ours.dump().substr(0, 40), header.value("shard", 0),
                            header.value("of", 0));
}

Json header_of(const fs::path& path) {
    auto header = Json::parse(FilmPartReader(path).header(), nullptr, false);
    const auto number = [&](const char* key) { return header.is_object() ? header.value(key, Json()) : Json(); };
    const auto shard = number("shard"), of = number("of");
    if (!shard.is_number_integer() || !of.is_number_integer() || shard < 1 || of < shard)
        throw io_failed("{} is damaged; remove it", path.string());
    return header;
}

}  // namespace

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
        throw bad_input("--shard {}/{}: {} has {} segments; give at most {} parts", shard.number, shard.of,
                        scene.preset.name, segments, segments);
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
        check_identity(path, header_of(path), identity(scene));
        FilmPartReader part(path);
        while (part.next()) continue;
        return true;
    } catch (const Error&) {
        return false;  // made again
    }
}

FilmParts parts_in(const Scene& scene, const fs::path& folder) {
    const auto& name = scene.preset.name;
    FilmParts parts;
    std::set<std::string> libraries;
    const auto wanted = identity(scene);
    if (type_of(folder) != fs::file_type::directory) throw try_again("{} does not exist", folder.string());
    for (const auto& file : names_in(folder)) {
        if (!file.starts_with(name + ".") || !file.ends_with(".shard")) continue;
        const auto header = header_of(folder / file);
        check_identity(folder / file, header, wanted);
        const Shard shard{header["shard"], header["of"]};
        frames_of(scene, shard);
        if (parts.files.empty()) parts.files.resize(static_cast<std::size_t>(shard.of));
        if (file != part_name(scene, shard) || static_cast<std::size_t>(shard.of) != parts.files.size())
            throw bad_input("{} is part {} of {}, others are of {}; remove those that do not belong",
                            (folder / file).string(), shard.number, shard.of, parts.files.size());
        parts.files[static_cast<std::size_t>(shard.number) - 1] = folder / file;
        libraries.insert(header.value("gl", ""));
    }
    if (parts.files.empty())
        throw try_again("{} contains no part of {}; make them with the same command, --shard I/N in place of --merge",
                        folder.string(), name);
    std::vector<std::string> missing;
    for (std::size_t i = 0; i < parts.files.size(); ++i)
        if (parts.files[i].empty()) missing.push_back(fmt::format("{}/{}", i + 1, parts.files.size()));
    if (!missing.empty()) throw try_again("{}: missing parts: {}", folder.string(), fmt::join(missing, ", "));
    parts.gl = fmt::format("{}", fmt::join(libraries, "; "));
    return parts;
}

void join_pictures(const FilmParts& parts, const fs::path& folder, const std::atomic<bool>& stop) {
    for (const auto& path : parts.files) {
        FilmPartReader part(path);
        while (const auto picture = part.next()) {
            throw_if_set(stop);
            write_file(folder / fmt::format("{:06}.png", picture->pts), picture->bytes);
        }
    }
}

}  // namespace doppel
