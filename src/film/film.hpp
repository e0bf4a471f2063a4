#pragma once

#include "film/composer.hpp"
#include "film/contact_sheet.hpp"
#include "film/manifest.hpp"
#include "film/run.hpp"
#include "integrate/motion_batch.hpp"
#include "output/sink.hpp"
#include "output/transaction.hpp"
#include "output/workers.hpp"
#include "render/renderer.hpp"
#include "scene/scene.hpp"

#include <atomic>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace doppel {

/// How many frames a film has of each kind, in their order; those of the motion show samples 0, samples_per_frame …
struct Schedule {
    long title = 0, hold_start = 0, motion = 0, hold_end = 0, end = 0;

    long frames() const { return title + hold_start + motion + hold_end + end; }
};

Schedule schedule_of(const Scene& scene);

/// How opaque a card is on frame `k` of `count`: the last (or first, where it comes up) half second is a fade, but
/// never more than half of the card.
double card_opacity(long k, long count, double fps, bool fades_in);

/// Draws the frames of a run and hands them to the video or the sequence; keeps the poster and the contact sheet.
class Film {
public:
    /// For the samples options.first … options.last − 1. Adds its files to `parts`. All may throw Error (exit 130) soon
    /// after `stop` is set.
    Film(const Scene& scene, const RunOptions& options, Transaction& parts, RunRecord& record,
         const std::atomic<bool>& stop);

    /// Every sample, from 0 on.
    void add(const Snapshot& snapshot) {
        sample_ = snapshot.pair.sample;
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
    void keep(const Picture& picture);
    const Picture& drawn(const DisplayList& list);

    const Scene& scene_;
    Schedule schedule_;
    Composer composer_;
    Transaction& parts_;
    std::string film_name_;  // of the video, or the folder of pictures
    const std::atomic<bool>& stop_;
    long sample_ = 0;                     // added last
    std::atomic<long> first_number_ = 0;  // of the first picture; compressor threads ask
    std::unique_ptr<Sink> sink_;
    std::optional<Renderer> renderer_;
    // with opacity: the same on white, and the two as one
    std::optional<Renderer> on_white_;
    Picture matted_;
    std::vector<Rect> changed_;
    std::optional<Picture> poster_;
    std::optional<ContactSheet> sheet_;
};

/// The sample that the poster shows, where there is one.
std::optional<long> poster_sample(const Scene& scene);

/// How the video file of a scene is written.
VideoOptions video_options(const Scene& scene);

/// Steps the pair, and an ensemble's members, in a thread of its own, a bounded number of snapshots ahead.
class Simulation {
public:
    /// Snapshots 0 … last − 1. The members of an ensemble are stepped where `with_members`. Throws Error (exit 4) where
    /// there is no thread to be had.
    Simulation(const Scene& scene, long last, bool with_members, const std::atomic<bool>& stop);
    ~Simulation() { ahead_.close(); }
    Simulation(const Simulation&) = delete;
    Simulation& operator=(const Simulation&) = delete;

    /// The next snapshot; rethrows what stopped the simulation.
    Snapshot next();

    /// CPU time of the thread, s, and what the sides have cost; complete once the last snapshot was taken.
    double cpu_s() const { return cpu_s_; }
    std::pair<Effort, Effort> efforts();

private:
    void work(const Scene& scene, long last, bool with_members, const std::atomic<bool>& stop);

    Queue<Snapshot> ahead_;
    std::exception_ptr fault_;
    std::atomic<double> cpu_s_ = 0;
    std::mutex mutex_;
    std::pair<Effort, Effort> efforts_;
    std::jthread thread_;  // last: it uses all the rest
};

}  // namespace doppel
