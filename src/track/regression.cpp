#include "track/regression.hpp"

#include "base/error.hpp"
#include "numeric/portable_math.hpp"
#include "numeric/sin_cos.hpp"
#include "numeric/solvers.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

constexpr int degree = 5;
constexpr std::size_t min_points = degree + 3;

/// The samples of a link in a window around a time, without outliers. The window is shifted to have its full width near
/// the ends of the piece, and widened to contain `enough` samples.
std::vector<std::size_t> samples_around(const TrackPiece& piece, std::size_t link, double time_s, double window,
                                        std::size_t enough) {
    const auto& times = piece.time_s;
    const double from = std::max(times.front(), std::min(time_s - window / 2, times.back() - window));
    auto first = static_cast<std::size_t>(std::ranges::lower_bound(times, from) - times.begin()), last = first;
    std::vector<std::size_t> samples;
    const auto take = [&](std::size_t i) {
        if (!piece.is_outlier[link][i]) samples.push_back(i);
    };
    while (last < times.size() && times[last] <= from + window) take(last++);
    while (samples.size() < enough && (first > 0 || last < times.size())) {
        const bool back = first > 0 && (last == times.size() || time_s - times[first - 1] < times[last] - time_s);
        take(back ? --first : last++);
    }
    std::ranges::sort(samples);
    return samples;
}

/// Least squares in N unknowns; each equation is row · x = value.
template <int N>
struct Equations {
    Eigen::Matrix<double, N, N> matrix = Eigen::Matrix<double, N, N>::Zero();
    Eigen::Matrix<double, N, 1> right = Eigen::Matrix<double, N, 1>::Zero();
    double squares = 0;

    void add(const Eigen::Matrix<double, N, 1>& row, double value) {
        matrix += row * row.transpose();
        right += row * value;
        squares += value * value;
    }
    Eigen::Matrix<double, N, 1> solution() const {
        auto a = matrix;
        auto x = right;
        solve_positive_definite(a, x);
        return x;
    }
};

LinkEstimate link_estimate(const TrackPiece& piece, std::size_t link, const std::vector<std::size_t>& samples,
                           double center) {
    const auto count = samples.size();
    if (count < degree + 1) return {piece.angle[link].front()};
    const double span = std::max(center - piece.time_s[samples.front()], piece.time_s[samples.back()] - center);
    const auto powers_at = [&](std::size_t sample) {
        Eigen::Matrix<double, degree + 1, 1> powers;
        powers[0] = 1;
        for (int k = 1; k <= degree; ++k) powers[k] = powers[k - 1] * ((piece.time_s[sample] - center) / span);
        return powers;
    };
    Equations<degree + 1> equations;
    for (const auto sample : samples) equations.add(powers_at(sample), piece.angle[link][sample]);
    const auto c = equations.solution();
    if (!c.allFinite()) return {piece.angle[link][samples.front()]};
    double rest = 0;
    for (const auto sample : samples) rest += std::pow(piece.angle[link][sample] - powers_at(sample).dot(c), 2);
    return {c[0], c[1] / span, 2 * c[2] / (span * span), std::sqrt(rest / static_cast<double>(count))};
}

/// Long enough for its polynomial to average out the noise, short compared with a swing.
double window_of(const Track& track) {
    constexpr double shortest = 0.06, longest = 0.2, samples = 12;
    const auto& piece = track.pieces.front();
    const double interval = piece.duration() / static_cast<double>(piece.size() - 1);
    const double noise = std::max(track.noise[0], track.noise[1]);
    // the acceleration has an error of about 27 noise/(window² √samples): to be some tenths of rad/s²
    const double quiet = portable_pow(27 * noise * std::sqrt(interval) / 0.5, 0.4);
    return std::clamp(std::max(quiet, samples * interval), shortest, longest);
}

}  // namespace

LinkEstimates estimate_at(const Track& track, const TrackPiece& piece, double time_s, double longer) {
    // encoder errors are correlated over some samples, which the sample-to-sample noise does not show
    constexpr double noises = 3, shortest_s = 1e-6;
    const double longest = longer * window_of(track);
    LinkEstimates both{};
    for (std::size_t link = 0; link < 2; ++link)
        for (double window = longest; window > shortest_s; window /= 2) {
            auto samples = samples_around(piece, link, time_s, window, min_points);
            const bool has_few = samples.size() <= min_points;
            // coarse ones: through the nearest
            if (has_few && window == longest) samples = samples_around(piece, link, time_s, 0, degree + 1);
            both[link] = link_estimate(piece, link, samples, time_s);
            if (has_few || both[link].rms <= noises * track.noise[link]) break;
        }
    return both;
}

std::vector<LinkEstimates> estimates_of(const Track& track, const std::atomic<bool>& stop, double longer) {
    std::vector<LinkEstimates> all;
    const double half = longer * window_of(track) / 2;
    for (const auto& piece : track.pieces)
        for (double time = piece.time_s.front() + half; time < piece.time_s.back() - half; time += half) {
            throw_if_set(stop);
            all.push_back(estimate_at(track, piece, time, longer));
        }
    return all;
}

Regression regress(const std::vector<LinkEstimates>& estimates) {
    Regression result;
    if (estimates.size() < 8) return result;
    // the equation of the second link, whose own acceleration has no unknown factor: −θ2″ = C (cosδ θ1″ − sinδ ω1²) +
    // D2 sinθ2 + friction
    Equations<3> second, first;
    for (const auto& [one, two] : estimates) {
        const SinCos<double> between(one.angle - two.angle), turn1(one.angle), turn2(two.angle);
        second.add({between.cos * one.acceleration - between.sin * one.rate * one.rate, turn2.sin, two.rate - one.rate},
                   -two.acceleration);
        first.add({one.acceleration, turn1.sin, one.rate},
                  -(between.cos * two.acceleration + between.sin * two.rate * two.rate));
    }
    const auto of_second = second.solution();
    const Eigen::Vector3d of_first = of_second[0] * first.solution();  // divided by C
    const auto share = [](const Equations<3>& equations) {
        const double explained = equations.right.dot(equations.solution());
        return explained > 0 ? std::max(1 - explained / equations.squares, 0.0) : 1;  // also if it is not a number
    };
    result.unexplained = std::max(share(second), share(first));
    result.ratios = {of_first[0], of_second[0], of_first[1], of_second[1]};
    result.is_physical = std::isfinite(of_first.sum() + of_second.sum()) && std::ranges::min(result.ratios) > 0;
    return result;
}

}  // namespace doppel
