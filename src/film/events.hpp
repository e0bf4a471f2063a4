#pragma once

#include "film/parts.hpp"
#include "film/recording.hpp"
#include "scene/resolved.hpp"
#include "scene/scene.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace doppel {

struct FilmEvent {
    double time_s;
    std::string event;              // "release", "flip", "divergence", "speed"
    std::string chapter;            // its title as a chapter
    Json details = Json::object();  // further keys of the manifest
    long frame = 0;                 // of the whole film, the first that shows it
};

/// Release, flips, divergence and changes of speed, in order of time, with their frames.
std::vector<FilmEvent> film_events(const Scene& scene, const Outcome& outcome);

/// For the manifest. `shown` = the frames of the film, counted in the whole film: then only the events in them, with
/// their times in this film, s; nothing: there is no film.
Json json_of(const Scene& scene, const std::vector<FilmEvent>& events, const std::optional<FrameRange>& shown);

/// The titles of a film's chapters, by their first frames, counted from the first one shown: its events, but flips only
/// if they are a second from the chapter before. Of events in one frame, the last one. The first chapter begins with
/// the film, because an MP4 would move its start there.
std::map<long, std::string> chapters_of(const Scene& scene, const std::vector<FilmEvent>& events,
                                        const FrameRange& shown);

}  // namespace doppel
