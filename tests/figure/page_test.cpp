#include "figure/page.hpp"

#include "figure/support.hpp"
#include "output/packed.hpp"

#include <gtest/gtest.h>

namespace doppel::figure_page_test {

using test::expect_error;
using test::fresh_folder;

const std::string map_text =
    "[scene]\nkind = \"grid\"\nduration_s = 0.6\n[grid]\nquantity = \"flip_time\"\n"
    "[grid.x]\nfrom = -180\npoints = 12\n[grid.y]\nkey = \"theta2_deg\"\nfrom = -180\npoints = 6\n";
const std::string sweep_text =
    "[scene]\nkind = \"grid\"\nduration_s = 0.5\n[grid]\ndifference = 0.003\n[grid.x]\nfrom = 10\nto = 170\npoints = "
    "9\n";

using test::data_of;

std::string html_of(const FigurePreset& figure) {
    auto drawn = page_of(figure);
    drawn.title = figure.title, drawn.subtitle = figure.subtitle;
    return figure_page(figure, drawn);
}

std::vector<double> numbers_in(const std::string& text) {
    std::vector<double> numbers;
    std::istringstream words(text);
    for (std::string word; words >> word;) numbers.push_back(std::stod(word));
    return numbers;
}

TEST(FigurePage, HoldsTheNumbersOfTheTable) {
    const auto figure = figure_from(sweep_text);
    const auto data = data_of(html_of(figure));
    ASSERT_EQ(data["panels"].size(), 1u);
    const auto& curve = data["panels"][0]["curves"][0];
    const auto x = numbers_in(curve["x"]), y = numbers_in(curve["y"]);
    const Table table(table_text(figure, computed(figure)));
    ASSERT_EQ(x.size(), 9u);
    for (std::size_t i = 0; i < x.size(); ++i) {
        EXPECT_DOUBLE_EQ(x[i], table.rows[i][0]);
        EXPECT_NEAR(y[i], table.rows[i][1], 1e-5 * std::abs(table.rows[i][1]));
    }
}

/// The page's form has one system, and sets both sides.
TEST(FigurePage, ReleasesOnlyWhatItsFormCanSet) {
    const auto has_releases = [](const std::vector<std::string>& sets) {
        return figure_from(sweep_text, sets).experiment->releases().has_value();
    };
    EXPECT_TRUE(has_releases({}));
    EXPECT_FALSE(has_releases({"grid.color.key=system.gravity_m_per_s2", "grid.color.values=[9.8, 1.6]"}));
    EXPECT_FALSE(has_releases({"grid.panel.key=system.gravity_m_per_s2", "grid.panel.values=[9.8, 1.6]"}));
    EXPECT_FALSE(has_releases({"grid.difference=0", "grid.x.key=b.angle_deg[0]"}));
}

TEST(FigurePage, HoldsTheCellsOfAMapFromTheLowerLeft) {
    const auto figure = figure_from(map_text);
    const auto drawn = page_of(figure);
    const auto data = data_of(html_of(figure));
    const auto& panel = data["panels"][0];
    const auto& map = panel["map"];
    EXPECT_EQ(map["columns"], 12);
    EXPECT_EQ(map["rows"], 6);
    for (const char* axis : {"x", "y"})
        EXPECT_EQ((Json{panel[axis]["from"], panel[axis]["to"]}), (Json{-180.0, 180.0}));
    EXPECT_EQ(map["none"], "no flip within 0.6 s");
    EXPECT_TRUE(panel["curves"].empty());
    const auto values = numbers_in(map["values"]);
    const auto& wanted = drawn.panels[0].map->values;
    ASSERT_EQ(values.size(), wanted.size());
    long finite = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        EXPECT_EQ(std::isnan(values[i]), std::isnan(wanted[i]));
        finite += std::isfinite(wanted[i]);
        if (std::isfinite(wanted[i])) {
            EXPECT_NEAR(values[i], wanted[i], 1e-3 * wanted[i]);
        }
    }
    EXPECT_GT(finite, 0);
}

