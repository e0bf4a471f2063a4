#include "track/track.hpp"

#include "base/error.hpp"
#include "base/read_file.hpp"
#include "numeric/portable_math.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string_view>

namespace doppel {
namespace {

constexpr std::array angle_columns{"theta1_rad", "theta2_rad"};
constexpr std::array pixel_columns{"x0_px", "y0_px", "x1_px", "y1_px", "x2_px", "y2_px"};
constexpr double long_gap_s = 0.2;
constexpr std::size_t most_rows = 2'000'000;

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t\r\"");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r\"") - first + 1);
}

std::vector<std::string_view> cells_of(std::string_view line) {
    std::vector<std::string_view> cells;
    for (std::size_t from = 0;;) {
        const auto comma = line.find(',', from);
        cells.push_back(trimmed(line.substr(from, comma == std::string_view::npos ? comma : comma - from)));
        if (comma == std::string_view::npos) return cells;
        from = comma + 1;
    }
}

// messages name the place, not what stands there: a stranger's preset may name any file

/// Where the columns stand in a file.
struct Heading {
    std::size_t time = 0;
    std::vector<std::size_t> values;  // two angles, or six pixel places
    std::optional<std::size_t> piece;
};

Heading heading_of(const std::string& name, std::string_view line) {
    const auto names = cells_of(line);
    const auto place = [&](std::string_view wanted) -> std::optional<std::size_t> {
        const auto found = std::find(names.begin(), names.end(), wanted);
        if (found == names.end()) return std::nullopt;
        return static_cast<std::size_t>(found - names.begin());
    };
    for (const auto* degrees : {"theta1_deg", "theta2_deg"})
        if (place(degrees))
            throw bad_input(
                "{}:1: \"{}\" is in degrees; angles are wanted in radians, theta1_rad and theta2_rad "
                "(degrees × π/180)",
                name, degrees);
    Heading heading;
    const auto time = place("time_s");
    if (!time) throw bad_input("{}:1: there is no column time_s", name);
    heading.time = *time;
    heading.piece = place("piece");
    const auto take = [&](const auto& columns) {
        heading.values.clear();
        for (const auto* column : columns)
            if (const auto at = place(column)) heading.values.push_back(*at);
        return heading.values.size();
    };
    if (const auto found = take(angle_columns); found == 2)
        return heading;
    else if (found == 1)
        throw bad_input("{}:1: there is one arm only, {}; fit takes double pendulums, with theta1_rad and theta2_rad",
                        name, place("theta1_rad") ? "theta1_rad" : "theta2_rad");
    if (const auto found = take(pixel_columns); found == pixel_columns.size())
        return heading;
    else if (found > 0)
        throw bad_input(
            "{}:1: of x0_px, y0_px (pivot), x1_px, y1_px (joint), x2_px, y2_px (end) there are {} columns; "
            "all six are needed",
            name, found);
    throw bad_input(
        "{}:1: there are no angles; theta1_rad and theta2_rad are wanted, or x0_px, y0_px, x1_px, y1_px, "
        "x2_px, y2_px",
        name);
}

double number_of(const std::string& name, std::size_t line, std::string_view column, std::string_view cell) {
    double value = 0;
    const auto [end, fault] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (fault != std::errc() || end != cell.data() + cell.size())
        throw bad_input("{}:{}: {} is no number", name, line, column);
    if (!std::isfinite(value))
        throw bad_input("{}:{}: {} is {}; leave out rows without a measurement", name, line, column,
                        std::isnan(value) ? "nan" : "infinite");
    return value;
}

/// From the downward vertical, counter-clockwise, of the line between two places, y down.
double pixel_angle(const std::string& name, std::size_t line, double dx, double dy) {
    if (dx == 0 && dy == 0)
        throw bad_input("{}:{}: two of pivot, joint and end are at the same place; an arm needs a length", name, line);
    return portable_atan2(dx, dy);
}

std::array<double, 2> angles_of(const std::string& name, std::size_t line, const std::vector<double>& values) {
    constexpr double most = 1e6;  // rad: 160 000 turns
    if (values.size() == 2) {
        for (std::size_t arm = 0; arm < 2; ++arm)
            if (std::abs(values[arm]) > most)
                throw bad_input("{}:{}: {} is beyond {} rad, which is no swing", name, line, angle_columns[arm], most);
        return {values[0], values[1]};
    }
    return {pixel_angle(name, line, values[2] - values[0], values[3] - values[1]),
            pixel_angle(name, line, values[4] - values[2], values[5] - values[3])};
}

