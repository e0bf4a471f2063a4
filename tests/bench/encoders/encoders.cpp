// The cost and quality of an encoder's settings (h264, vp9 or av1) on six films of pendulums: the table
// docs/encoders.csv, on standard output. Takes about 20 minutes; it measures CPU time, so run nothing else meanwhile.
//     encoders [CODEC]

#include "bench/encoders/encoder_quality.hpp"
#include "bench/encoders/encoder_settings.hpp"
#include "bench/encoders/encoding_trial.hpp"
#include "film/film.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace doppel {
namespace {

constexpr std::array qualities{15, 18, 21};  // crf; the middle one is the reference
constexpr double from_s = 5;
constexpr long count = 48;            // frames of each film
constexpr int repeats = 2;            // of each encoding, alternating with the others; the minimum CPU time counts
constexpr double key_interval_s = 5;  // between key frames: as in "doppel", and almost as in x264's presets

struct FilmToEncode {
    const char* name;
    Size size;
    const char* theme;
};
constexpr FilmToEncode films[]{{"butterfly", {1920, 1080}, "dark"}, {"butterfly", {3840, 2160}, "dark"},
                               {"fan", {1280, 720}, "dark"},        {"phase-dance", {1280, 720}, "dark"},
                               {"whip", {1280, 720}, "dark"},       {"two-methods", {1280, 720}, "light"}};

Scene scene_of(const FilmToEncode& film, const std::string& codec) {
    auto preset = read_preset(find_preset(film.name));
    preset.video.size = film.size;
    preset.video.fps = Rational{60, 1};
    preset.video.theme = film.theme;
    preset.video.format = codec == "h264" ? FilmFormat::mp4 : FilmFormat::webm;
    preset.video.codec = codec == "h264" ? "" : codec;
    return make_scene(preset);
}

RecordedFrames record(const Scene& scene) {
    const auto& frames = scene.frames;
    const long first = frames.first_from(moment_at(from_s * scene.preset.sample_hz.value()));
    const long end = first + count;
    Recording recording(scene, frames.at(end), true, never_stopped);
    Composer composer(scene, recording.bounds());
    Renderer renderer(scene.preset.video.size, composer.backdrop(), Gl::automatic, never_stopped,
                      scene.preset.video.typeface);
    RecordedFrames recorded{scene.preset.video.size, {}};
    long frame = 0;
    recording.play([&](const Snapshot& snapshot) {
        composer.add(snapshot);
        if (snapshot.pair.moment() != frames.at(frame) || frame++ < first) return;
        const auto& picture = renderer.draw(composer.frame(), never_stopped);
        convert(picture, renderer.changed(), AV_PIX_FMT_YUV420P, recorded.frames.emplace_back());
    });
    return recorded;
}

/// Bytes per frame of a long film: in the encoded part, only the first frame is a key frame.
double bytes_per_frame(const EncodingCost& cost, double fps) {
    const double whole = 1 / (key_interval_s * fps);
    const auto first = static_cast<double>(cost.first_bytes), others = static_cast<double>(cost.bytes) - first;
    return whole * first + (1 - whole) * others / static_cast<double>(count - 1);
}

/// A setting on a film, at each quality.
std::vector<EncodedRow> rows_of(const RecordedFrames& recorded, VideoOptions options, const EncoderSetting& setting) {
    const auto finite = [](double psnr_db) { return std::min(psnr_db, 100.0); };  // above any value with a difference
    std::vector<EncodedRow> rows;
    options.preset = setting.preset;
    for (const int crf : qualities) {
        options.crf = setting.codec == "h264" ? crf : 2 * crf;  // VP9 and AV1 go up to 63
        const auto encoded = try_encoding(recorded, options, changes_of(setting, options.crf));
        rows.push_back({static_cast<double>(options.crf), 1e3 * encoded.cpu_s / count,
                        bytes_per_frame(encoded, static_cast<double>(options.fps_numerator) / options.fps_denominator),
                        finite(encoded.whole.psnr_db), finite(encoded.moving.psnr_db), encoded.whole.ssim,
                        encoded.moving.ssim});
    }
    return rows;
}

void measure(const FilmToEncode& film, const std::string& codec) {
    const auto scene = scene_of(film, codec);
    const auto recorded = record(scene);
    auto options = video_options(scene);
    std::vector<const EncoderSetting*> settings;
    for (const auto& setting : encoder_settings)
        if (setting.codec == codec) settings.push_back(&setting);
    std::vector<std::vector<EncodedRow>> rows;
    for (const auto* setting : settings) rows.push_back(rows_of(recorded, options, *setting));
    for (int repeat = 1; repeat < repeats; ++repeat)
        for (std::size_t s = 0; s < settings.size(); ++s)
            for (auto& row : rows[s]) {
                options.preset = settings[s]->preset;
                options.crf = static_cast<int>(row.crf);
                const auto again = time_encoding(recorded, options, changes_of(*settings[s], options.crf));
                row.cpu_ms = std::min(row.cpu_ms, 1e3 * again.cpu_s / count);
            }
    for (std::size_t s = 0; s < settings.size(); ++s) {
        const auto equal = equal_quality(rows[s], rows[0]);
        for (const auto& row : rows[s])
            fmt::print("{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", film.name, film.size.width, film.size.height,
                       film.theme, settings[s]->name, row.crf, row.cpu_ms, row.bytes, row.psnr_db, row.moving_psnr_db,
                       row.ssim, row.moving_ssim, equal.cpu, equal.bytes);
    }
}

}  // namespace
}  // namespace doppel

int main(int argc, char** argv) {
    try {
        fmt::print(
            "film,width_px,height_px,theme,setting,crf,cpu_ms_per_frame,bytes_per_frame,psnr_db,moving_psnr_db,ssim,"
            "moving_ssim,cpu_at_equal_quality,bytes_at_equal_quality\n");
        for (const auto& film : doppel::films) doppel::measure(film, argc > 1 ? argv[1] : "h264");
    } catch (const std::exception& error) {
        fmt::print(stderr, "encoders: {}\n", error.what());
        return 1;
    }
}
