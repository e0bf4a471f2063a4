// What encoders take at equal quality.
#include "figure/support.hpp"

namespace doppel {
namespace encoders_test {

FigurePreset small(const std::vector<std::string>& more = {}) {
    return figure_from(
        "[scene]\nkind = \"encoders\"\n[encoders]\nfrom_s = 1\nframes = 24\n"
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
    ASSERT_EQ(table.rows.size(), 3 * figure.experiment->trials());
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
    // the default: no worse than what it is compared with, by the bytes that the README states; measured 1.07
    EXPECT_LT(column(3, "bytes_at_equal_quality"), 1.4);
}

TEST(Encoders, NamesWhatIsWrong) {
    const auto refused = [](const std::string& text, const std::vector<std::string>& words) {
        test::expect_error(ExitCode::bad_input, words, [&] { figure_from("[scene]\nkind = \"encoders\"\n" + text); });
    };
    refused("", {"[[film]]"});
    refused("[[film]]\n", {"[[film]] 1", "scene"});
    refused("[[film]]\nscene = \"fig2-left\"\n", {"must name a film"});
    refused("[encoders]\nframes = 100000\n[[film]]\nscene = \"calm\"\n", {"too short"});
    refused("[encoders]\ncodec = \"h265\"\n[[film]]\nscene = \"calm\"\n", {"codec", "h264"});
}

}  // namespace encoders_test
}  // namespace doppel
