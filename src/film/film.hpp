#pragma once

#include "film/composer.hpp"
#include "film/layer.hpp"
#include "film/run.hpp"
#include "integrate/motion_batch.hpp"
#include "output/sink.hpp"
#include "output/transaction.hpp"
#include "output/workers.hpp"
#include "render/renderer.hpp"
#include "scene/resolved.hpp"
#include "scene/scene.hpp"

#include <atomic>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace doppel {

/// A side's largest errors, and its cost.
struct SideRecord {
    double energy_error = 0;   // relative to the energy at the start, however close to zero that is
    double energy_change = 0;  // J
    double length_error = 0;   // m
    Effort effort;
};

/// What the manifest says of a run besides the scene.
struct RunRecord {
    long first_sample = 0, last_sample = 0;  // in the table, both included
    long frames = 0;
    std::string gl, libav;                                       // empty where no pictures were made
    double simulate_cpu_s = 0, draw_cpu_s = 0, write_cpu_s = 0;  // by the threads' clocks; write = convert, hand over
    double encode_cpu_s = 0;  // the rest of the process: encoder or compressor threads
    double wall_s = 0, cpu_s = 0;
    SideRecord a, b;
    double largest_distance = 0;
    Parting parting;
    std::string failure;                // what ended the run, where something did
    std::vector<std::string> warnings;  // sentences for the one who reads the results
};

/// Adds to the warnings: sides whose energy changed by more than 1 % of the potential range though their mechanics keep
/// it, and from when on they are off by half a rad, where that is found in about the time that the run took.
void add_warnings(const Scene& scene, RunRecord& record, const std::atomic<bool>& stop);

/// The model and method of a side, as manifests and `check --json` have it.
Json method_json(const Scene& scene, const Side& side);

/// Writes the manifest `name`; hashes the files that are finished. Throws Error (exit 4).
void write_manifest(Transaction& parts, const std::string& name, const Scene& scene, const RunRecord& record);

/// Many moments of a film in one picture: pendulums and time alone, in rows, and one title above.
class ContactSheet {
public:
    /// `moments` in ascending order, one a tile. Throws as Composer and Renderer do.
    ContactSheet(const Scene& scene, std::vector<Moment> moments, Gl gl, const std::atomic<bool>& stop);
    ContactSheet(const ContactSheet&) = delete;
    ContactSheet& operator=(const ContactSheet&) = delete;

    /// As Composer::add().
    void add(const Snapshot& snapshot);

    /// Of the tiles so far, one at least.
    Picture picture() const;

private:
    const Scene scene_;  // of a tile
    Composer composer_;
    Renderer renderer_;
    std::vector<Moment> moments_;
    std::vector<Picture> tiles_;
    int columns_;
    Gl gl_;
    const std::atomic<bool>& stop_;
};

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

/// Draws the frames of a run and hands them to the video or the sequence; keeps the poster and the contact sheet.
class Film {
public:
    /// For the frames first … last − 1. Adds its files to `parts`. All may throw Error (exit 130) soon after `stop` is set.
    Film(const Scene& scene, const RunOptions& options, long first, long last, Transaction& parts, RunRecord& record,
         const std::atomic<bool>& stop);

    /// Every sample and frame, from 0 on.
    void add(const Snapshot& snapshot) {
        moment_ = snapshot.pair.moment();
        composer_.add(snapshot);
        if (sheet_) sheet_->add(snapshot);
    }

    /// The snapshot added last becomes a frame; before the first of all comes the title, after the last the end.
    void write_frame(RunRecord& record);

    /// The film is whole; writes what was kept.
    void finish();

private:
    const Picture& take(const DisplayList& list, RunRecord& record);
    void take_card(long frames, bool fades_in, RunRecord& record);
    const Scene& scene_;
    Schedule schedule_;
    Composer composer_;
    Transaction& parts_;
    std::string film_name_;  // of the video, or the folder of pictures
    const std::atomic<bool>& stop_;
    Moment moment_;                       // added last
    std::atomic<long> first_number_ = 0;  // of the first picture; compressor threads ask
    std::unique_ptr<Sink> sink_;
    std::optional<Canvas> canvas_;
    std::optional<Picture> poster_;
    std::optional<ContactSheet> sheet_;
};

/// The frame that is the poster, where there is one: that nearest to its time.
std::optional<long> poster_frame(const Scene& scene);

/// How the video file of a scene is written.
VideoOptions video_options(const Scene& scene);

/// Steps the pair, and an ensemble's members, in a thread of its own, a bounded number of snapshots ahead.
class Simulation {
public:
    /// The samples before `end` and, `with_pictures`, the frames between them; the members of an ensemble, too. Throws Error
    /// (exit 4) where there is no thread to be had.
    Simulation(const Scene& scene, const Moment& end, bool with_pictures, const std::atomic<bool>& stop);
    ~Simulation() { ahead_.close(); }
    Simulation(const Simulation&) = delete;
    Simulation& operator=(const Simulation&) = delete;

    /// The next snapshot; nothing at the end. Rethrows what stopped the simulation.
    std::optional<Snapshot> next();

    /// CPU time of the thread, s, and what the sides have cost; complete once the last snapshot was taken.
    double cpu_s() const { return cpu_s_; }
    std::pair<Effort, Effort> efforts();

private:
    void work(const Scene& scene, const Moment& end, bool with_pictures, const std::atomic<bool>& stop);
    void simulate(const Scene& scene, const Moment& end, bool with_pictures, const std::atomic<bool>& stop);

    Queue<Snapshot> ahead_;
    std::exception_ptr fault_;
    std::atomic<double> cpu_s_ = 0;
    std::mutex mutex_;
    std::pair<Effort, Effort> efforts_;
    std::jthread thread_;  // last: it uses all the rest
};

}  // namespace doppel
