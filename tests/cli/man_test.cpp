// The manual pages. With the real program; mandoc and man look at them in tests/check-man.
#include "cli/sandbox.hpp"
#include "figure/preset.hpp"

#include <regex>
#include <sstream>

namespace doppel {
namespace man_test {

namespace fs = std::filesystem;
using namespace test;

std::set<std::string> commands(const fs::path& folder) {
    std::set<std::string> names;
    std::istringstream help(doppel(folder, {"--help"}).out);
    bool are_next = false;
    for (std::string line; std::getline(help, line);) {
        std::smatch match;
        if (are_next && std::regex_search(line, match, std::regex("^  ([a-z]+) "))) names.insert(match[1]);
        are_next |= line == "Subcommands:" || line == "SUBCOMMANDS:";  // CLI11 before and since 2.5
    }
    return names;
}

std::string escaped(std::string text) {
    return std::regex_replace(text, std::regex("-"), "\\-");
}

/// Nothing in it is taken for a request by mistake.
void expect_well_formed(const std::string& page, const std::string& name) {
    static const std::regex request(R"(^\.(TH|SH|SS|TP|PP|B|I|BR|IR|RB|nf|fi)( .*)?$)");
    const std::regex bare_hyphen(R"([^\\]-)"), escape(R"(\\([^fe&(-]|f[^BIR]))");
    std::istringstream lines(page);
    for (std::string line; std::getline(lines, line);) {
        EXPECT_FALSE(line.starts_with('\'')) << name << ": " << line;
        EXPECT_TRUE(!line.starts_with('.') || std::regex_match(line, request)) << name << ": " << line;
        EXPECT_TRUE(line.starts_with(".TH ") || !std::regex_search(line, bare_hyphen)) << name << ": " << line;
        EXPECT_FALSE(std::regex_search(line, escape)) << name << ": " << line;
        EXPECT_EQ(line.find('`'), std::string::npos) << name << ": " << line;
    }
    EXPECT_TRUE(page.starts_with(".TH ")) << name;
    for (const char* section : {"NAME", "DESCRIPTION", "SEE ALSO"})
        EXPECT_NE(page.find(fmt::format("\n.SH {}\n", section)), std::string::npos) << name << " " << section;
}

TEST(Man, HasEveryCommandAndOption) {
    const auto folder = fresh_folder();
    ASSERT_EQ(doppel(folder, {"man", "--all", "new/man"}).code, 0);
    const auto names = commands(folder);
    EXPECT_GE(names.size(), 11u);
    std::set<std::string> files{"doppel.1", "doppel.toml.5"};
    for (const auto& name : names) files.insert("doppel-" + name + ".1");
    EXPECT_EQ(listing(folder / "new/man"), files);
    for (const auto& file : files) expect_well_formed(bytes_of(folder / "new/man" / file), file);
    std::size_t options = 0;
    for (const auto& name : names) {
        const auto page = bytes_of(folder / ("new/man/doppel-" + name + ".1"));
        EXPECT_EQ(doppel(folder, {"man", name}).out, page);
        const auto help = doppel(folder, {name, "--help"}).out;
        const std::regex option("\n  (?:-[a-z],)? *(--[a-z]+)");
        for (std::sregex_iterator match(help.begin(), help.end(), option), end; match != end; ++match, ++options)
            EXPECT_NE(page.find("\\fB" + escaped((*match)[1]) + "\\fR"), std::string::npos) << name << (*match)[1];
    }
    EXPECT_GT(options, 30u);
    EXPECT_EQ(doppel(folder, {"man"}).out, bytes_of(folder / "new/man/doppel.1"));
    const auto render = bytes_of(folder / "new/man/doppel-render.1");
    for (const char* words : {"\\fB\\-\\-frames\\fR \\fIA:B\\fR\n", "\\fB\\-j\\fR, \\fB\\-\\-jobs\\fR \\fIN\\fR\n",
                              "doppel render butterfly\n", "(default: out).\n"})
        EXPECT_NE(render.find(words), std::string::npos) << words;
}

TEST(Man, HasEveryKeyOfPresets) {
    const auto page = doppel(fresh_folder(), {"man", "doppel.toml"}).out;
    for (auto* tables : {&film_tables, &figure_tables})
        for (const auto& table : tables())
            for (const auto& field : table.fields)
                EXPECT_NE(page.find(fmt::format(".TP\n\\fB{}\\fR\n", field.key)), std::string::npos) << field.key;
}

TEST(Man, RefusesWhatIsNoPage) {
    const auto folder = fresh_folder();
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"man", "rendr"}, {"man", "render", "--all", "man"}}) {
        const auto result = doppel(folder, arguments);
        EXPECT_EQ(result.code, 2);
        EXPECT_TRUE(one_line(result.err)) << result.err;
    }
    EXPECT_FALSE(fs::exists(folder / "man"));
    write_bytes(folder / "file", "");
    EXPECT_EQ(doppel(folder, {"man", "--all", "file"}).code, 4);
}

TEST(Man, ReplacesItsOwnPagesAlone) {
    const auto folder = fresh_folder();
    for (int again = 0; again < 2; ++again) ASSERT_EQ(doppel(folder, {"man", "--all", "man"}).code, 0);
    const auto pages = listing(folder / "man");
    const std::string mine = ".TH DOPPEL-STILL 1\nmine\n";
    for (const bool is_link : {false, true}) {
        const auto page = folder / "man/doppel-still.1", first = folder / "man/doppel.1";
        fs::remove(page);
        fs::remove(first);
        write_bytes(is_link ? folder / "mine" : page, mine);
        if (is_link) fs::create_symlink(folder / "mine", page);
        const auto refused = doppel(folder, {"man", "--all", "man"});
        EXPECT_EQ(refused.code, 4);
        EXPECT_TRUE(one_line(refused.err) && refused.err.find("man/doppel-still.1") != std::string::npos)
            << refused.err;
        EXPECT_EQ(bytes_of(page), mine);
        EXPECT_FALSE(fs::exists(first));
        EXPECT_EQ(listing(folder / "man").size() + 1, pages.size());
    }
}

}  // namespace man_test
}  // namespace doppel
