#include "track/regression.hpp"

#include "numeric/portable_math.hpp"

#include <Eigen/QR>

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

/// Polynomial of degree `degree` through samples first … last − 1 of one arm, by the time from `center`: value, rate,
/// acceleration there. False where there are too few.
bool local_fit(const TrackPiece& piece, std::size_t arm, std::size_t first, std::size_t last, double center,
               Eigen::Index degree, std::array<double, 3>& result) {
    std::vector<std::size_t> used;
    for (std::size_t i = first; i < last; ++i)
        if (!piece.is_outlier[arm][i]) used.push_back(i);
    const auto count = static_cast<Eigen::Index>(used.size());
    if (count < degree + 2) return false;
    const double span = std::max(piece.time_s[last - 1] - center, center - piece.time_s[first]);
    Eigen::MatrixXd powers(count, degree + 1);
    Eigen::VectorXd values(count);
    for (Eigen::Index i = 0; i < count; ++i) {
        const double t = (piece.time_s[used[static_cast<std::size_t>(i)]] - center) / span;
        double power = 1;
        for (Eigen::Index k = 0; k <= degree; ++k, power *= t) powers(i, k) = power;
        values[i] = piece.angle[arm][used[static_cast<std::size_t>(i)]];
    }
    const Eigen::VectorXd c = (powers.transpose() * powers).ldlt().solve(powers.transpose() * values);
    result = {c[0], c[1] / span, 2 * c[2] / (span * span)};
    return c.allFinite();
}

/// Long enough that its polynomial averages the noise away, short against a swing.
double window_of(const Track& track) {
    constexpr double shortest = 0.06, longest = 0.2, samples = 12;
    const auto& piece = track.pieces.front();
    const double interval = piece.duration() / static_cast<double>(piece.size() - 1);
    const double noise = std::max(track.noise[0], track.noise[1]);
    // the acceleration errs by about 27 noise/(window² √samples): to be some tenths of rad/s²
    const double quiet = portable_pow(27 * noise * std::sqrt(interval) / 0.5, 0.4);
    return std::clamp(std::max(quiet, samples * interval), shortest, longest);
}

}  // namespace

Glimpse glimpse_at(const Track& track, const TrackPiece& piece, double time_s) {
    constexpr std::size_t least = 7;
    constexpr Eigen::Index degree = 4;
    const auto& times = piece.time_s;
    const double half = window_of(track) / 2;
    const auto place = [&](auto bound) { return static_cast<std::size_t>(bound - times.begin()); };
    Glimpse glimpse{};
    for (std::size_t arm = 0; arm < 2; ++arm) {
        auto first = place(std::lower_bound(times.begin(), times.end(), time_s - half)),
             last = place(std::upper_bound(times.begin(), times.end(), time_s + half));
        const auto& is_outlier = piece.is_outlier[arm];
        const auto count = [&](std::size_t from, std::size_t to) {
            return static_cast<std::size_t>(std::count(is_outlier.begin() + static_cast<std::ptrdiff_t>(from),
                                                       is_outlier.begin() + static_cast<std::ptrdiff_t>(to), 0));
        };
        while (count(first, last) < least && (first > 0 || last < times.size())) {
            const bool back = first > 0 && (last == times.size() || time_s - times[first - 1] < times[last] - time_s);
            back ? --first : ++last;
        }
        std::array<double, 3> values{piece.angle[arm][std::min(first, times.size() - 1)], 0, 0};
        local_fit(piece, arm, first, last, time_s, degree, values);
        glimpse.angle[arm] = values[0], glimpse.rate[arm] = values[1], glimpse.acceleration[arm] = values[2];
    }
    return glimpse;
}

std::vector<Glimpse> glimpses_of(const Track& track) {
    std::vector<Glimpse> all;
    const double window = window_of(track);
    for (const auto& piece : track.pieces)
        for (double time = piece.time_s.front() + window / 2; time < piece.time_s.back() - window / 2;
             time += window / 2)
            all.push_back(glimpse_at(track, piece, time));
    return all;
}

ArmState<double> guessed_start(const Track& track, const TrackSegment& segment) {
    const auto& piece = track.pieces[segment.piece];
    const double begin = piece.time_s[segment.first], window = window_of(track);
    auto last = segment.first;
    while (last < segment.last && (piece.time_s[last] <= begin + window || last < segment.first + 6)) ++last;
    ArmState<double> start{};
    for (std::size_t arm = 0; arm < 2; ++arm) {
        std::array<double, 3> values{piece.angle[arm][segment.first], 0, 0};
        local_fit(piece, arm, segment.first, last, begin, 3, values);
        start[arm] = values[0], start[arm + 2] = values[1];
    }
    return start;
}

Regression regress(const std::vector<Glimpse>& glimpses) {
    Regression result;
    const auto count = static_cast<Eigen::Index>(glimpses.size());
    if (count < 8) return result;
    // the second arm, whose own term has no unknown: −θ2″ = C (cosδ θ1″ − sinδ ω1²) + D2 sinθ2 + friction
    Eigen::MatrixXd second(count, 3), first(count, 3);
    Eigen::VectorXd right(count), driven(count);
    for (Eigen::Index i = 0; i < count; ++i) {
        const auto& [angle, rate, acceleration] = glimpses[static_cast<std::size_t>(i)];
        const SinCos<double> between(angle[0] - angle[1]), turn1(angle[0]), turn2(angle[1]);
        second.row(i) << between.cos * acceleration[0] - between.sin * rate[0] * rate[0], turn2.sin, rate[1] - rate[0];
        right[i] = -acceleration[1];
        first.row(i) << acceleration[0], turn1.sin, rate[0];
        driven[i] = -(between.cos * acceleration[1] + between.sin * rate[1] * rate[1]);
    }
    const Eigen::VectorXd of_second = second.colPivHouseholderQr().solve(right);
    const double coupling = of_second[0];
    const Eigen::VectorXd of_first = first.colPivHouseholderQr().solve(coupling * driven);
    const auto share = [](const Eigen::VectorXd& rest, const Eigen::VectorXd& all) {
        return all.squaredNorm() > 0 ? rest.squaredNorm() / all.squaredNorm() : 1.0;
    };
    result.unexplained = std::max(share(right - second * of_second, right),
                                  share(driven * coupling - first * of_first, driven * coupling));
    auto& p = result.parameters;
    p[index_of(FitParameter::inertia)] = of_first[0];
    p[index_of(FitParameter::coupling)] = coupling;
    p[index_of(FitParameter::gravity_1)] = of_first[1];
    p[index_of(FitParameter::gravity_2)] = of_second[1];
    p[index_of(FitParameter::scale_1)] = p[index_of(FitParameter::scale_2)] = 1;
    result.is_physical = std::isfinite(of_first.sum() + of_second.sum()) && coupling > 0 && of_first[0] > 0 &&
                         of_first[1] > 0 && of_second[1] > 0;
    return result;
}

}  // namespace doppel
