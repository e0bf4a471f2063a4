#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace doppel {

/// Samples of both angles without long gaps.
struct TrackPiece {
    std::string name;                          // of the file, and the number of the part
    std::vector<double> time_s;                // ascending, as in the file
    std::array<std::vector<double>, 2> angle;  // rad, from the downward vertical, without jumps by whole turns
    std::array<std::vector<char>, 2>
        is_outlier;  // for each link and sample: far from its neighbours, not used in the fit

    std::size_t size() const { return time_s.size(); }
    double duration() const { return time_s.back() - time_s.front(); }
};

/// A measured motion.
struct Track {
    std::vector<TrackPiece> pieces;  // in order of time
    std::vector<double> start_s;     // of each piece on one clock; empty if unknown
    std::array<double, 2> noise{};   // rms of each angle's noise from sample to sample, rad
    std::vector<std::string> notes;  // sentences about how the input was interpreted
    std::size_t samples() const;
    std::size_t outliers() const;
    double duration() const;  // s, sum over all pieces
};

inline constexpr std::atomic<bool> not_stopped = false;  // for work that is never stopped

/// Reads CSV files with a heading: time_s and theta1_rad, theta2_rad, or x0_px, y0_px, x1_px, y1_px, x2_px, y2_px
/// (pivot, joint, end; y down). Other columns are ignored. A new piece begins after a gap of more than a fifth of a
/// second, with every file, and with a new number in a column "piece". Pieces are on one clock if their times never go
/// back; otherwise they follow one another in the order given. Throws Error: exit 2 if there is no such file, or it is
/// no track (with file, line, value, and what would be right); exit 4 if it cannot be read; exit 130 soon after `stop`
/// is set.
Track read_tracks(const std::vector<std::filesystem::path>& files, const std::atomic<bool>& stop = not_stopped);

/// The contents of a file. Throws Error as read_tracks() does.
std::string text_of_track(const std::filesystem::path& file);

/// Reads tracks from texts; `names` are shown in messages.
Track tracks_of_texts(const std::vector<std::string>& names, const std::vector<std::string>& texts,
                      const std::atomic<bool>& stop = not_stopped);

/// Finds outliers and noise. Throws Error (exit 2) if a track is too short, too coarse, or moves too little to
/// determine a model.
void check_track(Track& track, const std::atomic<bool>& stop);

double median_size(std::vector<double> values);

}  // namespace doppel
