// What encoders take at equal quality.
#include "figure/encoder_quality.hpp"
#include "figure/encoder_settings.hpp"
#include "figure/support.hpp"

#include <cmath>

namespace doppel {
namespace encoders_test {

constexpr std::size_t settings_of_h264 =
    static_cast<std::size_t>(std::count_if(encoder_settings.begin(), encoder_settings.end(),
                                           [](const EncoderSetting& setting) { return setting.codec == "h264"; }));

FigurePreset small(const std::vector<std::string>& more = {}) {
    return figure_from(
        "[scene]\nkind = \"encoders\"\n[encoders]\nfrom_s = 1\nframes = 24\nrepeats = 2\n"
        "[[film]]\nscene = \"butterfly\"\nsize = [320, 180]\n",
        more);
}

TEST(Encoders, ComparesSettingsWithTheFirst) {
    const auto figure = small();
    const auto trials = computed(figure, 1);
    const Table table(table_text(figure, trials));
    const auto column = [&](std::size_t row, const char* name) {
        const auto at = std::find(table.columns.begin(), table.columns.end(), name) - table.columns.begin();
        return table.rows.at(row).at(static_cast<std::size_t>(at));
    };
    ASSERT_EQ(figure.experiment->trials(), 2 * settings_of_h264);
    ASSERT_EQ(table.rows.size(), 3 * settings_of_h264);
    // what is compared with: itself
    EXPECT_NEAR(column(1, "cpu_at_equal_quality"), 1, 1e-9);
    EXPECT_NEAR(column(1, "bytes_at_equal_quality"), 1, 1e-9);
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
        EXPECT_GT(column(row, "cpu_ms_per_frame"), 0) << row;
        if (row % 3 == 0) continue;
        EXPECT_LT(column(row, "bytes_per_frame"), column(row - 1, "bytes_per_frame")) << row;
        EXPECT_LT(column(row, "moving_psnr_db"), column(row - 1, "moving_psnr_db")) << row;
    }
    // ultrafast looks better and takes 3 times the bytes: at equal quality it still takes more; measured 2.4
    EXPECT_GT(column(6, "bytes_at_equal_quality"), 1.3);
    // the default: no worse than what it is compared with, by few more bytes; measured 1.07
    EXPECT_LT(column(3, "bytes_at_equal_quality"), 1.4);
}

/// A trial's numbers: at each quality `change` from that of veryfast.
TrialNumbers trial(double cpu_ms, double bytes, double db_more, double moving_psnr_db) {
    TrialNumbers numbers;
    for (const double crf : {15., 18., 21.})
        append(numbers, EncodedRow{crf, cpu_ms, bytes * std::pow(2, (18 - crf) / 6), 50 + db_more + (18 - crf),
                                   moving_psnr_db, 0.999, 0.998});
    return numbers;
}

TEST(Encoders, TheLeastTimeOfRepeatsCounts) {
    const auto figure = small();
    KnownTrials trials;
    for (std::size_t k = 0; k < settings_of_h264; ++k) trials.push_back(trial(10, 1000, 0, 40));
    for (std::size_t k = 0; k < settings_of_h264; ++k) trials.push_back({11, 9, 8});
    const Table table(table_text(figure, trials));
    ASSERT_EQ(table.columns.at(6), "cpu_ms_per_frame");
    EXPECT_EQ(table.rows.at(0).at(6), 10);
    EXPECT_EQ(table.rows.at(1).at(6), 9);
    EXPECT_EQ(table.rows.at(2).at(6), 8);
}

TEST(Encoders, EqualQualityIsByTheWorstMeasure) {
    const auto reference = rows_of<EncodedRow>(trial(10, 1000, 0, 40));
    const auto better = rows_of<EncodedRow>(trial(5, 1000, 3, 40));
    // 3 dB more are 3 of crf, of which 6 are twice the bytes
    EXPECT_NEAR(equal_quality(better, reference).bytes, 1 / std::sqrt(2), 1e-12);
    EXPECT_NEAR(equal_quality(better, reference).cpu, 0.5, 1e-12);
    auto coarser = rows_of<EncodedRow>(trial(5, 1000, 3, 40));
    for (std::size_t q = 0; q < 3; ++q) coarser[q].moving_psnr_db = 46 - 3 * static_cast<double>(q + 2);
    EXPECT_NEAR(equal_quality(coarser, reference).bytes, std::sqrt(2), 1e-12);  // 40 dB, at crf 15
}

TEST(Encoders, NothingMovesInAFilm) {
    const auto path = test::fresh_folder() / "rest.toml";
    test::write_bytes(path,
                      "title = \"At rest\"\n[scene]\nkind = \"pair\"\nduration_s = 2\n[system]\nangle_deg = [0, 0]\n"
                      "[video]\nshow = [\"title\"]\npanels = [\"pendulums\"]\n");
    const auto figure = figure_from(
        "[scene]\nkind = \"encoders\"\n[encoders]\nfrom_s = 1\nframes = 4\nrepeats = 1\n"
        "[[film]]\nscene = \"" +
        path.string() + "\"\nsize = [320, 180]\n");
    const Table table(table_text(figure, computed(figure, 1)));
    ASSERT_EQ(table.columns.at(8), "psnr_db");
    ASSERT_EQ(table.columns.at(9), "moving_psnr_db");
    ASSERT_EQ(table.columns.at(11), "moving_ssim");
    ASSERT_EQ(table.columns.at(13), "bytes_at_equal_quality");
    for (const auto& row : table.rows) {
        EXPECT_GT(row.at(8), 30);
        EXPECT_TRUE(std::isnan(row.at(9)));
        EXPECT_TRUE(std::isnan(row.at(11)));
    }
    EXPECT_NEAR(table.rows.at(1).at(13), 1, 1e-9);
}

TEST(Encoders, FilmsMayBeTransparentAndHaveTheirOwnRate) {
    const auto figure = figure_from(
        "[scene]\nkind = \"encoders\"\n[encoders]\ncodec = \"vp9\"\nfrom_s = 1\nframes = 6\nrepeats = 1\n"
        "[[film]]\nscene = \"butterfly\"\nsize = [160, 90]\nfps = 30\ntransparent = true\n");
    const Table table(table_text(figure, computed(figure, 1)));
    EXPECT_EQ(table.rows.size(), 3 * figure.experiment->trials());
    for (const auto& row : table.rows) EXPECT_GT(row.at(8), 25);
    EXPECT_NE(figure.experiment->resolved().find("transparent = true"), std::string::npos);
    EXPECT_NE(figure.experiment->resolved().find("fps = 30"), std::string::npos);
}

TEST(Encoders, NamesWhatIsWrong) {
    const auto refused = [](const std::string& text, const std::vector<std::string>& words) {
        test::expect_error(ExitCode::bad_input, words, [&] { figure_from("[scene]\nkind = \"encoders\"\n" + text); });
    };
    refused("", {"[[film]]"});
    refused("[[film]]\n", {"[[film]] 1", "scene"});
    refused("[[film]]\nscene = \"fig2-left\"\n", {"must name a film"});
    refused("[encoders]\nframes = 100000\n[[film]]\nscene = \"calm\"\n", {"too short"});
    refused("[[film]]\nscene = \"calm\"\ntransparent = true\n", {"transparent", "vp9"});
    refused("[[film]]\nscene = \"calm\"\nfps = 1000\n", {"fps must divide sample_hz", "it is 1000"});
    refused("[encoders]\ncodec = \"h265\"\n[[film]]\nscene = \"calm\"\n", {"codec", "h264"});
}

}  // namespace encoders_test
}  // namespace doppel
