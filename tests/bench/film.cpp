#include "base/error.hpp"
#include "film/composer.hpp"
#include "film/run.hpp"
#include "output/png.hpp"
#include "output/samples.hpp"
#include "output/sink.hpp"
#include "render/renderer.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <memory>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavutil/frame.h>
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>
}

// What a frame of butterfly costs at 1920×1080, stage by stage, and the whole against the encoder alone.

namespace doppel {
namespace {

constexpr long first = 1500, count = 600;  // frames in the middle of the run: full trails, traces half across
const std::atomic<bool> never = false;

Scene butterfly() {
    return make_scene(read_preset(find_preset("butterfly")));
}

/// Calls visit(composer) for each of the frames, in order.
template <class Visit>
void for_each_frame(const Scene& scene, Visit&& visit) {
    Composer composer(scene);
    PairRun pair(scene);
    for (long n = 0; n < first + count; ++n) {
        composer.add({pair.next(never), {}});
        if (n >= first) visit(composer);
    }
}

void compose(benchmark::State& state) {
    const auto scene = butterfly();
    Composer composer(scene);
    PairRun pair(scene);
    for (long n = 0; n < first; ++n) composer.add({pair.next(never), {}});
    for (auto _ : state) benchmark::DoNotOptimize(composer.frame());
}
BENCHMARK(compose)->Unit(benchmark::kMillisecond);

/// Draws (and, if `converts`, converts what changed) frame after frame.
void draw(benchmark::State& state, Size size, bool converts) {
    auto preset = read_preset(find_preset("butterfly"));
    preset.video.size = size;
    const auto scene = make_scene(preset);
    std::vector<DisplayList> lists;
    for_each_frame(scene, [&](const Composer& composer) { lists.push_back(composer.frame()); });
    Renderer renderer(size, Composer(scene).backdrop());
    SampledAreas converted;
    std::size_t k = 0;
    double pixels = 0;
    for (auto _ : state) {
        const auto& picture = renderer.draw(lists[k++ % lists.size()]);
        for (const auto& area : renderer.changed())
            pixels += static_cast<double>(area.right - area.left) * (area.bottom - area.top);
        if (converts) convert(picture, renderer.changed(), AV_PIX_FMT_YUV420P, converted);
    }
    state.counters["px changed"] = pixels / static_cast<double>(state.iterations());
}
BENCHMARK_CAPTURE(draw, alone, Size{1920, 1080}, false)->Unit(benchmark::kMillisecond)->Iterations(count);
BENCHMARK_CAPTURE(draw, alone_4k, Size{3840, 2160}, false)->Unit(benchmark::kMillisecond)->Iterations(count);
BENCHMARK_CAPTURE(draw, and_convert_what_changed, Size{1920, 1080}, true)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(count);

Picture one_frame(const Scene& scene) {
    Composer composer(scene);
    PairRun pair(scene);
    for (long n = 0; n <= first; ++n) composer.add({pair.next(never), {}});
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
};

template <class Action>
Cost cost_of(Action&& action) {
    const auto now = [](clockid_t clock) {
        timespec t{};
        clock_gettime(clock, &t);
        return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
    };
    const Cost start{now(CLOCK_MONOTONIC), now(CLOCK_PROCESS_CPUTIME_ID)};
    action();
    return {now(CLOCK_MONOTONIC) - start.wall_s, now(CLOCK_PROCESS_CPUTIME_ID) - start.cpu_s};
}

/// A film in memory: of each frame what differs from the one before it.
using Reel = std::vector<SampledAreas>;

Reel reel_of(const Scene& scene) {
    Reel reel;
    Composer composer(scene);
    PairRun pair(scene);
    Renderer renderer(scene.preset.video.size, composer.backdrop());
    for (long n = 0; n <= scene.samples; ++n) {
        composer.add({pair.next(never), {}});
        const auto& picture = renderer.draw(composer.frame());
        convert(picture, renderer.changed(), AV_PIX_FMT_YUV420P, reel.emplace_back());
    }
    return reel;
}

/// Copies what changed to its place in the frame.
void put(const SampledAreas& changed, AVFrame& frame) {
    const std::uint8_t* from = changed.bytes.data();
    for (const Rect& area : changed.areas)
        for (int plane = 0; plane < av_pix_fmt_count_planes(AV_PIX_FMT_YUV420P); ++plane) {
            const auto place = plane_area(AV_PIX_FMT_YUV420P, plane, area);
            for (int row = 0; row < place.rows; ++row, from += place.row_bytes)
                std::memcpy(frame.data[plane] + std::ptrdiff_t{place.top + row} * frame.linesize[plane] + place.offset,
                            from, static_cast<std::size_t>(place.row_bytes));
        }
}

/// x264 with the settings of the video, fed from memory: nothing can be faster. The frames are put together in the one
/// that the encoder reads, on its own time.
Cost encode_alone(const Reel& reel, const Scene& scene) {
    const auto& video = scene.preset.video;
    const auto* codec = avcodec_find_encoder_by_name("libx264");
    if (!codec) throw io_failed("libav has no libx264");
    auto* context = avcodec_alloc_context3(codec);
    context->width = video.size.width;
    context->height = video.size.height;
    context->pix_fmt = AV_PIX_FMT_YUV420P;
    context->time_base = {1, 120};
    context->framerate = {120, 1};
    context->thread_count = static_cast<int>(encoder_threads);
    av_opt_set(context->priv_data, "preset", video.preset.c_str(), 0);
    av_opt_set(context->priv_data, "crf", std::to_string(video.crf).c_str(), 0);
    auto* packet = av_packet_alloc();
    auto* frame = av_frame_alloc();
    frame->format = AV_PIX_FMT_YUV420P;
    frame->width = video.size.width;
    frame->height = video.size.height;
    Cost cost;
    const auto encode = [&](AVFrame* next) {
        avcodec_send_frame(context, next);
        while (avcodec_receive_packet(context, packet) == 0) av_packet_unref(packet);
    };
    cost = cost_of([&] {
        if (avcodec_open2(context, codec, nullptr) < 0) throw io_failed("libx264 cannot be opened");
        if (av_frame_get_buffer(frame, 0) < 0) throw io_failed("no memory for a frame");
        for (std::size_t k = 0; k < reel.size(); ++k) {
            put(reel[k], *frame);
            frame->pts = static_cast<std::int64_t>(k);
            encode(frame);  // copies it before it returns
        }
        encode(nullptr);
    });
    av_frame_free(&frame);
    av_packet_free(&packet);
    avcodec_free_context(&context);
    return cost;
}

/// The whole of Doppel, all of the film, against the encoder alone on the same frames, turn by turn.
void end_to_end(benchmark::State& state, const char* speed) {
    auto preset = read_preset(find_preset("butterfly"));
    preset.video.preset = speed;
    const auto scene = make_scene(preset);
    const auto reel = reel_of(scene);
    const auto out = std::filesystem::temp_directory_path() / "doppel-bench";
    Cost whole, floor;
    const auto add = [](Cost& sum, const Cost& more) {
        sum.wall_s += more.wall_s;
        sum.cpu_s += more.cpu_s;
    };
    for (auto _ : state) {
        add(whole, cost_of([&] { run(scene, {.out = out}, never, [](const Progress&) {}); }));
        add(floor, encode_alone(reel, scene));
    }
    std::filesystem::remove_all(out);
    const auto shown = static_cast<double>(reel.size()) * static_cast<double>(state.iterations());
    state.counters["frames/s"] = shown / whole.wall_s;
    state.counters["frames/s floor"] = shown / floor.wall_s;
    state.counters["cpu ms/frame"] = 1e3 * whole.cpu_s / shown;
    state.counters["cpu ms/frame floor"] = 1e3 * floor.cpu_s / shown;
    state.counters["% of floor, cpu"] = 100 * floor.cpu_s / whole.cpu_s;
    state.counters["% of floor, wall"] = 100 * floor.wall_s / whole.wall_s;
}
BENCHMARK_CAPTURE(end_to_end, veryfast, "veryfast")->Iterations(2)->Unit(benchmark::kSecond)->UseRealTime();
BENCHMARK_CAPTURE(end_to_end, medium, "medium")->Iterations(2)->Unit(benchmark::kSecond)->UseRealTime();

}  // namespace
}  // namespace doppel
