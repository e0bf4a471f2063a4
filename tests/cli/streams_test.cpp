// Input and output on terminals, pipes and closed descriptors. With the real program.
#include "base/text.hpp"
#include "cli/process.hpp"

#include <nlohmann/json.hpp>
#include <pty.h>
#include <sys/stat.h>

#include <algorithm>
#include <csignal>

namespace doppel::streams_test {

namespace fs = std::filesystem;
using namespace test;
using Streams = ProgramTest;

const std::string quick = " --set system.integrator=taylor --set scene.duration_s=0.1 ";

TEST_F(Streams, UnwritableStandardOutputIsExit4) {
    for (const char* name : {"calm", "triple"})
        done(with("render --format png --size 64x64 --frames 0:2 --progress none", name));
    for (const std::string command :
         {"show butterfly", "list", "list methods", "schema", "completion bash", "complete sim",
          "check calm --set scene.duration_s=0.1 --set 'video.size=[64, 64]'", "check fig6", "--help", "render --help",
          "--version", "compare out/calm/frames out/calm/frames", "compare out/calm/frames out/triple/frames"})
        for (const auto& [to, why] :
             {std::pair(" >/dev/full", "No space left on device"), {" >&-", "Bad file descriptor"}}) {
            const auto result = shell(program + command + to);
            EXPECT_EQ(result.code, std::string(to) == " >&-" ? 4 : 75) << command << to;
            EXPECT_EQ(result.err, fmt::format("doppel: standard output cannot be written: {}\n", why)) << command << to;
        }
}

TEST_F(Streams, UnprintableNamesOfFilesAreExit75) {
    write_bytes(folder / "map.toml", small_map);
    const std::vector<std::pair<std::string, std::string>> cases{
        {"simulate butterfly" + quick, "butterfly/butterfly.csv"},
        {"render butterfly --size 64x64" + quick, "butterfly/butterfly.mp4"},
        {"still butterfly --at 0 --size 64x64", "butterfly/butterfly.0s.png"},
        {"figure fig6 --size 160x90", "fig6/fig6.png"},
        {"figure map.toml --tiles", "map/map.html"},
        {"figure map.toml --format html", "map/map.html"},
        {"init out/mine.toml", "mine.toml"}};
    for (const auto& [command, file] : cases)
        for (const std::string style : {"none", "plain"}) {
            const auto line = program + command + (command.starts_with("init") ? "" : " --progress " + style);
            const auto run = [&](const std::string& script) {
                fs::remove_all(folder / "out");
                fs::create_directory(folder / "out");
                auto outcome = shell(script);
                EXPECT_TRUE(fs::exists(folder / "out" / file)) << script << outcome.err;
                return outcome;
            };
            const auto full = run(line + " >/dev/full");
            EXPECT_EQ(full.code, 75) << command;
            EXPECT_TRUE(full.err.ends_with("doppel: standard output cannot be written: No space left on device\n"))
                << command << full.err;
            EXPECT_EQ(run(line + " >&-").code, 0) << command;  // closed: nothing to report
            run("(" + line + "; echo $? >code) | true");
            EXPECT_EQ(bytes_of(folder / "code"), "0\n") << command;
        }
}

TEST_F(Streams, UnwritableJsonIsReportedAtTheEnd) {
    for (const auto& command : {"simulate butterfly" + quick, std::string("figure fig6 --size 160x90")}) {
        const bool is_figure = command.starts_with("figure");
        const auto csv = folder / "out" / (is_figure ? "fig6/fig6.csv" : "butterfly/butterfly.csv");
        const auto full = shell(program + command + " --progress json >/dev/full");
        EXPECT_EQ(full.code, 75) << full.err;
        EXPECT_EQ(full.err, "doppel: standard output cannot be written: No space left on device\n");
        EXPECT_TRUE(fs::exists(csv)) << command;
        fs::remove_all(folder / "out");
        // a reader that stops reading is not an error
        const auto left = shell("(" + program + command + " --progress json; echo $? >code) | true");
        EXPECT_EQ(bytes_of(folder / "code"), "0\n") << left.err;
        EXPECT_TRUE(fs::exists(csv)) << command;
    }
}

TEST_F(Streams, JsonSaysAnyPath) {
    const auto result = shell(program + "simulate butterfly" + quick + "--progress json -o \"$(printf 'a\\377b')\"");
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(nlohmann::json::parse(result.out)["files"][0],
              "a\xef\xbf\xbd"
              "b/butterfly/butterfly.csv");
}

TEST_F(Streams, ClosedStreamsDoNotReceiveTheFilm) {
    const auto run = [&](const std::string& streams) {
        const auto result = shell(program + "simulate butterfly --set scene.duration_s=0.1 " + streams);
        EXPECT_EQ(result.code, 0) << streams;
        const auto csv = bytes_of(folder / "out/butterfly/butterfly.csv");
        fs::remove_all(folder / "out");
        return csv;
    };
    const auto whole = run(">/dev/null 2>&1");
    for (const auto* streams : {"<&- >&- 2>&-", "<&-", ">&-", "2>&-", ">&- 2>&-"})
        EXPECT_EQ(run(streams), whole) << streams;
    // the standard descriptors refer to /dev/null while the run writes its files
    const auto child = start("simulate butterfly --set scene.duration_s=100000 --progress plain", [] {
        for (const int stream : {0, 1, 2}) close(stream);
    });
    const auto link = [&](int number) {
        std::error_code ignored;
        return fs::read_symlink(fmt::format("/proc/{}/fd/{}", child, number), ignored).string();
    };
    EXPECT_TRUE(wait_until([&] { return fs::exists(folder / "out/butterfly/.doppel-run/butterfly.csv"); }));
    for (const int stream : {0, 1, 2}) EXPECT_EQ(link(stream), "/dev/null") << stream;
    kill(child, SIGKILL);
    wait_for(child);
}

/// The first complete lines of a bar on a terminal of so many columns; none if there is no terminal.
std::vector<std::string> lines_of_bar(unsigned short columns) {
    const winsize window{.ws_row = 24, .ws_col = columns, .ws_xpixel = 0, .ws_ypixel = 0};
    int side = -1, terminal = -1;
    if (openpty(&side, &terminal, nullptr, nullptr, &window) != 0) return {};
    const auto child =
        start("simulate 振り子.toml --set scene.duration_s=100000", [&] { dup2(terminal, STDERR_FILENO); });
    close(terminal);  // so that reading ends with the program
    const std::string before = "\r\033[K";
    std::string said;
    std::vector<std::string> lines;
    for (char byte = 0; lines.size() < 3 && read(side, &byte, 1) == 1;) {
        said += byte;
        if (!said.ends_with(before)) continue;
        lines.push_back(said.substr(0, said.size() - before.size()));
        said.clear();
    }
    kill(child, SIGKILL);
    wait_for(child);
    close(side);
    return lines;
}

TEST_F(Streams, TheBarIsNarrowerThanItsTerminal) {
    write_bytes(folder / "振り子.toml", "title = \"x\"\n[b]\nangle_deg = 91\n");
    for (const int columns : {120, 80, 60, 30, 8}) {
        const auto lines = lines_of_bar(static_cast<unsigned short>(columns));
        if (lines.empty()) GTEST_SKIP() << "no terminal, as in a root without /dev/pts";
        for (std::size_t i = 1; i < lines.size(); ++i) {  // before the first one is nothing
            auto rest = std::string_view(lines[i]);
            int width = 0, bar = 0;
            while (!rest.empty()) {
                const auto character = next_character(rest);
                width += character < 0x3000 ? 1 : 2;
                bar += character == 0x2501 || character == 0x2500;
            }
            EXPECT_LT(width, columns) << lines[i];
            EXPECT_EQ(bar == 28, columns == 120) << lines[i];
            EXPECT_EQ(bar > 5, columns > 60) << lines[i];
        }
    }
}

// a whole film of this length would take minutes
TEST_F(Streams, AFilmIsStreamedWhileItIsMade) {
    const auto piped = shell(
        "\"$DOPPEL\" render calm --size 64x64 --set scene.duration_s=2000 --format y4m -o - "
        "--progress none 2>errors | head -c 20000 | wc -c");
    EXPECT_EQ(piped.out, "20000\n");
    EXPECT_EQ(bytes_of(folder / "errors"), "doppel: standard output: cannot be written: Broken pipe\n");
    EXPECT_FALSE(fs::exists(folder / "out"));
    expect_refused("render calm -o - --shard 1/2", 2,
                   "doppel: -o -: parts and their merge need a folder; give another --out\n");
}

TEST_F(Streams, AnEmptyArgumentIsNotTakenForNone) {
    const std::vector<std::pair<Words, std::string>> cases{
        {{"render", "butterfly", "--size", ""}, "--size is empty"},
        {"render butterfly --size=", "--size is empty"},
        {{"render", "butterfly", "--frames", ""}, "--frames is empty"},
        {{"render", "butterfly", "--format", ""}, "--format is empty"},
        {{"render", "butterfly", "--quality", ""}, "--quality is empty"},
        {{"render", "butterfly", "--gl", ""}, "--gl is empty"},
        {{"render", "butterfly", "-o", ""}, "-o is empty"},
        {"render butterfly --out=", "--out is empty"},
        {{"render", "butterfly", "--set", ""}, "--set is empty"},
        {{"render", "butterfly", "-j", ""}, "-j is empty"},
        {{"render", "butterfly", "--progress", ""}, "--progress is empty"},
        {{"figure", "fig6", "--shard", ""}, "--shard is empty"},
        {"figure fig6 --shard=", "--shard is empty"},
        {{"figure", "fig6", "--scale", ""}, "--scale is empty"},
        {{"render", ""}, "argument 2 is empty"},
        {{"render", "butterfly", ""}, "argument 3 is empty"},
        {{""}, "argument 1 is empty"},
    };
    for (const auto& [arguments, words] : cases) {
        const auto result = ends(arguments, 2);
        EXPECT_EQ(result.err, fmt::format("doppel: {}; leave it out, or give a value\n", words));
    }
    EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST_F(Streams, ControlCharactersOfAPresetAreSanitised) {
    const auto clean = [](const std::string& text) {
        for (const char c : text)
            if (c != '\n' && (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)) return false;
        return text.find("\xc2\x9b") == std::string::npos;
    };
    // rejected where they would be drawn, but quoted in a message
    const std::string evil = "\\u001b]0;owned\\u0007\\u009b31m\\u202e";
    write_bytes(folder / "film.toml", "title = \"" + evil + "\"\n");
    write_bytes(folder / "figure.toml", "title = \"" + evil + "\"\n[scene]\nkind = \"grid\"\n");
    write_bytes(folder / "key.toml", "\"" + evil + "\" = 1\n");
    write_bytes(folder / "choice.toml", "[system]\nmodel = \"" + evil + "\"\n");
    write_bytes(folder / "parts.toml",
                "[[system.force]]\nkind = \"spring\"\nname = \"" + evil + "\"\nfrom = \"" + evil + "\"\nto = [0, 1]\n");
    write_bytes(folder / "number.toml", "title = in\n");
    write_bytes(folder / "nul.toml", "[system]\nmodel = \"a\\u0000b\"\n");
    for (const char* preset :
         {"film.toml", "figure.toml", "key.toml", "choice.toml", "parts.toml", "number.toml", "nul.toml"}) {
        const auto result = ends({"check", preset}, 2);
        EXPECT_TRUE(one_line(result.err)) << result.err;
        EXPECT_TRUE(clean(result.err)) << result.err;
    }
    // control characters are removed on a terminal, not in a file
    write_bytes(folder / "raw.toml", "# \x1b[31mred\n");
    EXPECT_EQ(doppel("show raw.toml").out, "# \x1b[31mred\n");
    // script(1) fails without pseudoterminals, as in a bare chroot
    const auto terminal = shell("script -qec '\"$DOPPEL\" show raw.toml' /dev/null >shown && tr -d '\\r' <shown");
    EXPECT_EQ(terminal.out, terminal.code == 0 ? "#  [31mred\n" : "") << terminal.err;
}

TEST_F(Streams, AMessageIsNoLongerThanCanBeRead) {
    std::string word;
    for (int i = 0; i < 200'000; ++i) word += "é";
    for (const std::string_view before : {"", "a"}) {
        write_bytes(folder / "long.toml", "\"" + std::string(before) + word + "\" = 1\n");
        const auto result = ends("check long.toml", 2);
        EXPECT_TRUE(one_line(result.err));
        EXPECT_GT(result.err.size(), 3900u);
        EXPECT_LT(result.err.size(), 4100u);
        EXPECT_TRUE(is_utf8(result.err));
        EXPECT_TRUE(result.err.ends_with("é…\n"));
    }
}

TEST_F(Streams, APipeAsPresetIsReadAndDoesNotSwallowCtrlC) {
    ASSERT_EQ(mkfifo((folder / "pipe.toml").c_str(), 0600), 0);
    const auto text = fs::path(DOPPEL_SOURCE_DIR) / "presets/calm.toml";
    const auto result = shell("cat " + text.string() + " >pipe.toml & \"$DOPPEL\" simulate pipe.toml" + quick);
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_TRUE(fs::exists(folder / "out/pipe/pipe.csv"));
    EXPECT_EQ(
        shell("cat " + text.string() + " | \"$DOPPEL\" check /dev/stdin --set 'video.size=[64, 64]'" + quick).code, 0);

    write_bytes(folder / "work.toml", "[scene]\nkind = \"work-precision\"\n[work_precision]\nscene = \"pipe.toml\"\n");
    for (const auto& command : std::vector<Words>{"render pipe.toml", "simulate pipe.toml", "check pipe.toml",
                                                  "show pipe.toml", "figure pipe.toml"}) {
        const auto child = start(command);
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        kill(child, SIGINT);
        EXPECT_EQ(wait_at_most(child, 2), 130) << command[0];
        EXPECT_EQ(bytes_of(folder / "stderr"), "doppel: interrupted\n") << command[0];
    }
    const auto inside = ends("figure work.toml", 2);
    EXPECT_EQ(
        inside.err,
        "doppel: work.toml:4:1: [work_precision] scene cannot be taken: pipe.toml is not a file; a preset is a TOML "
        "file\n");
    write_bytes(folder / "work.toml", "[scene]\nkind = \"work-precision\"\n[work_precision]\nscene = \"/dev/zero\"\n");
    EXPECT_EQ(doppel("check work.toml").code, 2);
}

TEST_F(Streams, ShowAllErrorsOfAPresetOnePerLine) {
    write_bytes(folder / "film.toml", "[video]\nfps = -2\nsise = 3\n[scene]\nduration_s = []\n[b]\nlinks = 0\n");
    const auto film = ends("render film.toml --size 7x7 --set a.foo=1", 2);
    EXPECT_EQ(film.out, "");
    EXPECT_TRUE(
        film.err.starts_with("doppel: film.toml:2:1: [video] fps must be > 0; it is -2\n"
                             "doppel: film.toml:3:1: [video] has no \"sise\"; did you mean \"size\"?\n"
                             "doppel: film.toml:5:1: [scene] duration_s must be a number; it is an array ([])\n"
                             "doppel: film.toml:7:1: [b] links must be from 1 to 10000; it is 0\n"
                             "doppel: --set a.foo: [a] has no \"foo\"; "))
        << film.err;
    EXPECT_EQ(std::count(film.err.begin(), film.err.end(), '\n'), 6) << film.err;
    write_bytes(folder / "chart.toml", "[scene]\nkind = \"section\"\n[section]\norbits = 0\nfoo = 1\n");
    for (const char* command : {"figure", "check"}) {
        const auto figure = ends({command, "chart.toml", "--set", "chart.scale=99"}, 2);
        EXPECT_EQ(figure.err,
                  "doppel: chart.toml:4:1: [section] orbits must be from 1 to 10000; it is 0\n"
                  "doppel: chart.toml:5:1: [section] has no \"foo\"; it has crossings, energy_J, exponent_duration_s, "
                  "orbits, tolerance\n"
                  "doppel: --set chart.scale: [chart] scale must be at most 8; it is 99\n");
    }
}

}  // namespace doppel::streams_test