/// Takes out jumps by whole turns, of angles that keep within one; others count turns already.
void unwrap(std::vector<double>& angles) {
    constexpr double turn = 2 * std::numbers::pi, margin = 1.01;
    const auto [low, high] = std::minmax_element(angles.begin(), angles.end());
    if (*high - *low > margin * turn) return;
    for (std::size_t i = 1; i < angles.size(); ++i) angles[i] -= turn * std::round((angles[i] - angles[i - 1]) / turn);
}

/// The rows of one file, cut where a piece ends.
void read_text(const std::string& name, std::string_view text, Track& track, const std::atomic<bool>& stop) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    std::optional<Heading> heading;
    std::vector<std::string_view> names;
    std::string piece_number;
    const auto first_piece = track.pieces.size();
    std::size_t line_number = 0, rows = track.samples();
    bool starts = true;
    while (!text.empty()) {
        throw_if_set(stop);
        const auto end = text.find('\n');
        const auto line = trimmed(text.substr(0, end));
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        ++line_number;
        if (line.empty() || line.front() == '#') continue;
        if (!heading) {
            heading = heading_of(name, line);
            names = cells_of(line);
            continue;
        }
        const auto cells = cells_of(line);
        if (cells.size() != names.size())
            throw bad_input("{}:{}: there are {} cells, and {} columns", name, line_number, cells.size(), names.size());
        const auto value = [&](std::size_t column) {
            return number_of(name, line_number, names[column], cells[column]);
        };
        const double time = value(heading->time);
        if (heading->piece && piece_number != cells[*heading->piece])
            starts = true, piece_number = cells[*heading->piece];
        if (!starts) {
            const double before = track.pieces.back().time_s.back();
            if (time <= before)
                throw bad_input(
                    "{}:{}: time_s goes from {} to {}; rows are wanted in the order of time, pieces that begin "
                    "anew in files of their own or numbered in a column \"piece\"",
                    name, line_number, before, time);
            starts = time - before > long_gap_s && track.pieces.back().size() > 1;
        }
        if (starts) track.pieces.push_back({.name = name, .time_s = {}, .angle = {}, .is_outlier = {}});
        starts = false;
        auto& piece = track.pieces.back();
        std::vector<double> values;
        for (const auto column : heading->values) values.push_back(value(column));
        const auto angles = angles_of(name, line_number, values);
        piece.time_s.push_back(time);
        for (std::size_t arm = 0; arm < 2; ++arm) piece.angle[arm].push_back(angles[arm]);
        if (++rows > most_rows)
            throw bad_input("{}: there are more than {} rows; a minute of a track at 1000 Hz is plenty", name,
                            most_rows);
    }
    if (!heading) throw bad_input("{}: the file is empty; a heading time_s,theta1_rad,theta2_rad is wanted", name);
    if (track.pieces.size() == first_piece) throw bad_input("{}: there are no rows below the heading", name);
}

}  // namespace

std::size_t Track::samples() const {
    std::size_t sum = 0;
    for (const auto& piece : pieces) sum += piece.size();
    return sum;
}

std::size_t Track::outliers() const {
    std::size_t sum = 0;
    for (const auto& piece : pieces)
        for (const auto& arm : piece.is_outlier) sum += static_cast<std::size_t>(std::count(arm.begin(), arm.end(), 1));
    return sum;
}

double Track::duration() const {
    double sum = 0;
    for (const auto& piece : pieces) sum += piece.duration();
    return sum;
}

Track tracks_of_texts(const std::vector<std::string>& names, const std::vector<std::string>& texts,
                      const std::atomic<bool>& stop) {
    Track track;
    for (std::size_t k = 0; k < texts.size(); ++k) read_text(names[k], texts[k], track, stop);
    for (auto& piece : track.pieces)
        for (std::size_t arm = 0; arm < 2; ++arm) {
            unwrap(piece.angle[arm]);
            piece.is_outlier[arm].assign(piece.size(), 0);
        }
    check_track(track, stop);
    return track;
}

std::string text_of_track(const std::filesystem::path& file) {
    return read_whole_file(file, {"a track is a CSV file", std::size_t{256} << 20});
}

Track read_tracks(const std::vector<std::filesystem::path>& files, const std::atomic<bool>& stop) {
    std::vector<std::string> names, texts;
    for (const auto& path : files) {
        texts.push_back(text_of_track(path));
        names.push_back(path.string());
    }
    return tracks_of_texts(names, texts, stop);
}

}  // namespace doppel
