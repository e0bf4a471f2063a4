#include "film/parts.hpp"

#include "base/embedded.hpp"
#include "base/error.hpp"
#include "film/film.hpp"
#include "output/blocks.hpp"
#include "output/written.hpp"
#include "scene/resolved.hpp"

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

/// Reads the header of a part. Throws if it does not belong to the film.
Shard shard_in(const BlockFile& part, const fs::path& path, const Scene& scene) {
    const auto header = Json::parse(part.header(), nullptr, false);
    const auto shard = shard_of(header);
    if (!shard) throw part.damaged();
    check_identity(path, header, identity(scene), *shard, "render");
    return *shard;
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
        throw bad_input("--shard {}/{}: {} can have {} part{} at most", shard.number, shard.of, scene.preset.name,
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
