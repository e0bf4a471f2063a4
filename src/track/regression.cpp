#include "track/regression.hpp"

#include "base/error.hpp"
#include "numeric/portable_math.hpp"
#include "numeric/sin_cos.hpp"

#include <Eigen/QR>

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

/// What a polynomial says of one arm at a moment, and how far the samples are from it.
struct LocalFit {
    double angle = 0, rate = 0, acceleration = 0, rms = 0;
};

constexpr Eigen::Index degree = 5;
constexpr std::size_t least_points = degree + 3;

/// Samples first … last − 1 of a piece.
struct SampleRange {
    std::size_t first = 0, last = 0;
};

/// A polynomial in the time from `center` through a range of one arm's samples.
LocalFit local_fit(const TrackPiece& piece, std::size_t arm, SampleRange range, double center) {
    std::vector<std::size_t> used;
    for (std::size_t i = range.first; i < range.last; ++i)
        if (!piece.is_outlier[arm][i]) used.push_back(i);
    const auto count = static_cast<Eigen::Index>(used.size());
    const LocalFit nothing{piece.angle[arm][range.first]};
    if (count < degree + 2) return nothing;
    const double span = std::max(piece.time_s[range.last - 1] - center, center - piece.time_s[range.first]);
    Eigen::MatrixXd powers(count, degree + 1);
    Eigen::VectorXd values(count);
    for (Eigen::Index i = 0; i < count; ++i) {
        const double t = (piece.time_s[used[static_cast<std::size_t>(i)]] - center) / span;
        double power = 1;
        for (Eigen::Index k = 0; k <= degree; ++k, power *= t) powers(i, k) = power;
        values[i] = piece.angle[arm][used[static_cast<std::size_t>(i)]];
    }
    const Eigen::VectorXd c = (powers.transpose() * powers).ldlt().solve(powers.transpose() * values);
    if (!c.allFinite()) return nothing;
    const double rest = (values - powers * c).norm() / std::sqrt(static_cast<double>(count));
    return {c[0], c[1] / span, 2 * c[2] / (span * span), rest};
}

/// A window around a moment, shifted to be whole even at the ends of the piece, and widened to hold enough samples.
SampleRange range_around(const TrackPiece& piece, std::size_t arm, double time_s, double window) {
    const auto& times = piece.time_s;
    const auto& is_outlier = piece.is_outlier[arm];
    const double from = std::max(times.front(), std::min(time_s - window / 2, times.back() - window));
    const auto place = [&](auto bound) { return static_cast<std::size_t>(bound - times.begin()); };
    SampleRange range{place(std::lower_bound(times.begin(), times.end(), from)),
                      place(std::upper_bound(times.begin(), times.end(), from + window))};
    auto& [first, last] = range;
    auto count = static_cast<std::size_t>(std::count(is_outlier.begin() + static_cast<std::ptrdiff_t>(first),
                                                     is_outlier.begin() + static_cast<std::ptrdiff_t>(last), 0));
    while (count < least_points && (first > 0 || last < times.size())) {
        const bool back = first > 0 && (last == times.size() || time_s - times[first - 1] < times[last] - time_s);
        if (!is_outlier[back ? --first : last++]) ++count;
    }
    return range;
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

Glimpse glimpse_at(const Track& track, const TrackPiece& piece, double time_s, double longer) {
    // encoders err alike for some samples in a row, which the noise from sample to sample does not tell
    constexpr double noises = 3, shortest_s = 1e-6;
    Glimpse glimpse{};
    for (std::size_t arm = 0; arm < 2; ++arm) {
        LocalFit fit;
        for (double window = longer * window_of(track); window > shortest_s; window /= 2) {
            const auto range = range_around(piece, arm, time_s, window);
            fit = local_fit(piece, arm, range, time_s);
            if (fit.rms <= noises * track.noise[arm] || range.last - range.first <= least_points) break;
        }
        glimpse.angle[arm] = fit.angle, glimpse.rate[arm] = fit.rate, glimpse.acceleration[arm] = fit.acceleration;
    }
    return glimpse;
}

std::vector<Glimpse> glimpses_of(const Track& track, const std::atomic<bool>& stop, double longer) {
    std::vector<Glimpse> all;
    const double half = longer * window_of(track) / 2;
    for (const auto& piece : track.pieces)
        for (double time = piece.time_s.front() + half; time < piece.time_s.back() - half; time += half) {
            throw_if_set(stop);
            all.push_back(glimpse_at(track, piece, time, longer));
        }
    return all;
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
    result.inertia = of_first[0], result.coupling = coupling;
    result.gravity = {of_first[1], of_second[1]};
    result.is_physical = std::isfinite(of_first.sum() + of_second.sum()) && coupling > 0 && of_first[0] > 0 &&
                         of_first[1] > 0 && of_second[1] > 0;
    return result;
}

}  // namespace doppel
