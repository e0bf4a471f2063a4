#include "film/recording_file.hpp"

#include "base/embedded.hpp"
#include "base/error.hpp"
#include "output/film_part.hpp"
#include "output/written.hpp"
#include "scene/resolved.hpp"

#include <cstring>
#include <stdexcept>
#include <type_traits>

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
    return fmt::format(R"({},"preset":{},"version":"{}","revision":"{}","motion_sha256":"{}"}})", recording_start,
                       Json(scene.preset.name).dump(), version(), revision(), key_of(scene));
}

/// Appends numbers to bytes.
struct Pack {
    std::string bytes{};

    template <class T>
    void operator()(const T& value) {
        static_assert(std::is_trivially_destructible_v<T>);
        bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
    }
    template <class T>
    void operator()(std::vector<T>& values) {
        (*this)(values.size());
        for (auto& value : values) (*this)(value);
    }
};

/// Takes them from bytes. Throws std::out_of_range at their end.
struct Unpack {
    std::string_view bytes;

    template <class T>
    void operator()(T& value) {
        static_assert(std::is_trivially_destructible_v<T>);
        if (bytes.size() < sizeof(T)) throw std::out_of_range("recording");
        std::memcpy(static_cast<void*>(&value), bytes.data(), sizeof(T));
        bytes.remove_prefix(sizeof(T));
    }
    template <class T>
    void operator()(std::vector<T>& values) {
        std::size_t size = 0;
        (*this)(size);
        if (size > bytes.size()) throw std::out_of_range("recording");
        values.resize(size);
        for (auto& value : values) (*this)(value);
    }
};

/// Calls archive(number) for all numbers, in the same order for writing and reading.
template <class Archive>
void archive_all(Archive& archive, Snapshot& snapshot, MotionRecord& record) {
    auto& pair = snapshot.pair;
    const auto all = [&](auto&... numbers) { (archive(numbers), ...); };
    all(pair.sample, pair.share, pair.distance, record.a.effort, record.b.effort, snapshot.members);
    all(pair.energy_error_a, pair.energy_error_b, pair.mean_energy_a, pair.mean_energy_b);
    for (auto* seen : {&pair.a, &pair.b}) {
        all(seen->bobs, seen->exact, seen->pivot, seen->tension, seen->energy, seen->kinetic_energy);
        all(seen->work, seen->energy_change, seen->length_error);
    }
}

struct BlockHead {
    std::uint64_t bytes, checksum;
};

}  // namespace

RecordingWriter::RecordingWriter(const std::filesystem::path& path, const Scene& scene) : file_(path) {
    file_.write(header_of(scene) + "\n");
}

void RecordingWriter::add(Snapshot snapshot, const MotionRecord& record) {
    Pack pack;
    auto effort = record;
    archive_all(pack, snapshot, effort);
    Pack head;
    head(BlockHead{pack.bytes.size(), checksum(pack.bytes)});
    file_.write(head.bytes + pack.bytes);
}

RecordingReader::RecordingReader(std::filesystem::path path, const Scene& scene)
    : path_(std::move(path)), file_(open_file(path_)) {
    const auto wanted = header_of(scene);
    std::string header;
    for (int c = 0; header.size() <= wanted.size() + 4096 && (c = getc_unlocked(file_.get())) != EOF && c != '\n';)
        header += static_cast<char>(c);
    if (!header.starts_with(recording_start)) throw io_failed("{} is no recording of Doppel", path_.string());
    if (header != wanted)
        throw bad_input(
            "{} is a recording of another motion, frame rate or version of Doppel; make it again: doppel simulate {} "
            "--recording {}",
            path_.string(), scene.preset.name, path_.string());
}

/// The next `size` bytes. Throws std::out_of_range at the end of the file.
std::string RecordingReader::bytes(std::uint64_t size) {
    constexpr std::uint64_t most_bytes = std::uint64_t{1} << 32;
    if (size > most_bytes) throw std::out_of_range("recording");
    std::string bytes(size, '\0');
    if (std::fread(bytes.data(), 1, size, file_.get()) != size) throw std::out_of_range("recording");
    return bytes;
}

Snapshot RecordingReader::at(const Moment& moment, MotionRecord& record) {
    Snapshot snapshot;
    try {
        do {
            BlockHead head{};
            const auto start = bytes(sizeof(head));
            Unpack{start}(head);
            const auto numbers = bytes(head.bytes);
            if (checksum(numbers) != head.checksum) throw std::out_of_range("recording");
            Unpack unpack{numbers};
            archive_all(unpack, snapshot, record);
        } while (snapshot.pair.moment() < moment);
        if (snapshot.pair.moment() == moment) return snapshot;
    } catch (const std::out_of_range&) {
    }
    throw io_failed("{} is damaged or incomplete; make it again with simulate --recording", path_.string());
}

}  // namespace doppel
