#include "film/recording.hpp"

#include "base/embedded.hpp"
#include "base/error.hpp"
#include "base/machine.hpp"
#include "film/layout.hpp"
#include "film/strips.hpp"
#include "integrate/motion_batch.hpp"
#include "output/written.hpp"
#include "scene/resolved.hpp"

#include <utility>

namespace doppel {
namespace {

void add(SideRecord& record, const SideState& seen) {
    record.energy_error = std::max(record.energy_error, std::abs(seen.energy_error.value_or(0)));
    if (seen.energy_error) record.energy_change = std::max(record.energy_change, std::abs(seen.energy_change));
    record.length_error = std::max(record.length_error, seen.length_error);
}

/// The keys on which the snapshots depend: all except those of the picture and of the table.
std::string key_of(const Scene& scene) {
    auto preset = scene.preset;
    preset.title.clear();
    preset.subtitle.reset();
    preset.energy_columns = preset.member_columns = false;
    for (auto* side : {&preset.a, &preset.b}) side->label = side->note = std::nullopt;
    const auto video = std::exchange(preset.video, {});
    if (!scene.members.empty()) preset.video.layout = video.layout;
    preset.video.members = video.members;
    preset.video.fps = video.fps;
    preset.video.speed = video.speed;
    preset.video.speed_ease_s = video.speed_ease_s;
    return sha256_of_text(resolved_toml(preset));
}

/// Writes or reads all numbers.
void pass_all(BlockFile& all, Snapshot& snapshot, Effort& a, Effort& b) {
    auto& pair = snapshot.pair;
    all(pair.sample, pair.share, pair.distance, a, b, snapshot.members);
    for (auto* seen : {&pair.a, &pair.b}) {
        all(seen->bobs, seen->exact, seen->pivot, seen->tension, seen->energy, seen->kinetic_energy);
        all(seen->work, seen->energy_change, seen->length_error, seen->energy_error, seen->mean_energy);
    }
}

/// The snapshot of this moment in a file; earlier ones are left out. Sets the effort in `record`.
Snapshot read_snapshot(BlockFile& recording, const Moment& moment, MotionRecord& record) {
    Snapshot snapshot;
    while (recording.next()) {
        pass_all(recording, snapshot, record.a.effort, record.b.effort);
        if (snapshot.pair.moment() == moment) return snapshot;
        if (moment < snapshot.pair.moment()) break;
    }
    throw recording.damaged();
}

}  // namespace

void Spread::add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
    if (!(value > 0) || !std::isfinite(value)) return;
    minimum = std::min(minimum, value);
    maximum = std::max(maximum, value);
    log_sum += std::log(value);
    ++count;
}

void MotionBounds::add(double x, double y, double radius) {
    left = std::min(left, x - radius);
    right = std::max(right, x + radius);
    bottom = std::min(bottom, y - radius);
    top = std::max(top, y + radius);
}

void MotionBounds::add(const Scene& scene, const PairState& state, double start_distance) {
    const auto& video = scene.preset.video;
    const auto link = static_cast<std::size_t>(video.phase_link - 1);
    for (const auto* side : {&state.a, &state.b}) {
        for (const auto& bob : side->bobs) add(bob.x, bob.y);
        if (link < side->bobs.size()) fastest = std::max(fastest, std::abs(side->bobs[link].omega));
    }
    distance[static_cast<std::size_t>(state.sample) * distance.size() / static_cast<std::size_t>(scene.samples + 1)]
        .add(state.distance);
    for (const auto kind : video.strips) {
        // a pair that starts equal has distances near zero at first; they are left out
        if (kind == StripKind::distance && !(start_distance > 0) && 50 * state.sample < scene.samples &&
            !(state.distance >= Divergence::max_start_distance))
            continue;
        for (const auto& curve : strip_curves(kind, scene, state, start_distance))
            if (curve.value) strips[static_cast<std::size_t>(kind)].add(*curve.value);
    }
}

void Outcome::add(const Scene& scene, const PairState& state) {
    const double time = scene.time(state.sample);
    if (state.sample == 0) start_distance = state.distance;
    largest_distance = std::max(largest_distance, state.distance);
    divergence.add(time, state.distance);
    constexpr std::size_t most_links = 3;
    std::size_t at = 0;
    for (const char letter : scene.letters()) {
        const auto& bobs = (letter == 'a' ? state.a : state.b).bobs;
        if (!scene.side(letter).has_angles || bobs.size() > most_links) continue;
        for (std::size_t link = 0; link < bobs.size(); ++link, ++at) {
            const double now = std::round(bobs[link].theta / (2 * pi));
            if (at == turns.size()) turns.push_back(now);
            if (now != std::exchange(turns[at], now)) flips.push_back({time, letter, link + 1});
        }
    }
}

Snapshot blank_snapshot(const Scene& scene) {
    Snapshot blank;
    for (const auto& [seen, side] : {std::pair{&blank.pair.a, &scene.a}, {&blank.pair.b, &scene.b}}) {
        seen->bobs.resize(side->mass.size());
        seen->tension.resize(side->mass.size());
    }
    blank.members.resize(scene.members.size(), blank.pair.a.bobs);
    return blank;
}

