#include "film/film.hpp"

#include "base/machine.hpp"
#include "image/picture.hpp"
#include "output/png.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace doppel {

Canvas::Canvas(const Scene& scene, const Composer& composer, Gl gl, const std::atomic<bool>& stop) : stop_(stop) {
    const auto& video = scene.preset.video;
    if (video.transparent) {
        on_white_.emplace(video.size, composer.backdrop(rgb(0xffffff)), gl, stop, video.typeface);
        matted_ = Picture(video.size);
    }
    const auto page = video.transparent ? rgb(0x000000) : composer.page_color();
    renderer_.emplace(video.size, composer.backdrop(page), gl, stop, video.typeface);
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

FrameRange drawn_frames(const Scene& scene, const RunOptions& options, long first) {
    if (options.shard) return frames_of(scene, *options.shard);
    if (options.merge) return {0, 0};
    if (!options.only.empty()) return {options.only.front(), options.only.back() + 1, options.only};
    const auto schedule = schedule_of(scene);
    return schedule.range(first, schedule.motion);
}

double card_opacity(long k, long count, double fps, bool fades_in) {
    const auto frames = static_cast<double>(count);
    const double fade = std::min(std::max(1.0, std::min(0.5 * fps, frames / 2)), frames - 1);  // one frame is whole
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
    options.frames = schedule_of(scene).frames();
    return options;
}

Film::Film(const Scene& scene, const MotionBounds& bounds, const RunOptions& options, long first, long last,
           Transaction& parts, RunRecord& record, const std::atomic<bool>& stop)
    : scene_(scene),
      options_(options),
      parts_(parts),
      record_(record),
      stop_(stop),
      schedule_(schedule_of(scene)),
      drawn_(drawn_frames(scene, options, first)),
      next_(schedule_.range(first, last).first),
      frame_(first),
      last_(last),
      composer_(scene, bounds) {
    const auto& video = scene.preset.video;
    record.shown = schedule_.range(first, last);
    if (video.poster_s && !options.is_part()) poster_at_ = schedule_.at(*poster_frame(scene));
    if (!options.merge || video.poster_s) canvas_.emplace(scene, composer_, options.gl, stop);
    if (!options.merge) record.gl = canvas_->description();
    if (video.format == FilmFormat::png)
        begin_pictures();
    else
        begin_video();
}

void Film::begin_pictures() {
    const auto& video = scene_.preset.video;
    film_name_ = "frames";
    folder_ = parts_.directory(film_name_);
    const auto place_of = [this](long k) { return folder_ / fmt::format("{:06}.png", drawn_.at(k)); };
    sink_ = make_png_sink(place_of, png_threads(options_.jobs, video.size),
                          {.with_alpha = video.transparent, .metadata = metadata_}, stop_);
}

void Film::begin_video() {
    auto video = video_options(scene_);
    film_name_ = scene_.preset.name + extension(video.format);
    if (options_.shard) {
        film_name_ = part_name(scene_, *options_.shard);
        video.part_header = part_header(scene_, *options_.shard, record_.gl);
        video.first_frame = drawn_.first;
    }
    video.is_stream = options_.to_stream;
    video.metadata = metadata_;
    if (options_.is_partial()) video.frames = 0;
    sink_ = make_video_sink(video.is_stream ? "-" : parts_.file(film_name_), video, stop_);
    record_.libav = libav_description();
}

/// The picture of the last snapshot as frame `number`, with a card that fades out or in over it.
DisplayList Film::list_of(long number) const {
    auto list = composer_.frame();
    const double fps = scene_.fps.value();
    const long end = schedule_.frames() - schedule_.end;
    DisplayList card;
    if (number < schedule_.title) card = composer_.title_card(card_opacity(number, schedule_.title, fps, false));
    if (number >= end) card = composer_.end_card(card_opacity(number - end, schedule_.end, fps, true));
    list.insert(list.end(), card.begin(), card.end());
    return list;
}

const Picture& Film::take(const DisplayList& list) {
    const double start = seconds_of(CLOCK_THREAD_CPUTIME_ID);
    const auto& picture = canvas_->draw(list);
    const double drawn = seconds_of(CLOCK_THREAD_CPUTIME_ID);
    sink_->take(picture, canvas_->changed());
    record_.draw_cpu_s += drawn - start;
    record_.write_cpu_s += seconds_of(CLOCK_THREAD_CPUTIME_ID) - drawn;
    ++record_.frames;
    return picture;
}

bool Film::add(const Snapshot& snapshot) {
    composer_.add(snapshot);
    if (frame_ == last_ || snapshot.pair.moment() != scene_.frames.at(frame_)) return false;
    ++frame_;
    for (const long end = schedule_.range(0, frame_).last; next_ < end; ++next_) {
        const bool is_drawn = drawn_.contains(next_), is_poster = next_ == poster_at_;
        if (!is_drawn && !is_poster) continue;
        const auto list = list_of(next_);
        const auto& picture = is_drawn ? take(list) : canvas_->draw(list);
        if (is_poster) poster_ = picture;
    }
    return true;
}

void Film::finish(const std::vector<FilmEvent>& events) {
    for (const auto& [frame, title] : chapters_of(scene_, events, *record_.shown)) sink_->add_chapter(frame, title);
    if (options_.merge) join_parts();
    sink_->finish();
    if (auto words = composer_.left_out(); !words.empty()) record_.warnings.push_back(std::move(words));
    if (options_.shard && !folder_.empty()) pack_pictures();
    parts_.finished(film_name_);
    if (poster_) write(".poster.png", *poster_);
}

void Film::join_parts() {
    std::set<std::string> libraries;
    for (const auto& path : parts_in(scene_, parts_.folder())) {
        BlockFile part(path, film_part);
        libraries.insert(Json::parse(part.header()).value("gl", ""));
        sink_->add(part);
    }
    record_.gl = fmt::format("{}", fmt::join(libraries, "; "));
    record_.frames = schedule_.frames();
}

void Film::pack_pictures() {
    const auto name = part_name(scene_, *options_.shard);
    BlockFile part(parts_.file(name), part_header(scene_, *options_.shard, record_.gl));
    for (long frame = drawn_.first; frame < drawn_.last; ++frame) {
        throw_if_set(stop_);
        const auto path = folder_ / fmt::format("{:06}.png", frame);
        auto picture = start_of_file(path, std::filesystem::file_size(path));
        part(picture);
        part.end_block();
    }
    part.finish();
    parts_.keep_only(name, name);
}

void Film::write(const std::string& ending, const Picture& picture) const {
    const auto name = scene_.preset.name + ending;
    write_png(parts_.file(name), picture, {.with_alpha = scene_.preset.video.transparent, .metadata = metadata_},
              stop_);
    parts_.finished(name);
}

}  // namespace doppel
