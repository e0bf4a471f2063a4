#pragma once

#include "numeric/rational.hpp"

#include <array>
#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace doppel {

/// Two ideal links, by the decimals of their numbers, with attracting bodies.
struct DecimalPendulum {
    struct Droplet {
        std::string constant, mass;        // G, m³/(kg s²); kg
        std::array<std::string, 2> place;  // m

        friend bool operator==(const Droplet&, const Droplet&) = default;
    };
    std::array<std::string, 2> mass, length, angle_deg, omega_deg_per_s;  // kg, m, °, °/s
    std::string gravity;                                                  // m/s²
    std::vector<Droplet> droplets = {};

    friend bool operator==(const DecimalPendulum&, const DecimalPendulum&) = default;
};

/// Proved bounds of a number, inclusive.
struct Interval {
    double low = 0, high = 0;
};

/// The precisions of enclosures, in bits: double, quad, and more.
inline constexpr std::array certified_bits{53, 113, 256};

struct CertifiedPairSpec {
    std::vector<DecimalPendulum> sides;  // one or two
    Rational interval{1, 120};           // between samples, s
    long samples = 0;                    // 0 … samples
    /// Fewer bits suffice if all angles (rad) and rates (rad/s) are known this well, and the distance to 1 %.
    double sufficient_radius = 1e-6;
    std::optional<int> bits = {};  // only with these
    int jobs = 1;
};

/// Enclosures of the true motion of one or two sides at samples 0, 1 … as far as all are proved. The numbers of the
/// system are the decimals themselves.
struct CertifiedPair {
    int bits = 0;
    std::vector<std::vector<std::array<Interval, 4>>> sides;  // at each sample: θ1, θ2 (rad), ω1, ω2 (rad/s)
    std::vector<std::vector<double>> radius;                  // the largest of both angles, rad
    std::vector<Interval> distance;                           // of two sides, analysis/difference.hpp

    std::size_t samples() const { return sides.front().size(); }
};

/// Called with the samples done and to do; may throw.
using CertifiedReport = std::function<void(long done, long total)>;

/// With the fewest bits that suffice, otherwise with the most. Throws what `report` throws.
CertifiedPair certified_pair(const CertifiedPairSpec& spec, const CertifiedReport& report);

}  // namespace doppel
