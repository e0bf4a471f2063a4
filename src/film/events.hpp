#pragma once

#include "film/recording.hpp"
#include "scene/resolved.hpp"
#include "scene/scene.hpp"

#include <string>
#include <vector>

namespace doppel {

/// Something that happens in a film.
struct FilmEvent {
    double time_s = 0;
    std::string event;  // "release", "flip", "divergence", "speed"
    char side = 0;      // of a flip: 'a' or 'b', and the link from 1 on
    int link = 0;
    std::string speed{};  // of a change of speed: the new one, a fraction
};

/// Finds the flips of a pair from its samples: a link of a side passes the upright position. Of chains of one to three
/// links.
class FlipFinder {
public:
    explicit FlipFinder(const Scene& scene) : scene_(scene) {}
    /// All samples are required in order.
    void add(const PairState& state);
    const std::vector<FilmEvent>& flips() const { return flips_; }

private:
    const Scene& scene_;
    std::vector<double> turns_;  // of each link at the last sample, whole turns
    std::vector<FilmEvent> flips_;
};

/// Release, flips, divergence and changes of speed, in order of time.
std::vector<FilmEvent> film_events(const Scene& scene, std::vector<FilmEvent> flips, const Outcome& outcome);

/// The frame of the whole film, with cards and still frames, that first shows this time.
long film_frame(const Scene& scene, double time_s);

/// For the manifest. With `in_film`, also the time in the film, s.
Json json_of(const Scene& scene, const std::vector<FilmEvent>& events, bool in_film);

/// A chapter of a film: its first frame, and its title.
struct Chapter {
    long frame;
    std::string title;
};
/// The chapters of a film: its events, but flips only if they are a second from the chapter before.
std::vector<Chapter> chapters_of(const Scene& scene, const std::vector<FilmEvent>& events);

}  // namespace doppel
