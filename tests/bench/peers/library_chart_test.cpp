#include "library_chart.hpp"

#include "figure/support.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <set>

namespace doppel::library_chart_test {

/// The chart of a film of one second that is released from these angles.
FigurePreset chart(const std::string& angles, const std::string& models_and_methods,
                   std::vector<ExternalMethod> methods, const std::vector<std::string>& more) {
    const auto path = std::filesystem::path(DOPPEL_TEST_OUTPUT) / fmt::format("film-of-libraries-{}.toml", getpid());
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << "[scene]\nduration_s = 1\n[system]\nangle_deg = " << angles << "\n";
    const auto text = fmt::format(
        "[scene]\nkind = \"work-precision\"\n[work_precision]\nscene = \"{}\"\n{}"
        "[chart]\ncost = \"evaluations\"\n",
        path.string(), models_and_methods);
    auto figure = library_chart({"x", "presets/x.toml", text}, sets(more), std::move(methods));
    std::filesystem::remove(path);
    return figure;
}

/// Has no motion, at a given cost.
class Resting final : public Motion {
public:
    Resting(double setting, Effort effort) : setting_(setting), effort_(effort) {}
    void advance(const std::atomic<bool>& /*stop*/) override {
        if (setting_ < minimum) throw method_failed("resting: it gives up");
    }
    void advance_within(double /*share*/, const std::atomic<bool>& /*stop*/) override {}
    Observation observe() const override {
        Observation seen;
        seen.bobs.resize(2);
        return seen;
    }
    Effort effort() const override { return effort_; }

private:
    static constexpr double minimum = 1e-3;
    double setting_;
    Effort effort_;
};

/// A method with settings from 1e-4 to 1e-2, which gives up below 1e-3.
ExternalMethod resting(const std::string& name, long steps, long evaluations, bool gives_up) {
    return {name, true, 1e-4, 1e-2, [=](const Pendulum<double>&, double, double setting) {
                return std::make_unique<Resting>(gives_up ? setting : 1,
                                                 Effort{.steps = steps, .evaluations = evaluations});
            }};
}

TEST(LibraryChart, HasAllSettings) {
    const auto figure =
        chart("[90, 90]", "models = [\"angles\"]\nmethods = [\"taylor\"]\n", {resting("idle", 3, 7, true)}, {});
    const Table table(table_text(figure, computed(figure)));
    int given_up = 0, done = 0;
    const auto cell = [&](const auto& row, const char* column) {
        return row.at(std::ranges::find(table.columns, column) - table.columns.begin());
    };
    for (const auto& row : table.words) {
        if (cell(row, "method") != "peer:idle") continue;
        EXPECT_EQ(cell(row, "model"), "angles");
        ++(cell(row, "angle_error_rad") == "failed" ? given_up : done);
        EXPECT_EQ(cell(row, "steps"), "3");
    }
    EXPECT_EQ(done, 3);      // 1e-2, 3.16e-3, 1e-3
    EXPECT_EQ(given_up, 2);  // 3.16e-4, 1e-4
}

TEST(LibraryChart, HasTheirFiveBestAndDoppelsBest) {
    // all report no motion, which is correct within 1e-8 for a pendulum almost at rest
    std::vector<ExternalMethod> libraries;
    for (const int cost : {70, 10, 60, 20, 50, 30, 40})
        libraries.push_back(resting(fmt::format("at {}", cost), 1, cost, false));
    const auto figure = chart("[1e-7, 0]", "methods = [\"rk4\", \"taylor\", \"euler\"]\n", libraries,
                              {"work_precision.most_evaluations=5000", "work_precision.models=[\"angles\"]"});
    const auto page = page_of(figure);
    std::set<std::string> labels;
    for (const auto& curve : page.panels[0].curves) labels.insert(curve.label);
    labels.erase("");
    for (const int cost : {10, 20, 30, 40, 50}) EXPECT_TRUE(labels.contains(fmt::format("at {}", cost))) << cost;
    EXPECT_EQ(labels.size(), 5u + 1);
    EXPECT_EQ(std::count_if(labels.begin(), labels.end(), [](auto& label) { return label.ends_with(" of Doppel"); }),
              1);
    EXPECT_EQ(std::ranges::count(page.panels[0].curves, Background::line, &Curve::background),
              2);  // the other libraries' methods, and none of Doppel's
    EXPECT_TRUE(page.captions[0].starts_with("In colour the five best methods of other libraries")) << page.captions[0];
}

}  // namespace doppel::library_chart_test