TEST(FigurePage, AxesAreWhereThePictureHasThem) {
    // each panel marks one point, drawn at its coordinates
    Figure figure{.columns = 2};
    for (int i = 0; i < 4; ++i) {
        Plot plot{.x = {.label = "x", .low = 1, .high = 1000, .logarithmic = i % 2 == 1},
                  .y = {.label = "y", .low = 5, .high = -3}};
        if (i == 3) plot.right = PlotAxis{.label = "right", .low = 0, .high = 1};
        plot.curves.push_back({.label = "", .x = {100, 200}, .y = {0.5, 0.5}, .mark = Mark::points, .right = i == 3});
        figure.panels.push_back(plot);
    }
    const Theme& theme = themes[0];
    const auto page = compose(figure, {1600, 1200}, theme, 2);
    const auto picture = picture_of(page);
    ASSERT_EQ(page.panels.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
        const auto& [x, y, right] = page.panels[i];
        EXPECT_EQ(right.has_value(), i == 3);
        const auto* pixel = picture.at(static_cast<int>(page.scale * x.at(100)),
                                       static_cast<int>(page.scale * (right ? *right : y).at(0.5)));
        const auto color = bytes_of(theme.palette[0]);
        for (int channel = 0; channel < 3; ++channel) EXPECT_NEAR(pixel[channel], color[channel], 2) << i;
    }
}

TEST(FigurePage, TellsItsPlayerTheKeysOfReleases) {
    const auto keys = [](const std::string& text, const std::vector<std::string>& sets = {}) {
        return data_of(html_of(figure_from(text, sets)))["release"];
    };
    EXPECT_EQ(keys(map_text), (Json{"system.angle_deg[0]", "system.angle_deg[1]"}));
    EXPECT_EQ(keys(sweep_text), (Json{"system.angle_deg[0]"}));
    EXPECT_EQ(keys(sweep_text, {"grid.x.key=\"system.angle_deg[1]\""}), (Json{"system.angle_deg[1]"}));
    EXPECT_EQ(keys(sweep_text, {"grid.x.key=\"system.gravity_m_per_s2\"", "grid.quantity=\"distance_at_end\""}),
              Json::array());
    EXPECT_EQ(keys(sweep_text, {"system.joint_viscous_N_m_s=0.1"}), Json::array());
    EXPECT_EQ(keys(sweep_text, {"system.links=4"}), Json::array());
}

TEST(FigurePage, TitlesAndLabelsOfAnyLettersAreText) {
    auto figure = figure_from(sweep_text);
    const std::string hostile = "</script><!-- <b>\"'&{}";
    figure.title = figure.subtitle = hostile;
    Figure drawn{.title = hostile, .subtitle = hostile, .captions = {hostile}};
    drawn.panels.push_back({.title = hostile, .x = {.label = hostile}, .y = {.label = hostile}});
    drawn.panels[0].curves.push_back({.label = hostile, .x = {1, 2}, .y = {1, NAN}});
    const auto page = figure_page(figure, drawn);
    const auto panel = data_of(page)["panels"][0];
    for (const auto& text : {panel["title"], panel["x"]["label"], panel["curves"][0]["label"]})
        EXPECT_EQ(text, hostile);
    EXPECT_EQ(page.find(hostile), std::string::npos);
    EXPECT_EQ(page.find("<b>"), std::string::npos);
    EXPECT_NE(page.find("<h1 dir=\"auto\">&lt;/script&gt;&lt;!-- &lt;b&gt;&quot;&#39;&amp;{}</h1>"), std::string::npos);
    EXPECT_EQ(page.find("style=\""), std::string::npos);  // the security policy blocks inline styles
}

TEST(FigurePage, IsOneFileBesideTableAndManifest) {
    const auto out = fresh_folder();
    auto figure = figure_from(map_text, {"chart.format=\"html\""});
    run_figure(figure, {.out = out});
    const auto page = test::bytes_of(out / "x/x.html");
    EXPECT_TRUE(page.starts_with("<!DOCTYPE html>\n<!-- Doppel figure -->"));
    EXPECT_LT(page.size(), 185'000u);  // measured 158 kB with Cairo 1.18; the player takes 33 kB of it
    EXPECT_TRUE(std::filesystem::exists(out / "x/x.csv"));
    EXPECT_TRUE(std::filesystem::exists(out / "x/x.json"));
    EXPECT_FALSE(std::filesystem::exists(out / "x/x.png"));
    figure = figure_from(map_text, {"chart.format=\"html\"", "grid.x.points=2000", "grid.y.points=600"});
    expect_error(ExitCode::bad_input, {"at most 1 000 000 cells; this one has 1 200 000"},
                 [&] { run_figure(figure, {.out = out}); });
}

}  // namespace doppel::figure_page_test
