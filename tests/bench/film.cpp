#include "film/film.hpp"

#include "base/machine.hpp"
#include "bench/encoders/encoding_trial.hpp"
#include "film/composer.hpp"
#include "film/run.hpp"
#include "output/png.hpp"
#include "output/samples.hpp"
#include "output/sink.hpp"
#include "render/renderer.hpp"

#include <benchmark/benchmark.h>

#include <filesystem>

// The cost of a frame of butterfly at 1920×1080 by stage, and the whole program compared with the encoder alone.

namespace doppel {
namespace {

constexpr long first = 1500, count = 600;  // frames in the middle of the run: complete trails, curves half across
const std::atomic<bool> never = false;

Scene butterfly() {
    return make_scene(read_preset(find_preset("butterfly")));
}

/// Calls visit(composer) for each of `frames` frames, in order.
template <class Visit>
void for_each_frame(const Scene& scene, long frames, Visit&& visit) {
    Recording recording(scene, {first + frames}, true, never);
    Composer composer(scene, recording.bounds());
    recording.play([&](const Snapshot& snapshot) {
        composer.add(snapshot);
        if (snapshot.pair.sample >= first) visit(composer);
    });
}

void compose(benchmark::State& state) {
    const auto scene = butterfly();
    for_each_frame(scene, 1, [&](Composer& composer) {
        for (auto _ : state) benchmark::DoNotOptimize(composer.frame());
    });
}
BENCHMARK(compose)->Unit(benchmark::kMillisecond);

/// Draws frame after frame, with conversion of changed parts if `converts`: CPU time of all threads, and elapsed time.
void draw(benchmark::State& state, Size size, bool converts) {
    auto preset = read_preset(find_preset("butterfly"));
    preset.video.size = size;
    const auto scene = make_scene(preset);
    std::vector<DisplayList> lists;
    for_each_frame(scene, count, [&](Composer& composer) { lists.push_back(composer.frame()); });
    Renderer renderer(size, Composer(scene, Recording(scene, {1}, true, never).bounds()).backdrop());
    SampledAreas converted;
    std::size_t k = 0;
    double pixels = 0;
    const double begun = seconds_of(CLOCK_MONOTONIC);
    for (auto _ : state) {
        const auto& picture = renderer.draw(lists[k++ % lists.size()]);
        for (const auto& area : renderer.changed())
            pixels += static_cast<double>(area.right - area.left) * (area.bottom - area.top);
        if (converts) convert(picture, renderer.changed(), AV_PIX_FMT_YUV420P, converted);
    }
    state.counters["wall ms"] = 1e3 * (seconds_of(CLOCK_MONOTONIC) - begun) / static_cast<double>(state.iterations());
    state.counters["px changed"] = pixels / static_cast<double>(state.iterations());
}
void in_ms(benchmark::internal::Benchmark* drawn) {
    drawn->Unit(benchmark::kMillisecond)->Iterations(count)->MeasureProcessCPUTime();
}
BENCHMARK_CAPTURE(draw, alone, Size{1920, 1080}, false)->Apply(in_ms);
BENCHMARK_CAPTURE(draw, alone_4k, Size{3840, 2160}, false)->Apply(in_ms);
BENCHMARK_CAPTURE(draw, and_convert_what_changed, Size{1920, 1080}, true)->Apply(in_ms);

Picture one_frame(const Scene& scene) {
    Recording recording(scene, {first + 1}, true, never);
    Composer composer(scene, recording.bounds());
    recording.play([&](const Snapshot& snapshot) { composer.add(snapshot); });
    Renderer renderer(scene.preset.video.size, composer.backdrop());
    return renderer.draw(composer.frame());
}

void convert_whole_frame(benchmark::State& state) {
    const auto picture = one_frame(butterfly());
    const std::vector whole{Rect{0, 0, picture.size.width, picture.size.height}};
    SampledAreas converted;
    for (auto _ : state) convert(picture, whole, AV_PIX_FMT_YUV420P, converted);
}
BENCHMARK(convert_whole_frame)->Unit(benchmark::kMillisecond);

void png(benchmark::State& state) {
    const auto picture = one_frame(butterfly());
    const auto path = std::filesystem::temp_directory_path() / "doppel-bench.png";
    for (auto _ : state) write_png(path, picture);
    state.counters["KB"] = static_cast<double>(std::filesystem::file_size(path)) / 1e3;
    std::filesystem::remove(path);
}
BENCHMARK(png)->Unit(benchmark::kMillisecond);

struct Cost {
    double wall_s = 0, cpu_s = 0;
    void add(double wall, double cpu) {
        wall_s += wall;
        cpu_s += cpu;
    }
};

RecordedFrames recorded(const Scene& scene) {
    RecordedFrames reel{scene.preset.video.size, {}};
    Recording recording(scene, {scene.samples + 1}, true, never);
    Composer composer(scene, recording.bounds());
    Renderer renderer(reel.size, composer.backdrop());
    recording.play([&](const Snapshot& snapshot) {
        composer.add(snapshot);
        const auto& picture = renderer.draw(composer.frame());
        convert(picture, renderer.changed(), AV_PIX_FMT_YUV420P, reel.frames.emplace_back());
    });
    return reel;
}

/// The whole program on the whole film, alternating with x264 alone at `floor_preset` on the same frames from memory;
/// and the quality of both.
void end_to_end(benchmark::State& state, const char* preset_name, const char* floor_preset) {
    auto preset = read_preset(find_preset("butterfly"));
    preset.video.preset = preset_name;
    const auto scene = make_scene(preset);
    const auto reel = recorded(scene);
    auto options = video_options(scene);
    const auto out = std::filesystem::temp_directory_path() / "doppel-bench";
    Cost whole, floor;
    EncodedFrames theirs;
    for (auto _ : state) {
        const double wall = seconds_of(CLOCK_MONOTONIC), cpu = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
        run(scene, {.out = out}, never, [](const Progress&) {});
        whole.add(seconds_of(CLOCK_MONOTONIC) - wall, seconds_of(CLOCK_PROCESS_CPUTIME_ID) - cpu);
        options.preset = floor_preset;
        theirs = try_encoding(reel, options);
        floor.add(theirs.wall_s, theirs.cpu_s);
    }
    std::filesystem::remove_all(out);
    options.preset = preset_name;
    const auto ours = try_encoding(reel, options);
    const auto shown = static_cast<double>(reel.frames.size()) * static_cast<double>(state.iterations());
    state.counters["frames/s"] = shown / whole.wall_s;
    state.counters["frames/s floor"] = shown / floor.wall_s;
    state.counters["cpu ms/frame"] = 1e3 * whole.cpu_s / shown;
    state.counters["cpu ms/frame floor"] = 1e3 * floor.cpu_s / shown;
    state.counters["cpu of floor"] = whole.cpu_s / floor.cpu_s;
    state.counters["bytes of floor"] = static_cast<double>(ours.bytes) / static_cast<double>(theirs.bytes);
    state.counters["dB more"] = ours.whole.psnr_db - theirs.whole.psnr_db;
    state.counters["dB more, moving"] = ours.moving.psnr_db - theirs.moving.psnr_db;
    state.counters["ssim more"] = ours.whole.ssim - theirs.whole.ssim;
    state.counters["ssim more, moving"] = ours.moving.ssim - theirs.moving.ssim;
}
BENCHMARK_CAPTURE(end_to_end, doppel, "doppel", "veryfast")->Iterations(2)->Unit(benchmark::kSecond)->UseRealTime();
BENCHMARK_CAPTURE(end_to_end, veryfast, "veryfast", "veryfast")->Iterations(2)->Unit(benchmark::kSecond)->UseRealTime();

}  // namespace
}  // namespace doppel
