#include "analysis/drift.hpp"

#include "figure/support.hpp"

#include <gtest/gtest.h>

#include <map>

namespace doppel::drift_test {

const std::string kind = "[scene]\nkind = \"series\"\n";

/// The preset's double pendulum, for a short time.
FigurePreset short_drift(int seconds, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{fmt::format("series.duration_s={}", seconds), "series.points_per_decade=5"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return figure_of("drift", arguments);
}

TEST(Drift, EulerGainsEnergyByTheClosedForm) {
    // a pendulum of small amplitude: E + m g l grows by 1 + z² a step, z² = h² g/l; E0 = −m g l cos A
    const double amplitude = 0.1 * pi / 180, h = 1.0 / 200, z2 = h * h * 9.8;
    const auto figure = figure_from(
        kind +
        "[system]\nlinks = 1\nangle_deg = [0.1]\n"
        "[series]\nquantity = \"errors\"\nevaluations_per_s = 200\nduration_s = 40\nmethods = [\"euler\"]\n");
    const auto table = table_of(figure);
    ASSERT_EQ(table.rows.size(), 2u * 18);  // minimal coordinates first, then constraints
    for (std::size_t i = 0; i < 18; ++i) {
        const double time = table.rows[i][3];
        // the last check in a window has the largest error; there are four checks per second
        const double steps = std::floor(time * 4 + 1e-9) / 4 / h;
        const double gained = std::expm1(steps * std::log1p(z2)) * (1 - std::cos(amplitude)) / std::cos(amplitude);
        EXPECT_EQ(table.rows[i][2], h);
        EXPECT_NEAR(table.rows[i][4] / gained, 1, 1e-5) << time;  // measured 3.4e-6
    }
}

TEST(Drift, EveryMethodTakesItsEvaluations) {
    const auto figure = short_drift(40);
    const auto trials = computed(figure);
    EXPECT_EQ(trials.size(), 10u + 10 + 1);
    std::map<std::string, double> settings;
    for (const auto& row : Table(table_text(figure, trials)).words) settings[row[0] + ' ' + row[1]] = std::stod(row[2]);
    for (const auto& trial : trials) {
        const auto cost = row_of<DriftCost>(trial);
        if (cost.setting == settings.at("taylor angles")) {
            EXPECT_LT(cost.evaluations_per_s, 500);  // 446: even the smallest tolerance needs no more evaluations
        } else {
            EXPECT_NEAR(cost.evaluations_per_s, 500, 5) << cost.setting;  // measured 499.6 … 501.8
        }
    }
    EXPECT_EQ(settings.at("taylor angles"), 8.89e-16);
    EXPECT_EQ(settings.at("rk4 angles"), 1 / 125.0);
    EXPECT_EQ(settings.at("adams angles"), 1 / 250.0);
}

TEST(Drift, FindsTheLawOfGrowth) {
    const auto table = table_of(
        short_drift(200, {"series.methods=[\"euler\", \"rk4\", \"dopri5\", \"gauss6\", \"rattle\", \"rattle6\"]"}));
    // of the energy (column 4) or the rods (5); the last time
    const auto growth = [&](const char* method, const char* model, std::size_t column = 4) {
        std::vector<double> times, errors{0};
        for (std::size_t i = 0; i < table.rows.size(); ++i)
            if (table.words[i][0] == method && table.words[i][1] == model)
                times.push_back(table.rows[i][3]), errors.push_back(std::fmax(errors.back(), table.rows[i][column]));
        errors.erase(errors.begin());
        return std::pair(growth_of(times, errors, times.back() < 200 ? times.back() : NAN), times.back());
    };
    using Kind = Growth::Kind;
    const auto bounded = growth("gauss6", "angles").first;
    EXPECT_EQ(bounded.kind, Kind::bounded);
    EXPECT_NEAR(bounded.exponent, 0, 0.2);  // measured 0.16
    for (const char* name : {"rattle", "rattle6"})
        EXPECT_NEAR(growth(name, "constraints").first.exponent, 0, 0.2) << name;  // measured 0.09, 0.03
    for (const auto& [method, model] :
         {std::pair("rk4", "angles"), {"dopri5", "angles"}, {"rk4", "projected constraints"}}) {
        EXPECT_NEAR(growth(method, model).first.exponent, 1, 0.12) << method;  // measured 0.91, 1.00, 0.96
        EXPECT_EQ(growth(method, model).first.kind, Kind::linear) << method;
    }
    for (const char* name : {"rk4", "dopri5"}) {
        EXPECT_NEAR(growth(name, "constraints", 5).first.exponent, 2, 0.05) << name;  // measured 2.01
        EXPECT_EQ(growth(name, "constraints", 5).first.kind, Kind::steeper) << name;
    }
    const auto [failed, end_s] = growth("euler", "angles");
    EXPECT_EQ(failed.kind, Kind::failed);
    EXPECT_NEAR(end_s, 87, 1);  // measured 87.25
}

TEST(Drift, HasNoRodErrorForMethodsThatPreserveRods) {
    const auto table =
        table_of(short_drift(200, {"series.methods=[\"semi-implicit-euler\", \"rattle\", \"rattle6\"]"}));
    ASSERT_EQ(table.rows.size(), 5u * 13);
    // the methods that conserve the constraints come last: rattle, rattle6 and projected rk4
    for (std::size_t i = 2 * 13; i < table.rows.size(); ++i) EXPECT_LT(table.rows[i][5], 2e-15);  // measured 2e-16
    EXPECT_GT(table.rows[2 * 13 - 1][5], 0.05);  // measured 0.27: the others do not conserve them
    for (const auto& row : table.rows) {
        EXPECT_LT(row[4], 1);
        EXPECT_LT(row[5], 1);
        EXPECT_LE(row[3], 200);
    }
    EXPECT_EQ(table.columns,
              (std::vector<std::string>{"method", "model", "setting", "time_s", "energy_error", "length_error_m"}));
}

TEST(Drift, SummarisesTheResultInOneLine) {
    const auto caption = [](const std::string& methods) {
        const auto figure = short_drift(100, {"series.projected=[]", "series.methods=" + methods});
        const auto page = page_of(figure);
        EXPECT_EQ(page.captions.size(), 1u);
        return page.captions.front();
    };
    EXPECT_EQ(
        caption("[\"euler\", \"rk4\", \"rattle6\"]"),
        "The error of the energy stays bounded for 100 s with rattle6; ∝ tells how the others grow, a dot marks a "
        "failed run.");
    EXPECT_EQ(caption("[\"gauss4\"]"), "The error of the energy stays bounded for 100 s with gauss4.");
    EXPECT_EQ(caption("[\"rk4\"]"), "No method keeps the error of the energy bounded; ∝ tells how the others grow.");
}

}  // namespace doppel::drift_test
