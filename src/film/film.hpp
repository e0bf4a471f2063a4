#pragma once

#include "film/composer.hpp"
#include "film/events.hpp"
#include "film/parts.hpp"
#include "film/recording.hpp"
#include "film/run.hpp"
#include "output/sink.hpp"
#include "output/transaction.hpp"
#include "render/renderer.hpp"
#include "scene/resolved.hpp"
#include "scene/scene.hpp"

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace doppel {

/// The results of a run for the manifest.
struct RunRecord : RunResult {
    long first_sample = 0, last_sample = 0;                      // of the table, inclusive
    std::string gl, libav;                                       // empty if no pictures were drawn
    double simulate_cpu_s = 0, draw_cpu_s = 0, write_cpu_s = 0;  // by the threads' clocks; write = convert and queue
    double encode_cpu_s = 0;                                     // other threads: encoder or compressor
    double cpu_s = 0;                                            // with the making of the scene
    MotionRecord motion;
    std::vector<FilmEvent> events;
    std::optional<FrameRange> shown = {};  // of a film: its frames, counted in the whole film
    std::string failure;                   // the error that ended the run, if any
};

/// Adds warnings about sides whose energy changed by more than 1 % of the potential range although it is conserved.
/// They also state when the error reaches half a radian, if that can be found in about the time of the run.
void add_warnings(const Scene& scene, RunRecord& record, const std::atomic<bool>& stop);

Json method_json(const Scene& scene, const Side& side);

/// Writes the manifest `name` with the hashes of the complete files. Throws Error (exit 4).
void write_manifest(Transaction& parts, const std::string& name, const Scene& scene, const RunRecord& record);

/// A tile of a contact sheet: only the pendulums, and their time.
Scene tile_scene(Scene scene);
DisplayList tile_of(const Scene& tile, const Composer& composer, double time);
/// One picture with frames from first … last − 1 of a recording, as many as the preset sets, in rows below a title.
Picture contact_sheet_of(const Scene& scene, Recording& recording, long first, long last, Gl gl,
                         const std::atomic<bool>& stop);

/// The number of frames of each part of a film, in order. The frames of the motion are those of FrameTimes.
struct Schedule {
    long title = 0, hold_start = 0, motion = 0, hold_end = 0, end = 0;

    long frames() const { return before() + motion + hold_end + end; }
    /// The number of frames before frame 1 of the motion, without its frame 0.
    long before() const { return title + hold_start; }
    /// The first frame of the film that shows a frame of the motion without a card.
    long at(long frame) const { return frame == 0 ? title : before() + frame; }
    /// The frames of the film that belong to the frames first … last − 1 of the motion.
    FrameRange range(long first, long last) const {
        return {first == 0 ? 0 : before() + first, last == motion ? frames() : before() + last};
    }
};

Schedule schedule_of(const Scene& scene);

/// The frames of the film that a run draws: those of its part, or all from frame `first` of the motion on.
FrameRange drawn_frames(const Scene& scene, const RunOptions& options, long first);

/// The opacity of a card on frame `k` of `count`. A fade takes half a second, but at most half of the frames.
double card_opacity(long k, long count, double fps, bool fades_in);

/// Draws a composer's frames; with the alpha of each pixel if the film is transparent.
class Canvas {
public:
    /// Throws Error: exit 4 if there is no OpenGL, or as Renderer does.
    Canvas(const Scene& scene, const Composer& composer, Gl gl, const std::atomic<bool>& stop);

    const Picture& draw(const DisplayList& list);
    const std::vector<Rect>& changed() const { return changed_; }
    std::string description() const { return renderer_->description(); }

private:
    const std::atomic<bool>& stop_;
    std::optional<Renderer> renderer_, on_white_;  // for alpha: the same picture on white, and both combined
    Picture matted_;
    std::vector<Rect> changed_;
};

/// Draws the frames of a run, passes them to the video or picture sequence, and keeps the poster.
class Film {
public:
    /// Shows the frames first … last − 1 of the motion, and adds the film's files to `parts`. All functions may throw
    /// Error (exit 130) soon after `stop` is set.
    Film(const Scene& scene, const MotionBounds& bounds, const RunOptions& options, long first, long last,
         Transaction& parts, RunRecord& record, const std::atomic<bool>& stop);

    /// Adds a snapshot; all samples and frames from 0 on are required. If it is the next frame, writes it with its
    /// cards, and returns true.
    bool add(const Snapshot& snapshot);

    /// Completes the film, with these events as chapters, and writes the poster.
    void finish(const std::vector<FilmEvent>& events);
    /// Writes another picture, "NAME.ENDING".
    void write(const std::string& ending, const Picture& picture) const;

private:
    void begin_pictures();
    void begin_video();
    void join_parts();
    void pack_pictures();
    DisplayList list_of(long number) const;
    const Picture& take(const DisplayList& list);

    const Scene& scene_;
    const RunOptions& options_;
    Transaction& parts_;
    RunRecord& record_;
    const std::atomic<bool>& stop_;
    const Schedule schedule_;
    const FrameRange drawn_;  // frames are counted in the whole film
    long next_;
    long frame_, last_;  // of the motion
    long poster_at_ = -1;
    Composer composer_;
    const Metadata metadata_ = metadata_of(scene_.preset.title, scene_.preset.name);
    std::string film_name_;         // name of the video, or of the folder of pictures
    std::filesystem::path folder_;  // of the pictures
    std::unique_ptr<Sink> sink_;
    std::optional<Canvas> canvas_;
    std::optional<Picture> poster_;
};

/// The number of the poster's frame, nearest to the poster's time, if the film has a poster.
std::optional<long> poster_frame(const Scene& scene);

VideoOptions video_options(const Scene& scene);

}  // namespace doppel
