#include "film/film.hpp"

#include "base/clock.hpp"
#include "base/embedded.hpp"
#include "image/picture.hpp"
#include "output/png.hpp"
#include "output/sink.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {

namespace {

/// Adds the CPU time that this thread spends during its lifetime, s.
class Stopwatch {
public:
    explicit Stopwatch(double& total) : total_(total), start_(seconds_of(CLOCK_THREAD_CPUTIME_ID)) {}
    ~Stopwatch() { total_ += seconds_of(CLOCK_THREAD_CPUTIME_ID) - start_; }

private:
    double& total_;
    double start_;
};

Metadata film_metadata(const Preset& preset) {
    return metadata_of(preset.title, preset.name, fmt::format("how it was made is in {}.json", preset.name));
}

DisplayList on_page(const DisplayList& backdrop, Size size, Color page) {
    DisplayList list{filled(size, page)};
    list.insert(list.end(), backdrop.begin(), backdrop.end());
    return list;
}

}  // namespace

Canvas::Canvas(const Scene& scene, const Composer& composer, Gl gl, const std::atomic<bool>& stop) : stop_(stop) {
    const auto& video = scene.preset.video;
    auto backdrop = composer.backdrop();
    if (video.transparent) {
        on_white_.emplace(video.size, on_page(backdrop, video.size, rgb(0xffffff)), gl, stop, video.typeface);
        backdrop = on_page(backdrop, video.size, rgb(0x000000));
        matted_ = Picture(video.size);
    }
    renderer_.emplace(video.size, backdrop, gl, stop, video.typeface);
}

const Picture& Canvas::draw(const DisplayList& list) {
    const auto& picture = renderer_->draw(list, stop_);
    changed_ = renderer_->changed();
    if (!on_white_) return picture;
    const auto& white = on_white_->draw(list, stop_);
    changed_.insert(changed_.end(), on_white_->changed().begin(), on_white_->changed().end());
    for (const auto& area : changed_) matte(picture, white, area, matted_);
    return matted_;
}

Schedule schedule_of(const Scene& scene) {
    const auto& video = scene.preset.video;
    const auto frames = [&](const Rational& seconds) { return std::lround(seconds.value() * scene.fps.value()); };
    return {.title = frames(video.title_card_s),
            .hold_start = frames(video.hold_start_s),
            .motion = scene.frames.count,
            .hold_end = frames(video.hold_end_s),
            .end = frames(video.end_card_s)};
}

double card_opacity(long k, long count, double fps, bool fades_in) {
    const double fade = std::max(1.0, std::min(0.5 * fps, static_cast<double>(count) / 2));  // frames
    const double left = static_cast<double>(fades_in ? k + 1 : count - k);
    const double share = std::clamp(left / (fade + 1), 0.0, 1.0);
    return share * share * (3 - 2 * share);
}

std::optional<long> poster_frame(const Scene& scene) {
    const auto& seconds = scene.preset.video.poster_s;
    if (!seconds) return std::nullopt;
    const auto& frames = scene.frames;
    const auto moment = moment_at(seconds->value() * scene.preset.sample_hz.value());
    const long frame = std::min(frames.first_from(moment), frames.count - 1);
    const auto distance = [&](long k) { return std::abs(scene.time(frames.at(k)) - scene.time(moment)); };
    return frame > 0 && distance(frame - 1) < distance(frame) ? frame - 1 : frame;
}

VideoOptions video_options(const Scene& scene) {
    auto options = scene.preset.video.options(scene.fps);
    options.metadata = film_metadata(scene.preset);
    return options;
}

Film::Film(const Scene& scene, const MotionBounds& bounds, const RunOptions& options, long first, Transaction& parts,
           RunRecord& record, const std::atomic<bool>& stop)
    : scene_(scene),
      parts_(parts),
      record_(record),
      stop_(stop),
      schedule_(schedule_of(scene)),
      composer_(scene, bounds) {
    const auto& video = scene.preset.video;
    if (video.format == FilmFormat::png) {
        film_name_ = "frames";
        const long number = first == 0 ? 0 : schedule_.title + schedule_.hold_start + first;
        const auto place_of = [number, folder = parts.directory(film_name_)](long k) {
            return folder / fmt::format("{:06}.png", number + k);
        };
        sink_ = make_png_sink(place_of, png_threads(options.jobs, video.size),
                              {.with_alpha = video.transparent, .metadata = film_metadata(scene.preset)}, stop);
    } else {
        const auto file = video_options(scene);
        film_name_ = scene.preset.name + extension(file.format);
        sink_ = make_video_sink(parts.file(film_name_), file, stop);
        record.libav = libav_description();
    }
    if (video.poster_s) parts.require(scene.preset.name + ".poster.png");
    if (video.contact_sheet) parts.require(scene.preset.name + ".contact.png");
    canvas_.emplace(scene, composer_, options.gl, stop);
    record.gl = canvas_->description();
}

const Picture& Film::take(const DisplayList& list) {
    const Picture* picture = nullptr;
    {
        Stopwatch watch(record_.draw_cpu_s);
        picture = &canvas_->draw(list);
    }
    Stopwatch watch(record_.write_cpu_s);
    sink_->take(*picture, canvas_->changed());
    ++record_.frames;
    return *picture;
}

/// Draws the first or last frame with a card fading out or in over it.
void Film::take_card(long frames, bool fades_in) {
    for (long k = 0; k < frames; ++k) {
        const double opacity = card_opacity(k, frames, scene_.fps.value(), fades_in);
        auto list = composer_.frame();
        const auto card = fades_in ? composer_.end_card(opacity) : composer_.title_card(opacity);
        list.insert(list.end(), card.begin(), card.end());
        take(list);
    }
}

void Film::write_frame(long number) {
    const bool is_first = number == 0, is_last = number + 1 == schedule_.motion;
    if (is_first) take_card(schedule_.title, false);
    const auto list = composer_.frame();
    const long times = 1 + (is_first ? schedule_.hold_start : 0) + (is_last ? schedule_.hold_end : 0);
    for (long k = 0; k < times; ++k) {
        const auto& picture = take(list);
        if (k == 0 && number == poster_frame(scene_)) poster_ = picture;
    }
    if (is_last) take_card(schedule_.end, true);
}

void Film::finish() {
    sink_->finish();
    parts_.finished(film_name_);
    if (poster_) write(".poster.png", *poster_);
}

void Film::write(const std::string& ending, const Picture& picture) const {
    const auto& preset = scene_.preset;
    const auto name = preset.name + ending;
    write_png(parts_.file(name), picture, {.with_alpha = preset.video.transparent, .metadata = film_metadata(preset)},
              stop_);
    parts_.finished(name);
}

}  // namespace doppel
