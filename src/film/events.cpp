#include "film/events.hpp"

#include "film/film.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {

std::vector<FilmEvent> film_events(const Scene& scene, const Outcome& outcome) {
    std::vector<FilmEvent> events{{0, "release", "Release"}};
    for (const auto& [time_s, side, link] : outcome.flips) {
        const auto of = scene.is_single() ? "" : side == 'a' ? "A: " : "B: ";
        events.push_back({time_s,
                          "flip",
                          fmt::format("{}link {} flips", of, link),
                          {{"side", std::string(1, side)}, {"link", link}}});
    }
    if (const auto since = outcome.divergence.since()) events.push_back({*since, "divergence", "Divergence"});
    for (const auto& [at_s, speed] : scene.preset.video.speed.changes)
        if (at_s.numerator > 0)
            events.push_back({at_s.value(), "speed", "Speed " + speed.text(), {{"speed", speed.text()}}});
    std::ranges::stable_sort(events, {}, &FilmEvent::time_s);
    const auto schedule = schedule_of(scene);
    for (auto& event : events) {
        const long frame = scene.frames.first_from(moment_at(event.time_s * scene.preset.sample_hz.value()));
        event.frame = schedule.at(std::min(frame, schedule.motion - 1));
    }
    return events;
}

Json json_of(const Scene& scene, const std::vector<FilmEvent>& events, const std::optional<FrameRange>& shown) {
    Json list = Json::array();
    for (const auto& event : events) {
        Json json{{"event", event.event}, {"time_s", event.time_s}};
        if (shown && !shown->contains(event.frame)) continue;
        if (shown) json["film_s"] = static_cast<double>(event.frame - shown->first) / scene.fps.value();
        json.update(event.details);
        list.push_back(std::move(json));
    }
    return list;
}

std::map<long, std::string> chapters_of(const Scene& scene, const std::vector<FilmEvent>& events,
                                        const FrameRange& shown) {
    std::map<long, std::string> chapters;
    if (schedule_of(scene).title > 0 || shown.first > 0) chapters[0] = scene.preset.title;
    for (const auto& event : events) {
        if (!shown.contains(event.frame)) continue;
        const long frame = event.frame - shown.first;
        const bool is_near =
            !chapters.empty() && static_cast<double>(frame - chapters.rbegin()->first) < scene.fps.value();
        if (event.event != "flip" || !is_near) chapters[frame] = event.chapter;
    }
    return chapters;
}

}  // namespace doppel
