#include "film/recording_file.hpp"

#include "base/embedded.hpp"
#include "base/error.hpp"
#include "output/written.hpp"
#include "scene/resolved.hpp"

#include <utility>

namespace doppel {
namespace {

/// The keys on which the snapshots depend: all except those of the picture.
std::string key_of(const Scene& scene) {
    auto preset = scene.preset;
    const auto video = std::exchange(preset.video, {});
    preset.video.layout = video.layout;
    preset.video.members = video.members;
    preset.video.fps = video.fps;
    preset.video.speed = video.speed;
    preset.video.speed_ease_s = video.speed_ease_s;
    return sha256_of_text(resolved_toml(preset));
}

std::string header_of(const Scene& scene) {
    return fmt::format(R"({},"preset":{},"version":"{}","revision":"{}","motion_sha256":"{}"}})", recording_file.start,
                       Json(scene.preset.name).dump(), version(), revision(), key_of(scene));
}

/// Writes or reads all numbers.
void pass_all(BlockFile& all, Snapshot& snapshot, MotionRecord& record) {
    auto& pair = snapshot.pair;
    all(pair.sample, pair.share, pair.distance, record.a.effort, record.b.effort, snapshot.members);
    all(pair.energy_error_a, pair.energy_error_b, pair.mean_energy_a, pair.mean_energy_b);
    for (auto* seen : {&pair.a, &pair.b}) {
        all(seen->bobs, seen->exact, seen->pivot, seen->tension, seen->energy, seen->kinetic_energy);
        all(seen->work, seen->energy_change, seen->length_error);
    }
}

}  // namespace

RecordingWriter::RecordingWriter(const std::filesystem::path& path, const Scene& scene)
    : BlockFile(path, header_of(scene)) {}

void RecordingWriter::add(Snapshot snapshot, MotionRecord record) {
    pass_all(*this, snapshot, record);
    end_block();
}

RecordingReader::RecordingReader(const std::filesystem::path& path, const Scene& scene)
    : BlockFile(path, recording_file) {
    if (header() != header_of(scene))
        throw bad_input(
            "{} is a recording of another motion, frame rate or version of Doppel; make it again: doppel simulate {} "
            "--recording {}",
            path.string(), scene.preset.name, path.string());
}

Snapshot RecordingReader::at(const Moment& moment, MotionRecord& record) {
    Snapshot snapshot;
    while (next()) {
        pass_all(*this, snapshot, record);
        if (snapshot.pair.moment() == moment) return snapshot;
        if (moment < snapshot.pair.moment()) break;
    }
    throw damaged();
}

}  // namespace doppel
