#include "base/error.hpp"
#include "base/machine.hpp"
#include "film/film.hpp"
#include "film/run.hpp"
#include "image/picture.hpp"
#include "output/png.hpp"
#include "output/transaction.hpp"
#include "plot/page.hpp"
#include "render/typeface.hpp"
#include "scene/resolved.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace doppel {
namespace {

/// For example "14", "6.8": at most microseconds.
std::string seconds_text(double seconds) {
    return fmt::format("{}", std::round(1e6 * seconds) / 1e6);
}

Moment still_moment(const Scene& scene, const Rational& time) {
    const double end = scene.preset.duration_s.value();
    if (time.value() > end) throw bad_input("--at {}: {} ends at {:.6g} s", time.value(), scene.preset.name, end);
    return moment_at(time.value() * scene.preset.sample_hz.value());
}

}  // namespace

std::string still_name(const Scene& scene, const Rational& time, PictureFormat format) {
    return fmt::format("{}.{}s.{}", scene.preset.name, seconds_text(scene.time(still_moment(scene, time))),
                       name_of(format));
}

RunResult draw_still(const Scene& scene, const Rational& time, PictureFormat format, const RunOptions& options,
                     const std::atomic<bool>& stop, const Report& report) {
    const double start = seconds_of(CLOCK_MONOTONIC);
    const auto moment = still_moment(scene, time);
    const auto text = seconds_text(scene.time(moment));
    const auto name = still_name(scene, time, format);
    Transaction parts(options.out / scene.preset.name, "still", "film", options.replacing);
    const auto place = parts.file(name);
    auto alone = scene;  // with a single frame
    alone.frames = {.last = moment, .count = 1};
    alone.preset.video.contact_sheet.reset();
    const long samples = moment.sample + 1;
    Recording recording(alone, {samples}, true, stop);
    Composer composer(scene, recording.bounds());
    std::optional<Canvas> canvas;  // made first, so that missing OpenGL is reported at once
    if (format == PictureFormat::png) canvas.emplace(scene, composer, options.gl, stop);
    recording.play([&](const Snapshot& snapshot) {
        composer.add(snapshot);
        report({std::min(snapshot.pair.sample + 1, samples), samples});
    });
    const auto& video = scene.preset.video;
    const auto metadata = metadata_of(scene.preset.title, scene.preset.name,
                                      fmt::format("at {} s of {}", text, scene.preset.duration_s.value()));
    if (canvas) {
        write_png(place, canvas->draw(composer.frame()), {.with_alpha = video.transparent, .metadata = metadata}, stop);
    } else {
        auto list = composer.backdrop();
        const auto frame = composer.frame();
        list.insert(list.end(), frame.begin(), frame.end());
        write_file(place, page_file({.size = video.size, .items = page_list(list), .typeface = video.typeface}, format,
                                    pt_per_px * video.size.width, metadata));
    }
    parts.finished(name);
    auto files = parts.keeping_finished([&] {
        throw_if_set(stop);
        return parts.publish();
    });
    RunResult result{.files = std::move(files), .frames = 1, .samples = samples};
    if (auto words = composer.left_out(); !words.empty()) result.warnings.push_back(std::move(words));
    result.wall_s = seconds_of(CLOCK_MONOTONIC) - start;
    return result;
}

Scene tile_scene(Scene scene) {
    auto& video = scene.preset.video;
    constexpr int sheet_width = 1920;  // approximate width, px
    const int width = std::min(video.size.width, std::max(sheet_width / (*video.contact_sheet)[0], 16));
    video.strips.clear();
    video.pendulums = true;
    video.transparent = false;
    video.title_card_s = video.end_card_s = {0, 1};
    if (video.layout == Arrangement::portrait) video.layout = Arrangement::side_by_side;
    if (video.layout == Arrangement::phase) video.layout = Arrangement::overlay;
    for (const char* text : {"title", "subtitle", "clock", "labels"}) std::erase(video.show, text);
    video.size = {width, has_panel_for_each(video) ? width * 9 / 16 : width};
    return scene;
}

DisplayList tile_of(const Scene& scene, const Composer& composer, double time) {
    auto list = composer.frame();
    const auto em = 0.05f * static_cast<float>(scene.preset.video.size.width);
    list.push_back(
        label(clock_text(scene, time), {1.2f * em, 1.6f * em}, em, make_style(scene.preset.video, 1, 1).theme.text));
    return list;
}

Picture contact_sheet_of(const Scene& scene, Recording& recording, long first, long last, Gl gl,
                         const std::atomic<bool>& stop) {
    const auto [across, down] = *scene.preset.video.contact_sheet;
    std::vector<Moment> moments;  // frames evenly spaced over the film, with both ends
    const long count = std::min(long{across} * down, last - first), high = last - 1;  // no frame twice
    for (long k = 0; k < count; ++k)
        moments.push_back(scene.frames.at(count == 1 ? high
                                                     : first + std::lround(static_cast<double>((high - first) * k) /
                                                                           static_cast<double>(count - 1))));
    const auto tile = tile_scene(scene);
    const auto& style = tile.preset.video;
    Composer composer(tile, recording.bounds());
    Renderer tiles(style.size, composer.backdrop(), gl, stop, style.typeface);
    std::vector<Picture> pictures;
    recording.play([&](const Snapshot& snapshot) {
        throw_if_set(stop);
        composer.add(snapshot);
        if (std::ranges::find(moments, snapshot.pair.moment()) != moments.end())
            pictures.push_back(tiles.draw(tile_of(tile, composer, tile.time(snapshot.pair.moment())), stop));
    });
    const auto below = contact_sheet(pictures, across, 8, composer.page_color());
    const auto width = static_cast<float>(below.size.width), unit = width / 1920;
    const auto look = make_style(style, unit, unit);
    const Size head{below.size.width, static_cast<int>(76 * unit) + 1};
    const auto size = look.type.fitting_size(scene.preset.title, px(look.font.title), Weight::bold, 0.97f * width);
    Renderer renderer(head,
                      {filled(head, look.theme.background), label(scene.preset.title, {22 * unit, 50 * unit}, size,
                                                                  look.theme.text, Align::left, Weight::bold)},
                      gl, stop, style.typeface);
    Picture sheet = renderer.draw({}, stop);
    sheet.size.height += below.size.height;
    sheet.rgba.insert(sheet.rgba.end(), below.rgba.begin(), below.rgba.end());
    return sheet;
}

}  // namespace doppel
