#pragma once

#include "film/composer.hpp"
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

/// What the manifest says of a run besides the scene.
struct RunRecord : RunResult {
    long first_sample = 0, last_sample = 0;                      // in the table, both included
    std::string gl, libav;                                       // empty where no pictures were made
    double simulate_cpu_s = 0, draw_cpu_s = 0, write_cpu_s = 0;  // by the threads' clocks; write = convert, hand over
    double encode_cpu_s = 0;  // the rest of the process: encoder or compressor threads
    double cpu_s = 0;
    MotionRecord motion;
    std::string failure;  // what ended the run, where something did
};

/// Adds to the warnings: sides whose energy changed by more than 1 % of the potential range though their mechanics keep
/// it, and from when on they are off by half a rad, where that is found in about the time that the run took.
void add_warnings(const Scene& scene, RunRecord& record, const std::atomic<bool>& stop);

/// The model and method of a side, as manifests and `check --json` have it.
Json method_json(const Scene& scene, const Side& side);

/// Writes the manifest `name`; hashes the files that are finished. Throws Error (exit 4).
void write_manifest(Transaction& parts, const std::string& name, const Scene& scene, const RunRecord& record);

/// Frames first … last − 1 of a recording in one picture, as many as the preset wants: pendulums and time alone, in rows,
/// and one title above. Throws as Composer and Renderer do.
Picture contact_sheet_of(const Scene& scene, Recording& recording, long first, long last, Gl gl,
                         const std::atomic<bool>& stop);

/// How many frames a film has of each kind, in their order; those of the motion show what FrameTimes says
struct Schedule {
    long title = 0, hold_start = 0, motion = 0, hold_end = 0, end = 0;

    long frames() const { return title + hold_start + motion + hold_end + end; }
};

Schedule schedule_of(const Scene& scene);

/// How opaque a card is on frame `k` of `count`: the last (or first, where it comes up) half second is a fade, but
/// never more than half of the card.
double card_opacity(long k, long count, double fps, bool fades_in);

/// Draws a composer's frames; with the opacity of each pixel where the film is transparent.
class Canvas {
public:
    /// Throws Error: exit 4 where nothing can draw, or as Renderer does.
    Canvas(const Scene& scene, const Composer& composer, Gl gl, const std::atomic<bool>& stop);

    const Picture& draw(const DisplayList& list);
    /// Where the picture drawn last differs from the one before.
    const std::vector<Rect>& changed() const { return changed_; }
    /// What draws.
    std::string description() const { return renderer_->description(); }

private:
    const std::atomic<bool>& stop_;
    std::optional<Renderer> renderer_, on_white_;  // with opacity: the same on white, and the two as one
    Picture matted_;
    std::vector<Rect> changed_;
};

/// Draws the frames of a run and hands them to the video or the sequence; keeps the poster.
class Film {
public:
    /// From frame `first` on. Adds its files to `parts`. All may throw Error (exit 130) soon after `stop` is set.
    Film(const Scene& scene, const MotionBounds& bounds, const RunOptions& options, long first, Transaction& parts,
         RunRecord& record, const std::atomic<bool>& stop);

    /// Every sample and frame, from 0 on.
    void add(const Snapshot& snapshot) { composer_.add(snapshot); }

    /// The snapshot added last becomes frame `number`; before the first of all comes the title, after the last the end.
    void write_frame(long number);

    /// The film is whole; writes the poster.
    void finish();
    /// Writes a further picture, "NAME.ENDING".
    void write(const std::string& ending, const Picture& picture) const;

private:
    const Picture& take(const DisplayList& list);
    void take_card(long frames, bool fades_in);

    const Scene& scene_;
    Transaction& parts_;
    RunRecord& record_;
    const std::atomic<bool>& stop_;
    const Schedule schedule_;
    Composer composer_;
    std::string film_name_;  // of the video, or the folder of pictures
    std::unique_ptr<Sink> sink_;
    std::optional<Canvas> canvas_;
    std::optional<Picture> poster_;
};

/// The frame that is the poster, where there is one: that nearest to its time.
std::optional<long> poster_frame(const Scene& scene);

/// How the video file of a scene is written.
VideoOptions video_options(const Scene& scene);

}  // namespace doppel
