#include "track/track.hpp"

#include "base/error.hpp"
#include "base/read_file.hpp"
#include "numeric/portable_math.hpp"
#include "track/regression.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numbers>
#include <span>
#include <string_view>
#include <utility>

namespace doppel {
namespace {

constexpr double long_gap_s = 0.2;
constexpr std::size_t max_rows = 2'000'000;

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

// messages name the place but not its contents, because a preset of another person may name any file

/// The columns of a file.
struct Heading {
    std::vector<std::string_view> names;
    std::vector<std::size_t> values;  // the time, then two angles or six pixel places
    std::optional<std::size_t> piece;
};

Heading heading_of(const std::string& file, std::string_view line) {
    Heading heading{.names = cells_of(line)};
    const auto places = [&](std::initializer_list<std::string_view> wanted) {
        std::vector<std::size_t> found;
        for (const auto name : wanted) {
            if (std::ranges::count(heading.names, name) > 1)
                throw bad_input("{}:1: the column {} occurs twice; leave one out", file, name);
            if (const auto at = std::ranges::find(heading.names, name); at != heading.names.end())
                found.push_back(static_cast<std::size_t>(at - heading.names.begin()));
        }
        return found;
    };
    for (const auto at : places({"theta1_deg", "theta2_deg"}))
        throw bad_input(
            "{}:1: \"{}\" is in degrees; angles must be in radians, theta1_rad and theta2_rad (degrees × π/180)", file,
            heading.names[at]);
    const auto time = places({"time_s"}), piece = places({"piece"}), angles = places({"theta1_rad", "theta2_rad"});
    const auto pixels = places({"x0_px", "y0_px", "x1_px", "y1_px", "x2_px", "y2_px"});
    if (time.empty())
        throw bad_input("{}:1: there is no column time_s; {}", file,
                        line.find_first_of(";\t") == std::string_view::npos
                            ? "columns are named as here, in small letters"
                            : "columns are separated by commas, not by semicolons or tabs");
    if (angles.size() == 1)
        throw bad_input("{}:1: there is only one link, {}; fit needs a double pendulum, with theta1_rad and theta2_rad",
                        file, heading.names[angles[0]]);
    if (angles.empty() && pixels.size() < 6)
        throw bad_input(
            "{}:1: there are no angles; the columns must be theta1_rad and theta2_rad, or all of x0_px, y0_px (pivot), "
            "x1_px, y1_px (joint), x2_px, y2_px (end)",
            file);
    heading.values = time;
    std::ranges::copy(angles.empty() ? pixels : angles, std::back_inserter(heading.values));
    if (!piece.empty()) heading.piece = piece[0];
    return heading;
}

double number_of(const std::string& place, std::string_view column, std::string_view cell) {
    double value = 0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error != std::errc() || end != cell.data() + cell.size())
        throw bad_input("{}: {} is not a number", place, column);
    if (!std::isfinite(value))
        throw bad_input("{}: {} is {}; leave out rows without a measurement", place, column,
                        std::isnan(value) ? "nan" : "infinite");
    return value;
}

/// The angles of both links: given directly, or from the positions of pivot, joint and end, y down.
std::array<double, 2> angles_of(const std::string& place, std::span<const double> values) {
    constexpr double maximum = 1e6;  // rad: 160 000 turns
    std::array<double, 2> angles{values[0], values[1]};
    for (std::size_t link = 0; link < 2 && values.size() > 2; ++link) {
        const double dx = values[2 * link + 2] - values[2 * link], dy = values[2 * link + 3] - values[2 * link + 1];
        if (dx == 0 && dy == 0)
            throw bad_input("{}: two of pivot, joint and end are at the same place; a link needs a length", place);
        angles[link] = portable_atan2(dx, dy);
    }
    for (std::size_t link = 0; link < 2; ++link)
        if (std::abs(angles[link]) > maximum)
            throw bad_input("{}: theta{}_rad is beyond {} rad; check its unit", place, link + 1, maximum);
    return angles;
}

/// Removes jumps by whole turns from angles that stay within one turn; other angles already count turns.
void unwrap(std::vector<double>& angles) {
    constexpr double turn = 2 * std::numbers::pi, margin = 1.01;
    const auto [low, high] = std::minmax_element(angles.begin(), angles.end());
    if (*high - *low > margin * turn) return;
    for (std::size_t i = 1; i < angles.size(); ++i) angles[i] -= turn * std::round((angles[i] - angles[i - 1]) / turn);
}

/// Reads the rows of one file into pieces.
void read_text(const std::string& name, std::string_view text, Track& track, const std::atomic<bool>& stop) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    std::optional<Heading> heading;
    std::string_view piece_number;
    const auto first_piece = track.pieces.size();
    const auto rows_before = track.samples();
    std::size_t line_number = 0, rows = rows_before;
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
            throw bad_input("{}: the row has {} cells; the header has {} columns", place, cells.size(),
                            heading->names.size());
        std::vector<double> values;  // the time first
        for (const auto column : heading->values)
            values.push_back(number_of(place, heading->names[column], cells[column]));
        const double time = values[0];
        if (heading->piece) starts |= std::exchange(piece_number, cells[*heading->piece]) != cells[*heading->piece];
        if (!starts) {
            const auto& before = track.pieces.back().time_s;
            if (time <= before.back())
                throw bad_input(
                    "{}: time_s goes from {} to {}; rows must be in the order of time; put pieces that restart the "
                    "clock in separate files, or number them in a column \"piece\"",
                    place, before.back(), time);
            starts = time - before.back() > long_gap_s && before.size() > 1;
        }
        if (std::exchange(starts, false)) track.pieces.push_back({.name = name});
        const auto angles = angles_of(place, std::span(values).subspan(1));
        auto& piece = track.pieces.back();
        piece.time_s.push_back(time);
        for (std::size_t link = 0; link < 2; ++link) piece.angle[link].push_back(angles[link]);
        if (++rows > max_rows)
            throw bad_input("{}: there are more than {} rows; a minute at 1000 Hz is enough", name, max_rows);
    }
    if (!heading) throw bad_input("{}: the file is empty; it must begin with time_s,theta1_rad,theta2_rad", name);
    if (track.pieces.size() == first_piece) throw bad_input("{}: there are no rows below the header", name);
    const auto& times = track.pieces[first_piece].time_s;
    if (times.size() == 2 && times[1] - times[0] > long_gap_s && track.samples() > rows_before + 2)
        throw bad_input("{}: rows are {:.3g} s apart, and more than {} s are a gap; time_s must be in seconds", name,
                        times[1] - times[0], long_gap_s);
}