Recording::Recording(const Scene& scene, const Moment& end, bool with_pictures, const std::atomic<bool>& stop,
                     std::filesystem::path file, double max_bytes)
    : scene_(scene), end_(end), with_pictures_(with_pictures), stop_(stop), file_(std::move(file)) {
    const bool is_bounded = with_pictures && depends_on_motion(scene);
    is_kept_ =
        with_pictures && (is_bounded || scene.preset.video.contact_sheet) && recorded_bytes(scene, end) <= max_bytes;
    if (!is_bounded && !is_kept_) return;
    try {
        simulate(is_bounded, [&](const Snapshot& snapshot) {
            if (is_kept_) kept_.push_back(snapshot);
        });
    } catch (const Error& error) {
        if (error.code() == ExitCode::interrupted) throw;
        error_ = std::current_exception();
    }
}

double recorded_bytes(const Scene& scene, const Moment& end) {
    const auto bobs = static_cast<double>(scene.a.mass.size() + scene.b.mass.size());
    const auto is_quad = [](const Side& side) { return side.motion.precision == Precision::in_quad; };
    double one = sizeof(Snapshot) + bobs * (sizeof(Bob<double>) + sizeof(double));
    if (is_quad(scene.a) || is_quad(scene.b)) one += bobs * sizeof(Bob<Quad>);
    one += static_cast<double>(scene.members.size()) *
           static_cast<double>(sizeof(Bobs<double>) + scene.a.mass.size() * sizeof(Bob<double>));
    return one * static_cast<double>(end.sample + scene.frames.first_from(end));
}

void Recording::play(const Visit& visit) {
    if (!is_kept_) return simulate(false, visit);
    for (const auto& snapshot : kept_) visit(snapshot);
    if (error_) std::rethrow_exception(error_);
}

/// If the motion is bounded, goes on to its end after the required snapshots.
void Recording::simulate(bool is_bounded, const Visit& visit) {
    record_ = {};
    std::optional<BlockFile> file;
    std::optional<PairRun> pair;
    std::optional<MotionBatch> members;
    if (file_.empty())
        pair.emplace(scene_);
    else if (file.emplace(file_, recording_file).header() != recording_header(scene_))
        throw bad_input(
            "{} is a recording of another motion, frame rate or version of Doppel; make it again, with the same --set: "
            "doppel simulate {} --recording {}",
            file_.string(), scene_.preset.name, file_.string());
    const bool has_members = (with_pictures_ || scene_.preset.member_columns) && !scene_.members.empty();
    if (pair && has_members && (is_kept_ || !is_bounded)) members.emplace(scene_.members, 1);
    const auto snapshot_at = [&](const Moment& moment, MotionRecord& record) {
        throw_if_set(stop_);
        if (file) return read_snapshot(*file, moment, record);
        const bool is_sample = moment.share == 0;
        Snapshot snapshot{is_sample ? pair->next(stop_) : pair->advance_to(moment, stop_), {}};
        record.a.effort = pair->effort_a();
        record.b.effort = pair->effort_b();
        if (!members) return snapshot;
        if (!is_sample)
            members->advance_within(moment.share, stop_);
        else if (moment.sample > 0)
            members->advance(stop_);
        for (std::size_t k = 0; k < members->size(); ++k) snapshot.members.push_back(members->bobs(k));
        return snapshot;
    };
    // CPU time of this thread and of those of the simulation
    const auto spent_s = [&] { return seconds_of(CLOCK_THREAD_CPUTIME_ID) + (pair ? pair->other_cpu_s() : 0); };
    double begun = spent_s();
    const auto add_bounds = [&](const PairState& state) {
        if (is_bounded) bounds_.add(scene_, state, record_.outcome.start_distance);
    };
    const auto take = [&](const Moment& moment) {
        const auto snapshot = snapshot_at(moment, record_);
        const auto& state = snapshot.pair;
        check_distance(scene_, state);
        if (state.share == 0) {
            add(record_.a, state.a);
            add(record_.b, state.b);
            record_.outcome.add(scene_, state);
            add_bounds(state);
        }
        cpu_s_ += spent_s() - begun;
        visit(snapshot);
        begun = spent_s();
    };
    const auto& frames = scene_.frames;
    long frame = 0;
    Moment sample;
    for (; sample < end_; ++sample.sample) {
        take(sample);
        for (; with_pictures_ && frame < frames.count && frames.at(frame) < std::min(end_, {sample.sample + 1});
             ++frame)
            if (const auto moment = frames.at(frame); moment.share > 0) take(moment);
    }
    MotionRecord beyond;
    try {
        for (; is_bounded && sample.sample <= scene_.samples; ++sample.sample)
            add_bounds(snapshot_at(sample, beyond).pair);
    } catch (const RunFailure&) {  // the required part is complete
    }
    cpu_s_ += spent_s() - begun;
}

std::string recording_header(const Scene& scene) {
    return fmt::format(R"({},"preset":{},"version":"{}","revision":"{}","motion_sha256":"{}"}})", recording_file.start,
                       Json(scene.preset.name).dump(), version(), revision(), key_of(scene));
}

void add_snapshot(BlockFile& recording, Snapshot snapshot, Effort a, Effort b) {
    pass_all(recording, snapshot, a, b);
    recording.end_block();
}

}  // namespace doppel
