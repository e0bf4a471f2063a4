#include "figure/preset.hpp"
#include "figure/run.hpp"
#include "figure/support.hpp"
#include "output/png.hpp"
#include "plot/plot_figures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace doppel::chart_test {

using test::bytes_of;
using test::fresh_folder;

std::string file_of(const FigurePreset& figure, const std::string& ending) {
    const auto out = fresh_folder();
    const auto result = run_figure(figure, {.out = out});
    EXPECT_EQ(names_in(out / "fig2-right"),
              (std::vector<std::string>{"fig2-right.csv", "fig2-right.json", "fig2-right" + ending}));
    return bytes_of(result.files.at(0));
}

TEST(Chart, APdfHasTheRequestedWidth) {
    const auto pdf = file_of(figure_of("fig2-right", {"grid.x.to=9", "scene.duration_s=0.5", "chart.format=\"pdf\"",
                                                      "chart.width_cm=8.6", "chart.height_cm=6"}),
                             ".pdf");
    EXPECT_TRUE(pdf.starts_with("%PDF-"));
    const auto layout = layout_of(small_sweep({"chart.format=\"pdf\"", "chart.width_cm=8.6"}).chart);
    EXPECT_NEAR(layout.width_pt, 8.6 / 2.54 * 72, 1e-9);
    EXPECT_EQ(layout.unit, 1.0f);  // labels are 20 px, which is 8 pt, the default of the key
    EXPECT_NEAR(20 * layout.scale * layout.width_pt / layout.picture.width, 8, 0.01);
}

TEST(Chart, AnSvgIsWrittenWithoutOpenGl) {
    const auto svg = file_of(small_sweep({"chart.format=\"svg\""}), ".svg");
    EXPECT_NE(svg.find("Mean divergence of a pair"), std::string::npos);
    EXPECT_NE(svg.find("width=\"240pt\" height=\"135pt\""), std::string::npos);  // 320 × 180 px of 3/4 pt
}

TEST(Chart, APngOnPaperHasItsResolution) {
    const auto figure = small_sweep({"chart.width_cm=8.6", "chart.dpi=600"});
    const auto png = file_of(figure, ".png");
    const auto at = png.find("pHYs");
    ASSERT_NE(at, std::string::npos);
    const auto number = [&](std::size_t from) {
        std::uint32_t all = 0;
        for (std::size_t i = 0; i < 4; ++i) all = all << 8 | static_cast<unsigned char>(png[from + i]);
        return all;
    };
    EXPECT_NEAR(number(at + 4) * 0.0254, 600, 0.2);  // one pixel is the smallest possible difference of the width
    EXPECT_EQ(number(at + 8), number(at + 4));
    EXPECT_EQ(png[at + 12], 1);
    EXPECT_NEAR(layout_of(figure.chart).picture.width, 8.6 / 2.54 * 600, 0.5);
    EXPECT_NE(png.find("fig2-right.json"), std::string::npos) << "its metadata is a film's";
    EXPECT_LT(at, png.find("IDAT"));
}

std::vector<std::string> labels_of(const FigurePreset& figure) {
    std::vector<std::string> labels;
    for (const auto& label : items_of<Label>(compose_figure(figure, computed(figure)).items))
        labels.push_back(label.text);
    return labels;
}

TEST(Chart, TextsCanBeRemovedOrReplaced) {
    const auto has = [](const std::vector<std::string>& all, std::string_view start) {
        return std::any_of(all.begin(), all.end(), [&](const auto& text) { return text.starts_with(start); });
    };
    const auto labels = [](std::vector<std::string> sets) {
        sets.insert(sets.end(), {"grid.x.to=9", "scene.duration_s=0.5"});
        return labels_of(figure_of("fig2-right", sets));
    };
    const auto as_is = labels({});
    EXPECT_TRUE(has(as_is, "Mean divergence of a pair"));
    EXPECT_TRUE(has(as_is, "two links"));
    EXPECT_TRUE(has(as_is, "Erratum"));
    const auto bare = labels({"chart.title=false", "chart.captions=false"});
    EXPECT_FALSE(has(bare, "Mean divergence of a pair") || has(bare, "two links") || has(bare, "Erratum"));
    EXPECT_EQ(bare.size(), as_is.size() - 3);
    const auto own = labels({"chart.title=\"Mine\"", "chart.captions=[\"One\", \"Two\"]"});
    EXPECT_TRUE(has(own, "Mine") && has(own, "One") && has(own, "Two"));
    EXPECT_FALSE(has(own, "two links") || has(own, "Erratum"));
    const auto both = labels({"chart.title=[\"A\", \"B\"]"});
    EXPECT_TRUE(std::ranges::find(both, "A") != both.end() && std::ranges::find(both, "B") != both.end());
}