// Checks.

constexpr std::size_t min_samples = 100, min_of_piece = 12;
constexpr double min_s = 1.5, min_of_piece_s = 0.25;

/// The distance of each sample from the polynomial through `some` neighbours on either side.
std::vector<double> residuals_of(const TrackPiece& piece, std::size_t link, std::size_t some) {
    const auto &t = piece.time_s, &x = piece.angle[link];
    std::vector<double> residuals(x.size(), 0);
    for (std::size_t i = some; i + some < x.size(); ++i) {
        residuals[i] = x[i];
        for (auto k = i - some; k <= i + some; ++k) {
            double weight = 1;
            for (auto other = i - some; other <= i + some; ++other)
                if (other != k && other != i) weight *= (t[i] - t[other]) / (t[k] - t[other]);
            if (k != i) residuals[i] -= weight * x[k];
        }
    }
    return residuals;
}

/// Finds the noise, and outliers: samples far from the cubic through their neighbours, which deviate the other way. Between
/// coarse samples the motion is no cubic; there a quintic leaves less. At a kink, as Coulomb friction makes it, it is
/// neither, but nearer to them than to the chord of the neighbours.
void find_noise(Track& track, const std::atomic<bool>& stop) {
    constexpr double far = 12, bent = 2;
    const auto samples = static_cast<double>(track.samples());
    // the deviation from a polynomial through so many values with noise 1 on either side, in units of that noise
    constexpr std::pair<std::size_t, double> polynomials[]{{2, 1.39}, {3, 1.52}};
    for (std::size_t link = 0; link < 2; ++link) {
        auto& noise = track.noise[link] = std::numeric_limits<double>::infinity();
        double size = 0, chord = 0;  // chord: mean distance from it
        for (const auto& piece : track.pieces)
            for (const double r : residuals_of(piece, link, 1)) chord += std::abs(r) / samples;
        std::vector<std::vector<double>> of_pieces;
        for (const auto& [some, unit] : polynomials) {
            std::vector<double> all;
            std::vector<std::vector<double>> residuals;
            for (const auto& piece : track.pieces) {
                throw_if_set(stop);
                const auto& r = residuals.emplace_back(residuals_of(piece, link, some));
                const auto ends = static_cast<std::ptrdiff_t>(some);
                all.insert(all.end(), r.begin() + ends, r.end() - ends);
            }
            const double middle = 1.4826 * median_size(std::move(all));
            if (!(middle / unit < noise)) continue;
            noise = middle / unit;
            size = middle;
            of_pieces = std::move(residuals);
        }
        for (std::size_t k = 0; k < track.pieces.size(); ++k)
            for (std::size_t i = 2; i + 2 < of_pieces[k].size(); ++i) {
                const double before = of_pieces[k][i - 1], r = of_pieces[k][i], after = of_pieces[k][i + 1];
                const bool is_peak = std::abs(r) > std::max(std::abs(before), std::abs(after));
                const double least = std::max(far * size, bent * chord);
                if (std::abs(r) > least && size > 0 && is_peak && r * before <= 0 && r * after <= 0)
                    track.pieces[k].is_outlier[link][i] = 1;
            }
    }
}

