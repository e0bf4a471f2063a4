#include "film/events.hpp"

#include "film/film.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

std::string title_of(const Scene& scene, const FilmEvent& event) {
    if (event.event == "release") return "Release";
    if (event.event == "divergence") return "Divergence";
    if (event.event == "speed") return "Speed " + event.speed;
    const auto side = scene.is_single() ? std::string() : fmt::format("{}: ", event.side == 'a' ? 'A' : 'B');
    return fmt::format("{}link {} flips", side, event.link);
}

}  // namespace

void FlipFinder::add(const PairState& state) {
    constexpr std::size_t most_links = 3;
    std::size_t at = 0;
    for (const char letter : scene_.letters()) {
        const auto& bobs = (letter == 'a' ? state.a : state.b).bobs;
        if (!scene_.side(letter).has_angles || bobs.size() > most_links) continue;
        for (std::size_t link = 0; link < bobs.size(); ++link, ++at) {
            const double turns = std::round(bobs[link].theta / (2 * pi));
            if (at == turns_.size()) turns_.push_back(turns);
            if (turns != turns_[at])
                flips_.push_back({scene_.time(state.sample), "flip", letter, static_cast<int>(link) + 1});
            turns_[at] = turns;
        }
    }
}

std::vector<FilmEvent> film_events(const Scene& scene, std::vector<FilmEvent> flips, const Outcome& outcome) {
    auto events = std::move(flips);
    events.insert(events.begin(), {0, "release"});
    if (const auto since = outcome.divergence.since()) events.push_back({*since, "divergence"});
    for (const auto& change : scene.preset.video.speed.changes)
        if (change.at_s.numerator > 0) events.push_back({change.at_s.value(), "speed", 0, 0, change.speed.text()});
    std::ranges::stable_sort(events, {}, &FilmEvent::time_s);
    return events;
}

long film_frame(const Scene& scene, double time_s) {
    const auto schedule = schedule_of(scene);
    const long frame = scene.frames.first_from(moment_at(time_s * scene.preset.sample_hz.value()));
    const long still = schedule.title + schedule.hold_start;
    return frame == 0 ? schedule.title : still + std::min(frame, schedule.motion - 1);
}

Json json_of(const Scene& scene, const std::vector<FilmEvent>& events, bool in_film) {
    Json list = Json::array();
    for (const auto& event : events) {
        Json json{{"event", event.event}, {"time_s", event.time_s}};
        if (in_film) json["film_s"] = static_cast<double>(film_frame(scene, event.time_s)) / scene.fps.value();
        if (event.link > 0) json["side"] = std::string(1, event.side), json["link"] = event.link;
        if (!event.speed.empty()) json["speed"] = event.speed;
        list.push_back(std::move(json));
    }
    return list;
}

std::vector<Chapter> chapters_of(const Scene& scene, const std::vector<FilmEvent>& events) {
    std::vector<Chapter> chapters;
    if (schedule_of(scene).title > 0) chapters.push_back({0, scene.preset.title});
    for (const auto& event : events) {
        const long frame = film_frame(scene, event.time_s);
        const bool is_flip = event.event == "flip";
        const bool is_near =
            !chapters.empty() && static_cast<double>(frame - chapters.back().frame) < scene.fps.value();
        if (!is_flip || !is_near) chapters.push_back({frame, title_of(scene, event)});
    }
    return chapters;
}

}  // namespace doppel
