#include "base/error.hpp"
#include "track/regression.hpp"
#include "track/track.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace doppel {
namespace {

constexpr std::size_t least_samples = 100, least_of_piece = 12;
constexpr double least_s = 1.5, least_of_piece_s = 0.25;

/// How far each sample is from the cubic through two neighbours on either side.
std::vector<double> residuals_of_cubics(const TrackPiece& piece, std::size_t arm) {
    const auto &t = piece.time_s, &x = piece.angle[arm];
    std::vector<double> residuals(x.size(), 0);
    for (std::size_t i = 2; i + 2 < x.size(); ++i) {
        residuals[i] = x[i];
        for (const auto k : {i - 2, i - 1, i + 1, i + 2}) {
            double weight = 1;
            for (const auto other : {i - 2, i - 1, i + 1, i + 2})
                if (other != k) weight *= (t[i] - t[other]) / (t[k] - t[other]);
            residuals[i] -= weight * x[k];
        }
    }
    return residuals;
}

/// The noise, and samples that stand out of it alone: their neighbours deviate the other way.
void find_noise(Track& track, const std::atomic<bool>& stop) {
    constexpr double far = 12, of_cubic = 1.39;  // the deviation of noise of 1 from a cubic of the same noise
    for (std::size_t arm = 0; arm < 2; ++arm) {
        std::vector<double> all;
        std::vector<std::vector<double>> of_pieces;
        for (const auto& piece : track.pieces) {
            throw_if_set(stop);
            const auto& r = of_pieces.emplace_back(residuals_of_cubics(piece, arm));
            all.insert(all.end(), r.begin() + 2, r.end() - 2);
        }
        const double size = 1.4826 * median_size(std::move(all));
        track.noise[arm] = size / of_cubic;
        for (std::size_t k = 0; k < track.pieces.size(); ++k)
            for (std::size_t i = 2; i + 2 < of_pieces[k].size(); ++i) {
                const double before = of_pieces[k][i - 1], r = of_pieces[k][i], after = of_pieces[k][i + 1];
                const bool is_peak = std::abs(r) > std::max(std::abs(before), std::abs(after));
                if (std::abs(r) > far * size && size > 0 && is_peak && r * before <= 0 && r * after <= 0)
                    track.pieces[k].is_outlier[arm][i] = 1;
            }
    }
}

bool is_short(const TrackPiece& piece) {
    return piece.size() < least_of_piece || piece.duration() < least_of_piece_s;
}

/// Leaves out fragments between gaps; a whole file that is too short is left, to be refused.
void drop_fragments(Track& track) {
    std::map<std::string, std::size_t> of_file;
    for (const auto& piece : track.pieces) ++of_file[piece.name];
    const auto dropped = std::erase_if(track.pieces, [&](const TrackPiece& piece) {
        auto& left = of_file[piece.name];
        return is_short(piece) && left > 1 && left-- > 0;
    });
    if (dropped > 0)
        track.notes.push_back(fmt::format("{} stretches between gaps, of less than {} samples or {} s, were left out",
                                          dropped, least_of_piece, least_of_piece_s));
}

/// Where the pieces are on one clock, if their times never go back.
void find_clock(Track& track) {
    for (std::size_t k = 0; k < track.pieces.size(); ++k) {
        const auto& times = track.pieces[k].time_s;
        if (k > 0 && times.front() <= track.pieces[k - 1].time_s.back()) return track.start_s.clear();
        track.start_s.push_back(times.front() - track.pieces[0].time_s[0]);
    }
}

void demand_length(const Track& track) {
    for (const auto& piece : track.pieces)
        if (is_short(piece))
            throw bad_input(
                "{}: the piece from {} s on is too short: {} samples in {:.3g} s; at least {} in {} s are wanted",
                piece.name, piece.time_s.front(), piece.size(), piece.duration(), least_of_piece, least_of_piece_s);
    if (track.samples() < least_samples || track.duration() < least_s)
        throw bad_input(
            "{}: the track is too short: {} samples in {:.3g} s; at least {} in {} s are wanted, some swings "
            "of both arms",
            track.pieces.front().name, track.samples(), track.duration(), least_samples, least_s);
}

void demand_motion(const Track& track) {
    constexpr double least = 0.05;  // rad
    const auto& name = track.pieces.front().name;
    for (std::size_t arm = 0; arm < 2; ++arm) {
        double most = 0;
        for (const auto& piece : track.pieces) {
            const auto [low, high] = std::ranges::minmax(piece.angle[arm]);
            most = std::max(most, high - low);
        }
        if (most < std::max(least, 20 * track.noise[arm]))
            throw bad_input(
                "{}: theta{} {}: it moves by {:.2g} rad with a noise of {:.2g} rad, which tells no model; "
                "at least {} rad and 20 times the noise are wanted",
                name, arm + 1, most < least ? "is flat" : "is mostly noise", most, track.noise[arm], least);
    }
    if (std::ranges::all_of(track.pieces, [](const auto& piece) { return piece.angle[0] == piece.angle[1]; }))
        throw bad_input("{}: theta1_rad and theta2_rad are the same numbers: one arm only", name);
}

/// Another way to take the columns.
struct Reading {
    double unit = 1;  // of the angles, rad
    bool relative = false, mirrored = false;
    std::array<int, 2> quarters{};  // of a turn to subtract

