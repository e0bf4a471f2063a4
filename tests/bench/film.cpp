#include "numeric/error.hpp"
#include "output/mp4.hpp"
#include "output/png.hpp"
#include "output/yuv.hpp"
#include "picture/renderer.hpp"
#include "scene/composer.hpp"
#include "scene/run.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <memory>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavutil/opt.h>
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
        composer.add(pair.next(never));
        if (n >= first) visit(composer);
    }
}

void compose(benchmark::State& state) {
    const auto scene = butterfly();
    Composer composer(scene);
    PairRun pair(scene);
    for (long n = 0; n < first; ++n) composer.add(pair.next(never));
    for (auto _ : state) benchmark::DoNotOptimize(composer.frame());
}
BENCHMARK(compose)->Unit(benchmark::kMillisecond);

/// Draws (and, if `converts`, converts what changed) frame after frame.
void draw(benchmark::State& state, bool converts) {
    const auto scene = butterfly();
    std::vector<DisplayList> lists;
    for_each_frame(scene, [&](const Composer& composer) { lists.push_back(composer.frame()); });
    Renderer renderer(scene.preset.video.size, Composer(scene).backdrop());
    std::size_t k = 0;
    for (auto _ : state) {
        const auto& picture = renderer.draw(lists[k++ % lists.size()]);
        if (converts)
            for (const auto& area : renderer.changed()) benchmark::DoNotOptimize(convert(picture, area));
    }
}
BENCHMARK_CAPTURE(draw, alone, false)->Unit(benchmark::kMillisecond)->Iterations(count);
BENCHMARK_CAPTURE(draw, and_convert_what_changed, true)->Unit(benchmark::kMillisecond)->Iterations(count);

Picture one_frame(const Scene& scene) {
    Composer composer(scene);
    PairRun pair(scene);
    for (long n = 0; n <= first; ++n) composer.add(pair.next(never));
    Renderer renderer(scene.preset.video.size, composer.backdrop());
    return renderer.draw(composer.frame());
}

void convert_whole_frame(benchmark::State& state) {
    const auto picture = one_frame(butterfly());
    for (auto _ : state) benchmark::DoNotOptimize(convert(picture, {0, 0, picture.size.width, picture.size.height}));
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

/// x264 with the settings of the video, fed with frames that lie in memory: nothing can be faster.
void encode_alone(const std::vector<YuvPart>& frames, const Scene& scene) {
    const auto& video = scene.preset.video;
    const auto* codec = avcodec_find_encoder_by_name("libx264");
    if (!codec) throw io_failed("libav has no libx264");
    auto* context = avcodec_alloc_context3(codec);
    context->width = video.size.width;
    context->height = video.size.height;
    context->pix_fmt = AV_PIX_FMT_YUV420P;
    context->time_base = {1, 120};
    context->framerate = {120, 1};
    context->thread_count = run_threads(0);
    av_opt_set(context->priv_data, "preset", video.preset.c_str(), 0);
    av_opt_set(context->priv_data, "crf", std::to_string(video.crf).c_str(), 0);
    if (avcodec_open2(context, codec, nullptr) < 0) throw io_failed("libx264 cannot be opened");
    auto* packet = av_packet_alloc();
    const auto drain = [&] {
        while (avcodec_receive_packet(context, packet) == 0) av_packet_unref(packet);
    };
    auto* frame = av_frame_alloc();
    frame->format = AV_PIX_FMT_YUV420P;
    frame->width = video.size.width;
    frame->height = video.size.height;
    for (std::size_t k = 0; k < frames.size(); ++k) {
        frame->data[0] = frames[k].y();
        frame->data[1] = frames[k].cb();
        frame->data[2] = frames[k].cr();
        frame->linesize[0] = video.size.width;
        frame->linesize[1] = frame->linesize[2] = video.size.width / 2;
        frame->pts = static_cast<std::int64_t>(k);
        avcodec_send_frame(context, frame);
        drain();
    }
    avcodec_send_frame(context, nullptr);
    drain();
    av_frame_free(&frame);
    av_packet_free(&packet);
    avcodec_free_context(&context);
}

/// The whole of Doppel against the encoder alone on the same frames, turn by turn.
void end_to_end(benchmark::State& state) {
    const auto scene = butterfly();
    std::vector<YuvPart> frames;
    Renderer renderer(scene.preset.video.size, Composer(scene).backdrop());
    const auto size = scene.preset.video.size;
    for_each_frame(scene, [&](const Composer& composer) {
        frames.push_back(convert(renderer.draw(composer.frame()), {0, 0, size.width, size.height}));
    });
    const auto out = std::filesystem::temp_directory_path() / "doppel-bench";
    Cost whole, floor;
    const auto add = [](Cost& sum, const Cost& more) {
        sum.wall_s += more.wall_s;
        sum.cpu_s += more.cpu_s;
    };
    for (auto _ : state) {
        add(whole, cost_of([&] {
                run(scene, {.out = out, .first = first, .last = first + count}, never, [](const Progress&) {});
            }));
        add(floor, cost_of([&] { encode_alone(frames, scene); }));
    }
    std::filesystem::remove_all(out);
    const auto shown = static_cast<double>(count * state.iterations());
    state.counters["frames/s"] = shown / whole.wall_s;
    state.counters["frames/s floor"] = shown / floor.wall_s;
    state.counters["cpu ms/frame"] = 1e3 * whole.cpu_s / shown;
    state.counters["cpu ms/frame floor"] = 1e3 * floor.cpu_s / shown;
    state.counters["% of floor, cpu"] = 100 * floor.cpu_s / whole.cpu_s;
    state.counters["% of floor, wall"] = 100 * floor.wall_s / whole.wall_s;
}
BENCHMARK(end_to_end)->Iterations(3)->Unit(benchmark::kSecond)->UseRealTime();

}  // namespace
}  // namespace doppel
