// Completion in a real bash. zsh and fish: tests/check-completion.
#include "cli/process.hpp"
#include "integrate/methods.hpp"

#include <poll.h>
#include <pty.h>
#include <sys/resource.h>

#include <optional>
#include <system_error>

namespace doppel::completion_test {

namespace fs = std::filesystem;
using namespace test;
using Lines = std::vector<std::string>;

/// A folder with "doppel", which completes; for other commands it writes the arguments to the file "args".
fs::path folder_with_doppel() {
    const auto folder = fresh_folder();
    fs::create_directory(folder / "bin");
    write_bytes(folder / "bin/doppel", std::string("#!/bin/sh\ncase $1 in complete|completion) exec ") +
                                           DOPPEL_PROGRAM +
                                           " \"$@\";; esac\nprintf '%s\\n' \"$@\" >args.part; mv args.part args\n");
    fs::permissions(folder / "bin/doppel", fs::perms::owner_all);
    return folder;
}

/// COMPREPLY for these words; the last word is completed.
Lines completed(const fs::path& folder, const std::string& words) {
    write_bytes(folder / "line", "doppel " + words);
    const std::string script =
        "PATH=$PWD/bin:$PATH; source <(doppel completion bash); COMP_WORDS=(doppel); COMP_LINE=$(cat line; echo .); "
        "COMP_LINE=${COMP_LINE%.}; COMP_POINT=${#COMP_LINE}; _doppel; printf '%s\\n' \"${COMPREPLY[@]}\"";
    const auto child = start_program("/bin/bash", {"--norc", "--noprofile", "-c", script});
    EXPECT_EQ(wait_for(child), 0) << bytes_of(folder / "stderr");
    EXPECT_EQ(bytes_of(folder / "stderr"), "");
    return lines_of(bytes_of(folder / "stdout"));
}

/// Whether every one of these is a line.
bool offers(const Lines& lines, const Words& all) {
    return std::ranges::all_of(all, [&](const auto& line) { return std::ranges::count(lines, line) > 0; });
}

TEST(Completion, KnowsCommandsOptionsAndTheirChoices) {
    const auto folder = folder_with_doppel();
    const auto commands = completed(folder, "");
    EXPECT_TRUE(offers(commands, {"render", "figure", "check", "init", "schema", "completion"}));
    EXPECT_FALSE(offers(commands, "complete"));
    EXPECT_EQ(completed(folder, "sim"), Lines{"simulate"});
    EXPECT_EQ(completed(folder, "render --form"), Lines{"--format"});
    EXPECT_EQ(completed(folder, "render --format "),
              (Lines{"apng", "gif", "html", "mp4", "png", "rgb", "webm", "y4m"}));
    EXPECT_EQ(completed(folder, "render --format=w"), Lines{"webm"});
    EXPECT_EQ(completed(folder, "figure fig6 --merge fig2-r"), Lines{"fig2-right"});  // a flag takes no value
    EXPECT_EQ(completed(folder, "completion "), (Lines{"bash", "fish", "zsh"}));
    EXPECT_EQ(completed(folder, "list m"), Lines{"methods"});
    EXPECT_EQ(completed(folder, "nonesuch "), Lines{""});
}

TEST(Completion, KnowsPresetsHereAndBuiltInAndFiles) {
    const auto folder = folder_with_doppel();
    fs::create_directories(folder / "presets/figures");
    fs::create_directories(folder / "films/old");
    for (const char* file :
         {"presets/mine.toml", "presets/figures/my-chart.toml", "films/a b.toml", "films/x.txt", "own.toml"})
        write_bytes(folder / file, "");
    const auto films = completed(folder, "render ");
    EXPECT_TRUE(offers(films, {"butterfly", "mine", "films/", "own.toml"}));
    for (const char* name : {"fig6", "my-chart", "stdout", "all"}) EXPECT_FALSE(offers(films, name)) << name;
    const auto figures = completed(folder, "figure ");
    EXPECT_TRUE(offers(figures, {"fig6", "my-chart", "all"}));
    EXPECT_FALSE(offers(figures, "butterfly"));
    EXPECT_EQ(completed(folder, "check films/"), (Lines{"films/a\\ b.toml", "films/old/"}));
    EXPECT_EQ(completed(folder, "render calm -o fi"), Lines{"films/"});
    EXPECT_TRUE(offers(completed(folder, "compare "), "stdout"));
}

TEST(Completion, KnowsKeysAndTheirValues) {
    const auto folder = folder_with_doppel();
    EXPECT_EQ(completed(folder, "render calm --set video.lay"), Lines{"video.layout="});
    EXPECT_EQ(completed(folder, "render calm --set video.layout="),
              (Lines{"ensemble", "overlay", "phase", "portrait", "side-by-side", "single"}));
    EXPECT_EQ(completed(folder, "render calm --set video.layout=ov"), Lines{"overlay"});
    EXPECT_EQ(completed(folder, "render calm --set 'video.layout=ov"), Lines{"video.layout=overlay"});
    EXPECT_EQ(completed(folder, "render calm --set 'video.layo").size(), 6);  // the key alone would close the quote
    EXPECT_EQ(completed(folder, "render calm --set b.mass_kg="), Lines{"\\[1,\\ 1\\]"});
    EXPECT_EQ(completed(folder, "render calm --set system.integrator=").size(), methods().size());
    EXPECT_EQ(completed(folder, "render calm --set b.integrator=ta"), Lines{"taylor"});
    EXPECT_EQ(completed(folder, "render calm --set video.transparent="), (Lines{"false", "true"}));
    EXPECT_EQ(completed(folder, "render calm --set video.colors.backg"), Lines{"video.colors.background="});
    EXPECT_EQ(completed(folder, "render calm --set scene.duration_s="), Lines{"30"});
    EXPECT_EQ(completed(folder, "render calm --set nonesuch"), Lines{""});
    // the values of a figure's kind
    EXPECT_EQ(completed(folder, "figure fig2-right --set grid.x.spacing="), (Lines{"linear", "logarithmic"}));
    EXPECT_EQ(completed(folder, "figure fig2-right --set video."), Lines{""});
    EXPECT_EQ(completed(folder, "check flip-map --set grid.x.poi"), Lines{"grid.x.points="});
    EXPECT_EQ(completed(folder, "init --figure gr"), Lines{"grid"});
    EXPECT_TRUE(offers(completed(folder, "check calm --format "), {"mp4", "html", "pdf"}));
    // the key of an axis is a key
    EXPECT_TRUE(offers(completed(folder, "figure fig2-right --set grid.x.key="),
                       {"theta1_deg", "mass_ratio", "links", "setting", "system.mass_kg", "b.pivot.amplitude_m"}));
    EXPECT_EQ(completed(folder, "figure fig2-right --set grid.color.key=system.int"), Lines{"system.integrator"});
    EXPECT_EQ(completed(folder, "figure fig6 --set grid.x.key="), Lines{""});  // a series
    EXPECT_TRUE(offers(completed(folder, "figure --set "), "poincare.orbits=") ||
                offers(completed(folder, "figure --set "), "section.orbits="));
}

TEST(Completion, RefusesAnUnknownShell) {
    fresh_folder();
    expect_refused("completion tcsh", 2, "tcsh");
}

/// CPU time of the finished child processes, s.
double spent_by_children() {
    rusage spent{};
    getrusage(RUSAGE_CHILDREN, &spent);
    const auto seconds = [](const timeval& time) {
        return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    return seconds(spent.ru_utime) + seconds(spent.ru_stime);
}

/// Measures CPU time, so that other load on the machine does not matter.
TEST(Completion, IsFast) {
    const auto folder = fresh_folder();
#ifdef DOPPEL_SANITIZE
    const double maximum = 1;  // measured 0.1 s; 0.25 s during another build
#else
    const double maximum = 0.2;  // measured 0.02 s
#endif
    double best = 10;
    for (int i = 0; i < 5; ++i) {
        const double before = spent_by_children();
        done("complete figure fig2-right --set grid.");
        best = std::min(best, spent_by_children() - before);
    }
    EXPECT_LT(best, maximum);
}

/// A bash in a pseudoterminal.
class Terminal {
public:
    /// Throws if no pseudoterminal is available.
    explicit Terminal(const fs::path& folder) {
        child_ = forked(forkpty(&side_, nullptr, nullptr, nullptr));
        if (child_ == 0) {
            if (chdir(folder.c_str()) != 0) _exit(99);
            setenv("PS1", "ready> ", 1);
            setenv("TERM", "dumb", 1);
            setenv("INPUTRC", "/dev/null", 1);
            setenv("HISTFILE", "/dev/null", 1);
            setenv("PATH", ((folder / "bin").string() + ":" + getenv("PATH")).c_str(), 1);
            execl("/bin/bash", "bash", "--norc", "--noprofile", "-i", nullptr);
            _exit(98);
        }
    }
    ~Terminal() {
        kill(child_, SIGKILL);
        close(side_);
        wait_for(child_);
    }
    void type(const std::string& keys) { EXPECT_EQ(write(side_, keys.data(), keys.size()), ssize_t(keys.size())); }
    /// The output up to the words and until a short pause after them.
    std::string until(const std::string& words) {
        std::string said;
        pollfd wanted{.fd = side_, .events = POLLIN, .revents = 0};
        while (poll(&wanted, 1, said.find(words) == std::string::npos ? 20000 : 100) > 0) {
            char bytes[4096];
            const auto count = read(side_, bytes, sizeof bytes);
            if (count <= 0) break;
            said.append(bytes, static_cast<std::size_t>(count));
        }
        return said;
    }

private:
    int side_ = -1;
    pid_t child_ = -1;
};

TEST(Completion, WorksOnATerminal) {
    const auto folder = folder_with_doppel();
    std::optional<Terminal> started;
    try {
        started.emplace(folder);
    } catch (const std::system_error& error) {
        GTEST_SKIP() << "no terminal, as in a root without /dev/pts: " << error.what();
    }
    Terminal& terminal = *started;
    terminal.until("ready> ");
    terminal.type("source <(doppel completion bash)\n");
    terminal.until("ready> ");
    const auto arguments = [&](const std::string& keys) {
        fs::remove(folder / "args");
        terminal.type(keys + "\n");
        EXPECT_TRUE(wait_until([&] { return fs::exists(folder / "args"); })) << keys;
        terminal.until("ready> ");
        return lines_of(bytes_of(folder / "args"));
    };
    EXPECT_EQ(arguments("doppel rend\tbutterf\t--form\tweb\t"), (Lines{"render", "butterfly", "--format", "webm"}));
    EXPECT_EQ(arguments("doppel render calm --set video.layo\tov\t"),
              (Lines{"render", "calm", "--set", "video.layout=overlay"}));
    EXPECT_EQ(arguments("doppel render calm --set 'video.layo\tov\t--jobs 2"),
              (Lines{"render", "calm", "--set", "video.layout=overlay", "--jobs", "2"}));
    EXPECT_EQ(arguments("doppel figure poinc\t --set section.orb\t3"),
              (Lines{"figure", "poincare", "--set", "section.orbits=3"}));
}

}  // namespace doppel::completion_test