    /// Takes both arms' angles so; or what they change by, which does not begin anywhere.
    void take(double& first, double& second, bool are_angles) const {
        const double quarter = are_angles ? std::numbers::pi / 2 : 0, shift = quarters[0] * quarter;
        first *= unit, second *= mirrored ? -unit : unit;
        if (relative) second += first;
        first -= shift, second -= quarters[1] * quarter;
        if (relative) second -= shift;
    }
};

double unexplained(const std::vector<Glimpse>& glimpses, const Reading& reading) {
    auto taken = glimpses;
    for (auto& [one, two] : taken) {
        reading.take(one.angle, two.angle, true);
        reading.take(one.rate, two.rate, false);
        reading.take(one.acceleration, two.acceleration, false);
    }
    const auto result = regress(taken);
    return result.is_physical ? result.unexplained : 1;
}

void convert(Track& track, const Reading& reading) {
    std::vector<std::string> words;
    if (reading.mirrored) words.push_back("theta2 counted the other way round");
    if (reading.relative) words.push_back("theta2 counted from the first arm");
    for (std::size_t arm = 0; arm < 2; ++arm)
        if (const int degrees = 90 * reading.quarters[arm]; degrees != 0)
            words.push_back(fmt::format("theta{} counted from {}° off the downward vertical", arm + 1, degrees));
    track.notes.push_back(
        fmt::format("only so do the angles obey a double pendulum's equations, and so they were taken: {}",
                    fmt::join(words, "; ")));
    for (auto& piece : track.pieces)
        for (std::size_t i = 0; i < piece.size(); ++i) reading.take(piece.angle[0][i], piece.angle[1][i], true);
}

/// Where the angles taken as they are obey no double pendulum's equations, but do when taken in another way: refuses
/// what is a mistake, and takes so what is a convention.
void check_convention(Track& track, const std::atomic<bool>& stop) {
    constexpr double well = 0.003, obeys = 0.1, much_better = 0.3, degree = std::numbers::pi / 180;
    const auto glimpses = glimpses_of(track, stop);
    const double as_it_is = unexplained(glimpses, {});
    if (as_it_is < well) return;
    std::array<double, 2> low{track.pieces[0].angle[0][0], track.pieces[0].angle[1][0]}, high = low;
    for (const auto& piece : track.pieces)
        for (std::size_t arm = 0; arm < 2; ++arm)
            for (const double angle : piece.angle[arm])
                low[arm] = std::min(low[arm], angle), high[arm] = std::max(high[arm], angle);
    const double widest = std::max(high[0] - low[0], high[1] - low[1]);
    Reading best;
    double least = as_it_is;
    const auto consider = [&](const Reading& reading) {
        throw_if_set(stop);
        if (const double value = unexplained(glimpses, reading); value < least) least = value, best = reading;
    };
    constexpr double small = 4;  // rad: of degrees, a motion so small is linear, and any such fits
    if (widest > small) consider({.unit = degree});
    for (int way = 0; way < 64; ++way)
        consider({.relative = way >= 32, .mirrored = way / 16 % 2 == 1, .quarters = {way / 4 % 4 - 1, way % 4 - 1}});
    const auto& name = track.pieces.front().name;
    const bool is_better = least <= std::min(obeys, much_better * as_it_is);
    if (is_better && best.unit == 1) return convert(track, best);
    if (is_better)
        throw bad_input(
            "{}: the angles are in degrees; radians are wanted (degrees × π/180): taken so, {:.0f} % of the forces are "
            "unexplained, else {:.0f} %",
            name, 100 * least, 100 * as_it_is);
    constexpr double most_turns = 60;             // rad: ten turns and a half
    if (as_it_is > obeys && widest > most_turns)  // else the fit will tell
        throw bad_input(
            "{}: the angles go from {:.3g} to {:.3g}, and obey no double pendulum's equations: are they in degrees? "
            "Radians are wanted (degrees × π/180)",
            name, low[0], high[0]);
}

}  // namespace

double median_size(std::vector<double> values) {
    for (auto& value : values) value = std::abs(value);
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

void check_track(Track& track, const std::atomic<bool>& stop) {
    drop_fragments(track);
    find_clock(track);
    demand_length(track);
    find_noise(track, stop);
    demand_motion(track);
    if (const auto outliers = track.outliers(), all = 2 * track.samples(); outliers > 0) {
        const auto words = fmt::format("{} of {} angles are far off their neighbours", outliers, all);
        if (10 * outliers > all) throw bad_input("{}: {}; a track is wanted", track.pieces.front().name, words);
        track.notes.push_back(words + ", and were left out");
    }
    check_convention(track, stop);
}

}  // namespace doppel
