#include "track/regression.hpp"

#include "base/error.hpp"
#include "numeric/portable_math.hpp"
#include "numeric/sin_cos.hpp"

#include <Eigen/QR>

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

constexpr Eigen::Index degree = 5;
constexpr std::size_t least_points = degree + 3;

/// Of an arm, those in a window around a moment, which is shifted to be whole even at the ends of the piece, and widened
/// to hold enough; without outliers.
std::vector<std::size_t> samples_around(const TrackPiece& piece, std::size_t arm, double time_s, double window) {
    const auto& times = piece.time_s;
    const double from = std::max(times.front(), std::min(time_s - window / 2, times.back() - window));
    auto first = static_cast<std::size_t>(std::ranges::lower_bound(times, from) - times.begin()), last = first;
    std::vector<std::size_t> samples;
    const auto take = [&](std::size_t i) {
        if (!piece.is_outlier[arm][i]) samples.push_back(i);
    };
    while (last < times.size() && times[last] <= from + window) take(last++);
    while (samples.size() < least_points && (first > 0 || last < times.size())) {
        const bool back = first > 0 && (last == times.size() || time_s - times[first - 1] < times[last] - time_s);
        take(back ? --first : last++);
    }
    return samples;
}

/// What a polynomial through samples says of one arm at a moment, and how far the samples are from it, rms.
struct LocalFit {
    double angle = 0, rate = 0, acceleration = 0, rms = 0;
};

LocalFit local_fit(const TrackPiece& piece, std::size_t arm, const std::vector<std::size_t>& samples, double center) {
    const auto count = static_cast<Eigen::Index>(samples.size());
    if (count < degree + 2) return {piece.angle[arm].front()};
    Eigen::MatrixXd powers = Eigen::MatrixXd::Ones(count, degree + 1);
    Eigen::VectorXd t(count), values(count);
    for (Eigen::Index i = 0; i < count; ++i) {
        const auto sample = samples[static_cast<std::size_t>(i)];
        t[i] = piece.time_s[sample] - center;
        values[i] = piece.angle[arm][sample];
    }
    const double span = t.cwiseAbs().maxCoeff();
    for (Eigen::Index k = 1; k <= degree; ++k) powers.col(k) = powers.col(k - 1).cwiseProduct(t / span);
    const Eigen::VectorXd c = (powers.transpose() * powers).ldlt().solve(powers.transpose() * values);
    if (!c.allFinite()) return {values[0]};
    const double rest = (values - powers * c).norm() / std::sqrt(static_cast<double>(count));
    return {c[0], c[1] / span, 2 * c[2] / (span * span), rest};
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
            const auto samples = samples_around(piece, arm, time_s, window);
            fit = local_fit(piece, arm, samples, time_s);
            if (fit.rms <= noises * track.noise[arm] || samples.size() <= least_points) break;
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
    const Eigen::Vector3d of_second = second.colPivHouseholderQr().solve(right);
    driven *= of_second[0];
    const Eigen::Vector3d of_first = first.colPivHouseholderQr().solve(driven);
    const auto share = [](const Eigen::VectorXd& rest, const Eigen::VectorXd& all) {
        return all.squaredNorm() > 0 ? rest.squaredNorm() / all.squaredNorm() : 1.0;
    };
    result.unexplained = std::max(share(right - second * of_second, right), share(driven - first * of_first, driven));
    result.inertia = of_first[0], result.coupling = of_second[0];
    result.gravity = {of_first[1], of_second[1]};
    result.is_physical = std::isfinite(of_first.sum() + of_second.sum()) && of_second[0] > 0 && of_first[0] > 0 &&
                         of_first[1] > 0 && of_second[1] > 0;
    return result;
}

}  // namespace doppel