bool is_short(const TrackPiece& piece) {
    return piece.size() < min_of_piece || piece.duration() < min_of_piece_s;
}

/// Removes fragments between gaps; a file that is too short as a whole stays, and is refused later.
void drop_fragments(Track& track) {
    std::map<std::string, std::size_t> of_file;
    for (const auto& piece : track.pieces) ++of_file[piece.name];
    const auto dropped = std::erase_if(track.pieces, [&](const TrackPiece& piece) {
        auto& left = of_file[piece.name];
        return is_short(piece) && left > 1 && left-- > 0;
    });
    if (dropped > 0)
        track.notes.push_back(fmt::format("{} fragments between gaps, shorter than {} samples or {} s, were left out",
                                          dropped, min_of_piece, min_of_piece_s));
}

/// Finds the start times of pieces on one clock, if their times never go back.
void find_clock(Track& track) {
    for (std::size_t k = 0; k < track.pieces.size(); ++k) {
        const auto& times = track.pieces[k].time_s;
        if (k > 0 && times.front() <= track.pieces[k - 1].time_s.back()) return track.start_s.clear();
        track.start_s.push_back(times.front() - track.pieces[0].time_s[0]);
    }
}

void require_length(const Track& track) {
    for (const auto& piece : track.pieces)
        if (is_short(piece))
            throw bad_input(
                "{}: the piece from {} s on is too short: {} samples in {:.3g} s; it needs at least {} in {} s",
                piece.name, piece.time_s.front(), piece.size(), piece.duration(), min_of_piece, min_of_piece_s);
    if (track.samples() < min_samples || track.duration() < min_s)
        throw bad_input(
            "{}: the track is too short: {} samples in {:.3g} s; it needs at least {} in {} s, some swings of both "
            "links",
            track.pieces.front().name, track.samples(), track.duration(), min_samples, min_s);
}

void require_motion(const Track& track) {
    constexpr double minimum = 0.05;  // rad
    const auto& name = track.pieces.front().name;
    for (std::size_t link = 0; link < 2; ++link) {
        double maximum = 0;
        for (const auto& piece : track.pieces) {
            const auto [low, high] = std::ranges::minmax(piece.angle[link]);
            maximum = std::max(maximum, high - low);
        }
        if (maximum < std::max(minimum, 20 * track.noise[link]))
            throw bad_input(
                "{}: theta{} {}: it moves by {:.2g} rad with a noise of {:.2g} rad, which is too little; it must be at "
                "least {} rad and 20 times the noise",
                name, link + 1, maximum < minimum ? "is flat" : "is mostly noise", maximum, track.noise[link], minimum);
    }
    double squares = 0;
    for (const auto& piece : track.pieces)
        for (std::size_t i = 0; i < piece.size(); ++i) squares += std::pow(piece.angle[1][i] - piece.angle[0][i], 2);
    if (std::sqrt(squares / static_cast<double>(track.samples())) <= 2 * std::max(track.noise[0], track.noise[1]))
        throw bad_input("{}: theta1_rad and theta2_rad are equal within noise; both links are needed", name);
}

/// Another interpretation of the columns.
struct Reading {
    double unit = 1;  // of the angles, rad
    bool relative = false, mirrored = false;
    std::array<int, 2> quarters{};  // of a turn, subtracted

