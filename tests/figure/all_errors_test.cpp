#include "figure/preset.hpp"
#include "figure/support.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace doppel::all_figure_faults_test {

using Lines = std::vector<std::string>;

/// How the errors of a figure of this kind begin; the text starts at line 3.
Lines faults_of(const std::string& kind, const std::string& text, const std::vector<std::string>& arguments = {},
                std::size_t letters = 24) {
    try {
        read_figure({"x", "x.toml", "[scene]\nkind = \"" + kind + "\"\n" + text, "x.toml"}, sets(arguments));
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::bad_input);
        Lines lines{error.what()};
        lines.insert(lines.end(), error.further().begin(), error.further().end());
        for (auto& line : lines) {
            if (line.starts_with("x.toml:")) line.erase(0, 7);
            line = line.substr(0, letters);
        }
        return lines;
    }
    return {};
}

TEST(AllErrorsOfAFigure, AreInTheOrderOfFileAndThenCommandLine) {
    EXPECT_EQ(
        faults_of("grid",
                  "duration_s = \"long\"\n[chart]\nscale = 9\nsice = 1\n[grid.x]\nto = inf\nstep = 0\n[b]\nlabel = "
                  "\"x\"\n[system]\nmodel = 1\n",
                  {"grid.x.frm=1"}),
        (Lines{"3:1: [scene] duration_s ", "5:1: [chart] scale must ", "6:1: [chart] has no \"sic",
               "8:1: [grid.x] to must be", "9:1: [grid.x] step must ", "11:1: [b] has no \"label\"",
               "13:1: [system] model mus", "--set grid.x.frm: [grid."}));
}

TEST(AllErrorsOfAFigure, OfEveryKindAreFound) {
    const auto figures = {"grid", "series", "section", "work-precision"};
    for (const auto* kind : figures) {
        std::string table = kind;
        for (auto& letter : table)
            if (letter == '-') letter = '_';
        const auto errors = faults_of(kind, "[" + table + "]\nfoo = 1\n[chart]\nscale = 9\nbar = 2\n");
        EXPECT_EQ(errors.size(), 3u) << kind << testing::PrintToString(errors);
    }
    EXPECT_EQ(faults_of("series", "[[curve]]\ncolumn = 3\n[curve.a]\nlinks = 0\n[[curve]]\nfoo = 1\n", {}, 18),
              (Lines{"4:1: [[curve]] 1 c", "6:1: [a] links mus", "8:1: [[curve]] 2 h"}));
}

TEST(AllErrorsOfAFigure, OmitErrorsThatAnotherMayCause) {
    EXPECT_EQ(faults_of("grid", "[grid]\nquantity = 1\nexponent_duration_s = 3\n"),
              (Lines{"4:1: [grid] quantity mus"}));
    EXPECT_EQ(faults_of("grid", "[grid.x]\nfrom = 10\nto = 5\nstep = \"x\"\n"), (Lines{"6:1: [grid.x] step must "}));
    EXPECT_EQ(faults_of("series", "[series]\nquantity = \"exponents\"\n[system]\nlinks = 5\n[chart]\nscale = 0\n"),
              (Lines{"8:1: [chart] scale must "}));
    EXPECT_EQ(faults_of("grit", "[grid]\nfoo = 1\n"), (Lines{"2:1: [scene] kind must b"}));
}

}  // namespace doppel::all_figure_faults_test
