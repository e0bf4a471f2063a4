// docs/encoders.csv, as measured by tests/bench/encoders: no other setting of H.264 is better than the default.
#include "bench/encoders/encoder_quality.hpp"
#include "bench/encoders/encoder_settings.hpp"
#include "film/runs.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>

namespace doppel::kept_encoders_test {

/// A setting on a film, at the quality of the default setting.
struct Point {
    double cpu, bytes;
};
/// By film ("butterfly 1920x1080 dark") and setting.
using Points = std::map<std::string, std::map<std::string, Point>>;

Points kept_points() {
    const auto lines = lines_of(DOPPEL_SOURCE_DIR "/docs/encoders.csv");
    const auto columns = cells_of(lines.at(0));
    Points points;
    for (std::size_t k = 1; k < lines.size(); ++k) {
        const auto cells = cells_of(lines[k]);
        std::map<std::string, std::string> row;
        for (std::size_t i = 0; i < cells.size(); ++i) row[columns.at(i)] = cells[i];
        points[row["film"] + " " + row["width_px"] + "x" + row["height_px"] + " " + row["theme"]][row["setting"]] = {
            std::stod(row["cpu_at_equal_quality"]), std::stod(row["bytes_at_equal_quality"])};
    }
    return points;
}

/// The settings that need less of both than the default does: 1 % fewer bytes, and less CPU time by more than
/// repeated measurements differ on a busy machine.
std::set<std::string> better_than_default(const std::map<std::string, Point>& settings) {
    constexpr double cpu_slack = 0.1, bytes_slack = 0.01;
    const auto [cpu, bytes] = settings.at("doppel");
    std::set<std::string> better;
    for (const auto& [name, point] : settings)
        if (point.cpu < cpu * (1 - cpu_slack) && point.bytes < bytes * (1 - bytes_slack)) better.insert(name);
    return better;
}

TEST(KeptEncoders, HoldEverySettingOnEveryKindOfFilm) {
    const auto points = kept_points();
    std::set<std::string> names;
    for (const auto& setting : encoder_settings)
        if (setting.codec == "h264") names.emplace(setting.name);
    for (const char* film : {"butterfly 1920x1080 dark", "butterfly 3840x2160 dark", "fan 1280x720 dark",
                             "phase-dance 1280x720 dark", "whip 1280x720 dark", "two-methods 1280x720 light"}) {
        ASSERT_TRUE(points.contains(film)) << film;
        std::set<std::string> measured;
        for (const auto& [name, point] : points.at(film)) {
            measured.insert(name);
            EXPECT_GT(point.cpu, 0) << film << ", " << name;
            EXPECT_GT(point.bytes, 0) << film << ", " << name;
        }
        EXPECT_EQ(measured, names) << film << ": after a change of settings, measure anew";
    }
}

TEST(KeptEncoders, NoSettingBeatsTheDefaultInTimeAndSize) {
    for (const auto& [film, settings] : kept_points()) {
        EXPECT_EQ(better_than_default(settings), std::set<std::string>()) << film;
        EXPECT_LT(settings.at("doppel").cpu, 0.6) << film << ", of veryfast";
        // and a setting that needs less is found
        auto more = settings;
        const auto [cpu, bytes] = settings.at("doppel");
        more["less of both"] = {0.88 * cpu, 0.98 * bytes};
        more["less of one"] = {0.5 * cpu, 1.01 * bytes};
        EXPECT_EQ(better_than_default(more), std::set<std::string>{"less of both"}) << film;
    }
}

}  // namespace doppel::kept_encoders_test
