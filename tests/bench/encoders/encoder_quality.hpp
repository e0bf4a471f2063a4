#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace doppel {

/// The results of a setting at one quality, per frame. The values of moving parts are NaN if nothing moves.
struct EncodedRow {
    double crf, cpu_ms, bytes, psnr_db, moving_psnr_db, ssim, moving_ssim;
};

/// The cost of a setting relative to another one at equal quality; NaN if it never reaches that quality.
struct EqualQuality {
    double bytes, cpu;
};

/// The four measures of quality, scaled to be almost linear in the logarithm of the bytes.
inline std::array<double, 4> measures_of(const EncodedRow& row) {
    // finite without any difference
    const auto decibels = [](double ssim) { return -10 * std::log10(std::max(1 - ssim, 1e-10)); };
    return {row.psnr_db, row.moving_psnr_db, decibels(row.ssim), decibels(row.moving_ssim)};
}

/// y at x of the straight line through the two points (x decreasing) nearest to x; NaN if they coincide.
inline double along(double x, std::span<const double> xs, std::span<const double> ys) {
    std::size_t k = 0;
    while (k + 2 < xs.size() && x < xs[k + 1]) ++k;
    if (xs[k + 1] == xs[k]) return std::numeric_limits<double>::quiet_NaN();
    return ys[k] + (ys[k + 1] - ys[k]) * (x - xs[k]) / (xs[k + 1] - xs[k]);
}

/// Rows at three or more qualities, the best first, compared with the middle one of the reference. Interpolates between
/// the measured qualities; the worst of the measures counts, without those of moving parts if nothing moves.
inline EqualQuality equal_quality(std::span<const EncodedRow> rows, std::span<const EncodedRow> reference) {
    const auto& wanted = reference[reference.size() / 2];
    std::vector<double> log_bytes, cpu;
    for (const auto& row : rows) {
        log_bytes.push_back(std::log(row.bytes));
        cpu.push_back(row.cpu_ms);
    }
    double needed = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t m = 0; m < 4; ++m) {
        std::vector<double> measure;
        for (const auto& row : rows) measure.push_back(measures_of(row)[m]);
        const double by_measure = along(measures_of(wanted)[m], measure, log_bytes);
        if (!(needed >= by_measure) && !std::isnan(by_measure)) needed = by_measure;
    }
    return {.bytes = std::exp(needed) / wanted.bytes, .cpu = along(needed, log_bytes, cpu) / wanted.cpu_ms};
}

}  // namespace doppel