    /// Converts both links' angles, or their differences, which have no zero point.
    void take(double& first, double& second, bool are_angles) const {
        const double quarter = are_angles ? std::numbers::pi / 2 : 0, shift = quarters[0] * quarter;
        first *= unit, second *= mirrored ? -unit : unit;
        if (relative) second += first;
        first -= shift, second -= quarters[1] * quarter;
        if (relative) second -= shift;
    }
};

double unexplained(const std::vector<LinkEstimates>& estimates, const Reading& reading) {
    auto taken = estimates;
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
    if (reading.relative) words.push_back("theta2 counted from the first link");
    for (std::size_t link = 0; link < 2; ++link)
        if (const int degrees = 90 * reading.quarters[link]; degrees != 0)
            words.push_back(fmt::format("theta{} counted from {}° off the downward vertical", link + 1, degrees));
    track.notes.push_back(fmt::format("the angles fit a double pendulum only if read as follows, and are read so: {}",
                                      fmt::join(words, "; ")));
    for (auto& piece : track.pieces)
        for (std::size_t i = 0; i < piece.size(); ++i) reading.take(piece.angle[0][i], piece.angle[1][i], true);
}

/// If the angles do not fit the equations of any double pendulum, but do in another interpretation: converts a
/// different convention, and refuses a mistake.
void check_convention(Track& track, const std::atomic<bool>& stop) {
    constexpr double well = 0.003, obeys = 0.1, much_better = 0.3, degree = std::numbers::pi / 180;
    const auto estimates = estimates_of(track, stop);
    const double as_it_is = unexplained(estimates, {});
    if (as_it_is < well) return;
    std::array<double, 2> low{track.pieces[0].angle[0][0], track.pieces[0].angle[1][0]}, high = low;
    for (const auto& piece : track.pieces)
        for (std::size_t link = 0; link < 2; ++link)
            for (const double angle : piece.angle[link])
                low[link] = std::min(low[link], angle), high[link] = std::max(high[link], angle);
    const double widest = std::max(high[0] - low[0], high[1] - low[1]);
    Reading best;
    double minimum = as_it_is;
    const auto consider = [&](const Reading& reading) {
        throw_if_set(stop);
        if (const double value = unexplained(estimates, reading); value < minimum) minimum = value, best = reading;
    };
    constexpr double small =
        4;  // rad: motions that are this small in degrees are linear, and any linear motion would fit
    if (widest > small) consider({.unit = degree});
    for (int way = 0; way < 64; ++way)
        consider({.relative = way >= 32, .mirrored = way / 16 % 2 == 1, .quarters = {way / 4 % 4 - 1, way % 4 - 1}});
    const auto& name = track.pieces.front().name;
    const bool is_better = minimum <= std::min(obeys, much_better * as_it_is);
    if (is_better && best.unit == 1) return convert(track, best);
    if (is_better)
        throw bad_input(
            "{}: the angles are in degrees; they must be in radians (degrees × π/180): converted, {:.0f} % of the "
            "forces are unexplained, otherwise {:.0f} %",
            name, 100 * minimum, 100 * as_it_is);
    constexpr double max_turns = 60;             // rad: ten turns and a half
    if (as_it_is > obeys && widest > max_turns)  // otherwise the fit will show it
        throw bad_input(
            "{}: the angles go from {:.3g} to {:.3g}, and do not fit a double pendulum; are they in degrees? They must "
            "be in radians (degrees × π/180)",
            name, low[0], high[0]);
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
        for (const auto& link : piece.is_outlier)
            sum += static_cast<std::size_t>(std::count(link.begin(), link.end(), 1));
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
        for (std::size_t link = 0; link < 2; ++link) {
            unwrap(piece.angle[link]);
            piece.is_outlier[link].assign(piece.size(), 0);
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

double median_size(std::vector<double> values) {
    for (auto& value : values) value = std::abs(value);
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

void check_track(Track& track, const std::atomic<bool>& stop) {
    drop_fragments(track);
    find_clock(track);
    require_length(track);
    find_noise(track, stop);
    require_motion(track);
    if (const auto outliers = track.outliers(), all = 2 * track.samples(); outliers > 0) {
        const auto words = fmt::format("{} of {} angles are outliers", outliers, all);
        if (10 * outliers > all) throw bad_input("{}: {}; a track is wanted", track.pieces.front().name, words);
        track.notes.push_back(words + ", and were left out");
    }
    check_convention(track, stop);
}

}  // namespace doppel
