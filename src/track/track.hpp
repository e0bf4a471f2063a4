#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace doppel {

/// Samples of both angles without a long gap.
struct TrackPiece {
    std::string name;                             // of the file, and which part of it
    std::vector<double> time_s;                   // ascending, as in the file
    std::array<std::vector<double>, 2> angle;     // rad, from the downward vertical, without jumps by whole turns
    std::array<std::vector<char>, 2> is_outlier;  // by link and sample: far off its neighbours, left out of the fit

    std::size_t size() const { return time_s.size(); }
    double duration() const { return time_s.back() - time_s.front(); }
};

/// A measured swing.
struct Track {
    std::vector<TrackPiece> pieces;  // in the order of time
    std::vector<double> start_s;     // of each piece on one clock; empty where that is not known
    std::array<double, 2> noise{};   // rms of each angle's noise from sample to sample, rad
    std::vector<std::string> notes;  // sentences on how the input was taken
    std::size_t samples() const;
    std::size_t outliers() const;
    double duration() const;  // s, of all pieces together
};

inline constexpr std::atomic<bool> not_stopped = false;  // for what nobody stops

/// Reads CSV files with a heading: time_s and theta1_rad, theta2_rad, or x0_px, y0_px, x1_px, y1_px, x2_px, y2_px
/// (pivot, joint, end; y down); other columns are left alone. A gap of more than a fifth of a second begins a new
/// piece, as does every file, and a new number in a column "piece". Pieces are on one clock where their times never go
/// back; else they are taken to follow one another in the order given.
///
/// Throws Error: exit 2 where there is no such file, or where it cannot be a track (named: file, line, value, and what
/// would be right), exit 4 where it cannot be read, 130 soon after `stop` is set.
Track read_tracks(const std::vector<std::filesystem::path>& files, const std::atomic<bool>& stop = not_stopped);

/// All of a file. Throws Error as read_tracks() does.
std::string text_of_track(const std::filesystem::path& file);

/// The same of texts, `names` for messages.
Track tracks_of_texts(const std::vector<std::string>& names, const std::vector<std::string>& texts,
                      const std::atomic<bool>& stop = not_stopped);

/// Throws Error (exit 2) where a track is too short, too coarse or moves too little to tell a model. Finds outliers and
/// the noise.
void check_track(Track& track, const std::atomic<bool>& stop);

/// The median of absolute values.
double median_size(std::vector<double> values);

}  // namespace doppel