TEST(Chart, AnotherQuantityFromTheCommandLineDropsTheKeysOfTheFiles) {
    const std::string text = "[scene]\nkind = \"grid\"\n[grid]\nquantity = \"exponent\"\nexponent_duration_s = 99\n";
    const PresetText preset{"x", "x.toml", text, "x.toml"};
    EXPECT_NO_THROW(read_figure(preset, {parse_set("grid.quantity=flip_time")}));
    expect_refused({"--set grid.exponent_duration_s", "is only for exponent"}, [&] {
        read_figure(preset, {parse_set("grid.quantity=flip_time"), parse_set("grid.exponent_duration_s=3")});
    });
    const auto flips = figure_of("fig2-right", {"grid.quantity=flip_time"});
    EXPECT_EQ(flips.title, "fig2-right");
    EXPECT_EQ(flips.erratum, "");
    EXPECT_EQ(figure_of("fig2-right", {"grid.x.key=theta2_deg", "title=Mine"}).title, "Mine");
    EXPECT_NE(figure_of("fig2-right", {"grid.x.step=9"}).erratum, "");
}

TEST(Chart, KeysOfPaperNeedItsWidth) {
    for (const auto* key : {"height_cm=5", "font_pt=9", "dpi=600"})
        expect_refused({"it needs width_cm"}, [&] { small_sweep({fmt::format("chart.{}", key)}); });
    expect_refused({"with width_cm, dpi sets it"}, [] { small_sweep({"chart.width_cm=8.6", "chart.scale=2"}); });
    expect_refused({"chart.size", "width_cm and height_cm set it"}, [] {
        small_sweep({"chart.width_cm=8.6", "chart.height_cm=6"});
    });
    expect_refused({"is too large for a chart of 3 cm width; at most 7 pt is possible; it is 40"}, [] {
        small_sweep({"chart.width_cm=3", "chart.font_pt=40"});
    });
    expect_refused({"a chart of 5×2.82 cm; at most 7.9 pt is possible; it is 8"}, [] {
        figure_of("fig2-right", {"chart.width_cm=5", "chart.height_cm=2.82"});
    });
    // without a height of its own, it is higher where its texts need it
    const auto narrow = small_sweep({"chart.width_cm=5"});
    const auto page = compose_figure(narrow, computed(narrow));
    EXPECT_GT(page.size.height, layout_of(narrow.chart).picture.height);
    expect_refused({"must leave a picture of 16 to 16384 px a side"}, [] {
        small_sweep({"chart.width_cm=200", "chart.dpi=1200"});
    });
    expect_refused({"must be true, false, text or a list of text"}, [] { small_sweep({"chart.title=3"}); });
    expect_refused({"\"png\", \"pdf\", \"svg\" or \"html\""}, [] { small_sweep({"chart.format=\"eps\""}); });
}

TEST(Chart, ResolvedReadsBackToTheSame) {
    const auto figure =
        figure_of("fig2-right", {"chart.width_cm=8.6", "chart.height_cm=5", "chart.font_pt=7", "chart.dpi=200",
                                 "chart.title=false", "chart.captions=[\"One\"]", "chart.format=\"svg\""});
    const PresetText source{"fig2-right", "again.toml", figure.resolved(), "again.toml"};
    EXPECT_EQ(read_figure(source).resolved(), figure.resolved());
}

