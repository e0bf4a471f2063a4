#include "track/track.hpp"

#include "base/error.hpp"
#include "base/read_file.hpp"
#include "numeric/portable_math.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <numbers>
#include <span>
#include <string_view>
#include <utility>

namespace doppel {
namespace {

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
    std::vector<std::string_view> names;
    std::vector<std::size_t> values;  // the time, then two angles or six pixel places
    std::optional<std::size_t> piece;
};

Heading heading_of(const std::string& file, std::string_view line) {
    Heading heading{.names = cells_of(line)};
    const auto places = [&](std::initializer_list<std::string_view> wanted) {
        std::vector<std::size_t> found;
        for (const auto name : wanted)
            if (const auto at = std::ranges::find(heading.names, name); at != heading.names.end())
                found.push_back(static_cast<std::size_t>(at - heading.names.begin()));
        return found;
    };
    for (const auto at : places({"theta1_deg", "theta2_deg"}))
        throw bad_input(
            "{}:1: \"{}\" is in degrees; angles are wanted in radians, theta1_rad and theta2_rad (degrees × π/180)",
            file, heading.names[at]);
    const auto time = places({"time_s"}), piece = places({"piece"}), angles = places({"theta1_rad", "theta2_rad"});
    const auto pixels = places({"x0_px", "y0_px", "x1_px", "y1_px", "x2_px", "y2_px"});
    if (time.empty()) throw bad_input("{}:1: there is no column time_s", file);
    if (angles.size() == 1)
        throw bad_input("{}:1: there is one arm only, {}; fit takes double pendulums, with theta1_rad and theta2_rad",
                        file, heading.names[angles[0]]);
    if (angles.empty() && pixels.empty())
        throw bad_input(
            "{}:1: there are no angles; theta1_rad and theta2_rad are wanted, or x0_px, y0_px, x1_px, y1_px, x2_px, "
            "y2_px",
            file);
    if (angles.empty() && pixels.size() < 6)
        throw bad_input(
            "{}:1: of x0_px, y0_px (pivot), x1_px, y1_px (joint), x2_px, y2_px (end) there are {} columns; all six are "
            "needed",
            file, pixels.size());
    heading.values = time;
    std::ranges::copy(angles.empty() ? pixels : angles, std::back_inserter(heading.values));
    if (!piece.empty()) heading.piece = piece[0];
    return heading;
}

double number_of(const std::string& place, std::string_view column, std::string_view cell) {
    double value = 0;
    const auto [end, fault] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (fault != std::errc() || end != cell.data() + cell.size()) throw bad_input("{}: {} is no number", place, column);
    if (!std::isfinite(value))
        throw bad_input("{}: {} is {}; leave out rows without a measurement", place, column,
                        std::isnan(value) ? "nan" : "infinite");
    return value;
}

/// Of both arms, given themselves or by the places of pivot, joint and end, y down.
std::array<double, 2> angles_of(const std::string& place, std::span<const double> values) {
    constexpr double most = 1e6;  // rad: 160 000 turns
    std::array<double, 2> angles{values[0], values[1]};
    for (std::size_t arm = 0; arm < 2 && values.size() > 2; ++arm) {
        const double dx = values[2 * arm + 2] - values[2 * arm], dy = values[2 * arm + 3] - values[2 * arm + 1];
        if (dx == 0 && dy == 0)
            throw bad_input("{}: two of pivot, joint and end are at the same place; an arm needs a length", place);
        angles[arm] = portable_atan2(dx, dy);
    }
    for (std::size_t arm = 0; arm < 2; ++arm)
        if (std::abs(angles[arm]) > most)
            throw bad_input("{}: theta{}_rad is beyond {} rad, which is no swing", place, arm + 1, most);
    return angles;
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
    std::string_view piece_number;
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
            continue;
        }
        const auto place = fmt::format("{}:{}", name, line_number);
        const auto cells = cells_of(line);
        if (cells.size() != heading->names.size())
            throw bad_input("{}: there are {} cells, and {} columns", place, cells.size(), heading->names.size());
        std::vector<double> values;  // the time first
        for (const auto column : heading->values)
            values.push_back(number_of(place, heading->names[column], cells[column]));
        const double time = values[0];
        if (heading->piece) starts |= std::exchange(piece_number, cells[*heading->piece]) != cells[*heading->piece];
        if (!starts) {
            const auto& before = track.pieces.back().time_s;
            if (time <= before.back())
                throw bad_input(
                    "{}: time_s goes from {} to {}; rows are wanted in the order of time, pieces that begin anew in "
                    "files of their own or numbered in a column \"piece\"",
                    place, before.back(), time);
            starts = time - before.back() > long_gap_s && before.size() > 1;
        }
        if (std::exchange(starts, false)) track.pieces.push_back({.name = name});
        const auto angles = angles_of(place, std::span(values).subspan(1));
        auto& piece = track.pieces.back();
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
    for (const auto& path : files) names.push_back(path.string()), texts.push_back(text_of_track(path));
    return tracks_of_texts(names, texts, stop);
}

}  // namespace doppel
