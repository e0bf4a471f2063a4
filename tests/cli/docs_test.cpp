// Statements of the pages that commands can check: the commands run, and their output must agree.
#include "cli/process.hpp"

#include <regex>

namespace doppel::docs_test {

namespace fs = std::filesystem;
using namespace test;

const fs::path top = DOPPEL_SOURCE_DIR;

/// README.md and docs/*.md.
std::vector<fs::path> pages() {
    std::vector<fs::path> all{top / "README.md"};
    for (const auto& entry : fs::directory_iterator(top / "docs"))
        if (entry.path().extension() == ".md") all.push_back(entry.path());
    return all;
}

/// Calls run(page, groups) for every match of `pattern` in every page, of which there are more than `least`.
template <class Run>
void on_every(const char* pattern, int least, const Run& run) {
    const std::regex what(pattern);
    int seen = 0;
    for (const auto& page : pages()) {
        const auto text = bytes_of(page);
        for (std::sregex_iterator found(text.begin(), text.end(), what), end; found != end; ++found, ++seen)
            run(page, *found);
    }
    EXPECT_GT(seen, least);
}

TEST(Pages, LinkToFilesThatExist) {
    on_every(R"(\]\(([^)#:]+)\))", 25, [](const fs::path& page, const std::smatch& found) {  // measured 60
        EXPECT_TRUE(fs::exists(page.parent_path() / found.str(1))) << page << " links to " << found.str(1);
    });
}

TEST(Pages, AreShortAndSayWhatTheReaderCanDo) {
    for (const auto& page : pages()) {
        const auto text = bytes_of(page);
        EXPECT_LE(text.size(), 12'288u) << page;
        if (page.filename() == "README.md") {
            EXPECT_TRUE(text.size() > 2000 && text.size() <= 6144) << text.size();
        } else if (page.filename() != "study.md") {  // made by a test
            EXPECT_LT(text.find("\n\nAfter reading this page you "), 100u) << page;
        }
    }
}

TEST(Pages, NameEveryPreset) {
    for (const auto& [folder, page] : {std::pair("presets", "docs/films.md"), {"presets/figures", "docs/figures.md"}}) {
        const auto text = bytes_of(top / page);
        int presets = 0;
        for (const auto& entry : fs::directory_iterator(top / folder)) {
            if (entry.path().extension() != ".toml") continue;
            const auto name = entry.path().stem().string();
            const bool is_of_study = std::regex_match(name, std::regex("fig[2-8].*"));  // from fig2-left to fig8
            EXPECT_TRUE(is_of_study || has(text, '`' + name + '`')) << page << " lacks " << name;
            ++presets;
        }
        EXPECT_GT(presets, 10);
    }
}

const std::string doppel_is_this_one = "set -e; doppel() { \"$DOPPEL\" \"$@\"; }; ";

TEST(Docs, NumbersEqualTheOutputOfTheirCommand) {
    on_every("<!-- \\$ ([^\\n]*) -->", 0, [](const fs::path& page, const std::smatch& found) {
        fresh_folder();
        const auto result = shell(doppel_is_this_one + found.str(1));
        EXPECT_EQ(result.code, 0) << page << ": " << found.str(1) << '\n' << result.out << result.err;
    });
}

TEST(Docs, ExamplesPrintTheShownLines) {
    on_every("\\n```\\n\\$ ./(doppel [^\\n]*)\\n([^`]*)```", 0, [](const fs::path& page, const std::smatch& found) {
        fresh_folder();
        const auto result = shell(doppel_is_this_one + found.str(1));
        EXPECT_TRUE(has(result.out, found.str(2))) << page << ": " << found.str(1) << '\n' << result.err;
    });
}

/// The commands of a page, run one after another in one folder. To save time, films without a range have two frames,
/// pictures without a size are small, and new presets last 10 s. Figures that take minutes only list their files.
/// Commands with other programs (GNU parallel, Slurm) have their own tests (Recipe).
class PageOfCommands : public testing::TestWithParam<fs::path> {
protected:
    static std::string commands_of(const fs::path& page) {
        const auto text = bytes_of(page);
        const std::regex block("\\n```sh\\n([^`]*)```"), foreign("parallel|#!/bin/sh|apt install");
        std::string all;
        for (std::sregex_iterator found(text.begin(), text.end(), block), end; found != end; ++found)
            if (const auto commands = found->str(1); !std::regex_search(commands, foreign)) all += commands;
        return all;
    }

    /// ./doppel: the program with its commands shortened.
    static constexpr const char* shortened = R"(#!/bin/bash
case "$1 $*" in
    test*|package*) exit 0 ;;
    init*) rm -f "${@: -1}"; "$DOPPEL" "$@" && sed -i 's/^duration_s = 30$/duration_s = 10/' *.toml; exit ;;
    figure*" all "*|figure*--tiles*|figure*mine.toml*) set -- "$@" --list-outputs ;;
    render*--size*|render*--quality*|still*) ;;
    render*) set -- "$@" --size 320x180 ;;
esac
case "$1 $*" in
    render*--frames*|render*--to*|render*--list-outputs*) ;;
    render*) set -- "$@" --frames 0:2 ;;
esac
exec "$DOPPEL" "$@"
)";
    static constexpr const char* prepare = R"(
mkdir -p presets golden/mine
ln -s ")" DOPPEL_SOURCE_DIR R"(/presets/data" presets/data
./doppel init mine.toml
cp mine.toml presets/
)";
    static constexpr const char* prepare_goldens = R"(
./doppel render mine.toml --format png --size 480x270 --frames 0:3 --set video.fps=1 --out kept
./doppel figure fig6 --size 480x270 --set scene.duration_s=3 --out kept
cp kept/mine/frames/* golden/mine/
cp kept/fig6/fig6.png golden/
)";
};

TEST_P(PageOfCommands, Runs) {
    const auto commands = commands_of(GetParam());
    if (commands.empty()) return;
    const auto folder = fresh_folder();
    write_bytes(folder / "doppel", shortened);
    fs::permissions(folder / "doppel", fs::perms::owner_all);
    const bool has_goldens = std::regex_search(commands, std::regex("golden|kept"));
    const auto result = shell("set -e; unset CI; PATH=\"$PWD:$PATH\"\n" + std::string(prepare) +
                              (has_goldens ? prepare_goldens : "") + "set -x\n" + commands);
    EXPECT_EQ(result.code, 0) << result.out << result.err;
}

INSTANTIATE_TEST_SUITE_P(Docs, PageOfCommands, testing::ValuesIn(pages()), [](const auto& page) {
    auto name = page.param.stem().string();
    std::erase(name, '-');
    return name;
});

}  // namespace doppel::docs_test