/// A journal's column.
TEST(Chart, OnPaperAllFormatsHaveTheSameTextsAndNoneIsLeftOut) {
    for (const auto& [name, arguments] : std::vector<std::pair<std::string, std::vector<std::string>>>{
             {"fig6", {"scene.duration_s=2"}},
             {"fig2-right", {"grid.x.step=20", "scene.duration_s=0.1"}},
             {"drift", {"series.duration_s=100", "series.points_per_decade=3"}},
             {"poincare", {"section.orbits=2", "section.crossings=5", "section.exponent_duration_s=20"}},
             {"stability", {"grid.x.points=4", "grid.y.points=3", "grid.x.from=0.05"}}}) {
        auto with = arguments;
        with.emplace_back("chart.width_cm=8.6");
        const auto trials = computed(figure_of(name, with));
        const auto drawn = [&](const std::string& format) {
            auto all = with;
            all.push_back("chart.format=" + format);
            return compose_figure(figure_of(name, all), trials);
        };
        const auto png = drawn("png"), pdf = drawn("pdf");
        EXPECT_TRUE(png.notes.empty()) << name;
        EXPECT_TRUE(have_sides(png.panels, 120, 90)) << name;
        const auto texts = items_of<Label>(png.items), of_pdf = items_of<Label>(pdf.items);
        // all panels are drawn, and all notes: seven methods have a limit
        const bool has_notes = name == "stability";
        const auto is_of_panel = [&](const Label& text) {
            return has_notes
                       ? text.text.starts_with("limit ")
                       : text.text == "time, s" || text.text == "θ₂, rad" || text.text.starts_with("release angle θ");
        };
        EXPECT_EQ(std::ranges::count_if(texts, is_of_panel), has_notes ? 7 : std::ssize(png.panels)) << name;
        ASSERT_EQ(texts.size(), of_pdf.size()) << name;
        for (std::size_t i = 0; i < texts.size(); ++i) {
            EXPECT_EQ(texts[i].text, of_pdf[i].text) << name;
            EXPECT_NEAR(texts[i].size, of_pdf[i].size, 1e-3) << texts[i].text;
            EXPECT_NEAR(texts[i].anchor.x, of_pdf[i].anchor.x, 1e-2) << texts[i].text;
            EXPECT_NEAR(texts[i].anchor.y, of_pdf[i].anchor.y, 1e-2) << texts[i].text;
            // 20 px are the 8 pt of font_pt
            EXPECT_GE(texts[i].size, 20 - 0.01f) << name << " " << texts[i].text;
        }
    }
    // with a height of its own, it keeps that
    const auto low = figure_of("fig6", {"scene.duration_s=2", "chart.width_cm=8.6", "chart.height_cm=4"});
    EXPECT_EQ(compose_figure(low, computed(low)).size, layout_of(low.chart).picture);
}

TEST(Chart, CellsOfMapsAreNotBlocks) {
    for (const std::string name : {"flip-map", "kapitza-map", "parting-map", "stability", "stability-mass"}) {
        const auto cells = figure_of(name).experiment->map();
        const auto few = figure_of(name, {"grid.x.points=4", "grid.y.points=3"});
        const auto page = compose_figure(few, computed(few));
        ASSERT_FALSE(page.panels.empty());
        for (const auto& [x, y, right] : page.panels) {
            EXPECT_LT(page.scale * std::abs(x.to - x.from) / static_cast<float>(cells->columns), 3.2f) << name;
            EXPECT_LT(page.scale * std::abs(y.to - y.from) / static_cast<float>(cells->rows), 2.2f) << name;
        }
    }
}

TEST(Chart, WithOnlyChaoticOrbitsSaysThatNoneIsRegular) {
    std::string words;
    for (const auto& label : labels_of(figure_of("links", {"grid.x.to=3", "grid.exponent_duration_s=100"})))
        words += label + " ";
    EXPECT_NE(words.find("None of 2 releases is regular. The band is the 68 % interval"), std::string::npos) << words;
}

TEST(Chart, CallsOrbitsRegularIfTheirExponentIsKnown) {
    const auto caption = [](int seconds) {
        const auto figure =
            figure_of("fig2-right", {"grid.quantity=\"exponent\"", "grid.x.from=10", "grid.x.to=30", "grid.x.step=20",
                                     fmt::format("grid.exponent_duration_s={}", seconds)});
        const auto page = page_of(figure);
        return page.captions.at(0);
    };
    const std::string band = ". The band is the 68 % interval of the exponent.";
    EXPECT_EQ(caption(500), "2 of 2 releases are regular: their exponent is not above 0" + band);
    EXPECT_EQ(caption(20),
              "1 of 2 releases are regular: their exponent is not above 0; that of 1 more cannot be told "
              "from 0 in a run this short" +
                  band);
    EXPECT_EQ(caption(5), "The exponent of 2 of 2 releases cannot be told from 0 in a run this short" + band);
}

}  // namespace doppel::chart_test
