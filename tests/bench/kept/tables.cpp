#include "base/error.hpp"
#include "bench/kept/performance.hpp"

#include <set>
#include <string>
#include <utility>
#include <vector>

// The tables of docs/performance.md. Their text is here; their numbers come from the stored file alone.

namespace doppel {
namespace {

/// Rounds to two digits, or to a whole number if that has more digits.
std::string two_digits(double x) {
    if (x >= 9.95) return fmt::format("{:.0f}", x);
    return x >= 0.995 ? fmt::format("{:.1f}", x) : fmt::format("{:.2g}", x);
}

/// Access to the stored file for the tables.
class Kept {
public:
    explicit Kept(const Performance& all) : all_(all) {}

    const Performance& all() const { return all_; }
    double ns(const std::string& name) const { return one(name).ns; }
    double counter(const std::string& name, const std::string& which) const {
        const auto& counters = one(name).counters;
        const auto at = counters.find(which);
        if (at == counters.end()) throw bad_input("docs/performance.json: {} has no \"{}\"", name, which);
        return at->second;
    }
    /// The widths of the processor's registers in doubles.
    std::set<int> widths() const {
        std::set<int> all;
        const std::string start = "lanes/euler/angles_2/width_";
        for (const auto& [name, one] : all_.benchmarks)
            if (name.starts_with(start)) all.insert(std::stoi(name.substr(start.size())));
        return all;
    }

private:
    const Measured& one(const std::string& name) const {
        const auto at = all_.benchmarks.find(name);
        if (at == all_.benchmarks.end()) throw bad_input("docs/performance.json has no {}", name);
        return at->second;
    }
    const Performance& all_;
};

using Cells = std::vector<std::string>;

std::string table(const std::vector<Cells>& rows) {
    std::string text;
    const auto line = [&](const Cells& cells) {
        for (const auto& cell : cells) text += "| " + cell + " ";
        text += "|\n";
    };
    line(rows[0]);
    for (std::size_t i = 0; i < rows[0].size(); ++i) text += "|---";
    text += "|\n";
    for (std::size_t i = 1; i < rows.size(); ++i) line(rows[i]);
    return text;
}

std::string machine(const Kept& kept) {
    const auto& all = kept.all();
    return fmt::format(
        "{}; {}, {}, {}.\nThe reference loop (`tests/bench/reference.cpp`), which ran before and after each, took "
        "{} ms; half of its rounds were within {:.1f} % of that.\n",
        all.machine, all.system, all.compiler, all.date, two_digits(all.reference_ns / 1e6),
        100 * all.reference_spread);
}

std::string films(const Kept& kept) {
    const std::string film = "end_to_end/doppel", drawn = "draw/alone", large = "draw/alone_4k";
    const auto of = [&](const char* counter) { return kept.counter(film, counter); };
    const auto ms = [&](const std::string& name) { return two_digits(kept.ns(name) / 1e6); };
    return table(
        {{"", ""},
         {"end to end, the whole film: simulation, drawing, x264",
          fmt::format("{:.0f} frames/s; {:.1f} ms of CPU a frame", of("frames/s"), of("cpu ms/frame"))},
         {"x264 alone (veryfast, crf 18), the same frames from memory, turn by turn",
          fmt::format("{:.1f} ms: Doppel as a whole takes {:.2f} of it, with {:.2f} times the bytes, {:.1f} dB more "
                      "({:.1f} dB where "
                      "something moves), and a structural similarity {:.5f} lower ({:.5f})",
                      of("cpu ms/frame floor"), of("cpu of floor"), of("bytes of floor"), of("dB more"),
                      of("dB more, moving"), -of("ssim more"), -of("ssim more, moving"))},
         {"drawing a frame with trails and glow, as one waits for it",
          fmt::format("{:.2f} ms, of which {:.0f} % of the pixels change; {} ms at 3840×2160",
                      kept.counter(drawn, "wall ms"), 100 * kept.counter(drawn, "px changed") / (1920.0 * 1080),
                      two_digits(kept.counter(large, "wall ms")))},
         {"the same, and what changed converted to YUV",
          two_digits(kept.counter("draw/and_convert_what_changed", "wall ms")) + " ms"},
         {"converting all of a frame", ms("convert_whole_frame") + " ms"},
         {"composing a frame", two_digits(kept.ns("compose") / 1e6) + " ms"},
         {"a PNG of a frame", fmt::format("{} ms, {:.0f} KB", ms("png"), kept.counter("png", "KB"))}});
}

std::string simulation(const Kept& kept) {
    std::vector<Cells> methods{
        {"a step of one pendulum, ns", "Euler", "without sines carried over", "midpoint", "RK4"}};
    for (const auto& [words, name] : {std::pair("angles, 2 links", "angles_2"),
                                      {"angles, 3 links", "angles_3"},
                                      {"angles, 8 links", "angles_8"},
                                      {"two rods", "constraints_2"},
                                      {"three rods", "constraints_3"},
                                      {"eight rods", "constraints_8"}}) {
        methods.push_back({words});
        for (const char* method : {"euler", "euler, nothing incremental", "midpoint", "rk4"})
            methods.back().push_back(two_digits(kept.ns(std::string(name) + "/" + method) / 1e3));
    }
    const auto widths = kept.widths();
    std::vector<Cells> lanes{{"a step and trial in lanes, ns"}};
    for (const int width : widths) lanes[0].push_back(fmt::format("{} doubles to a register", width));
    for (const auto& [method, method_words] : {std::pair("euler", "Euler"), {"rk4", "RK4"}})
        for (const auto& [words, name] : {std::pair("angles, 2 links", "angles_2"),
                                          {"angles, 3 links", "angles_3"},
                                          {"two rods", "constraints_2"},
                                          {"three rods", "constraints_3"}}) {
            lanes.push_back({fmt::format("{}, {}", method_words, words)});
            for (const int width : widths)
                lanes.back().push_back(
                    two_digits(kept.counter(fmt::format("lanes/{}/{}/width_{}", method, name, width), "ns")));
        }
    std::vector<Cells> chains{{"links"}, {"a step of `taylor` at order 24, µs"}, {"the same a link, µs"}};
    for (int links = 8; links <= 1024; links *= 2) {
        const auto name = fmt::format("step_of_chain/{}", links);
        chains[0].push_back(std::to_string(links));
        chains[1].push_back(two_digits(1e6 * kept.counter(name, "s/step")));
        chains[2].push_back(two_digits(1e6 * kept.counter(name, "s/step/link")));
    }
    return fmt::format(
        "1000 double pendulums, Euler at 30 kHz, from one sample at 120 Hz to the next: {} ms.\n\n{}\n{}\n{}",
        two_digits(kept.ns("lanes/thousand_pendulums") / 1e6), table(methods), table(lanes), table(chains));
}

std::string figures(const Kept& kept) {
    std::vector<Cells> rows{{"command", "CPU time, s", "time, s"}};
    const auto add = [&](const std::string& words, const std::vector<std::string>& names) {
        double cpu = 0, wall = 0;
        for (const auto& name : names) {
            cpu += kept.ns("figure/" + name) / 1e9;
            wall += kept.counter("figure/" + name, "wall s");
        }
        rows.push_back({words, two_digits(cpu), two_digits(wall)});
    };
    add("the eleven figures of the study, pictures included", {"study"});
    add("`fig8`: 272 million steps of three links (\"over 1.5 hours\" in the study)", {"fig8"});
    add("`flip-map`: a million releases, 20 s of motion each", {"flip-map"});
    add("`lyapunov-spectrum`: four exponents over 1000 s", {"lyapunov-spectrum"});
    add("`droplet`: eight runs of 120 s in quad, two tolerances", {"droplet"});
    for (const char* name : {"poincare", "stability", "drift", "speed-accuracy"})
        add(fmt::format("`{}`", name), {name});
    return table(rows);
}

std::string accuracy(const Kept& kept) {
    std::vector<Cells> rows{{"`taylor`, µs", "1e-3", "1e-6", "1e-9", "1e-12 rad"}};
    for (const auto& [words, name] : {std::pair("P1: 90°/90°, 10 s", "P1_90_90_10s"),
                                      {"P2: 30°/0°, 60 s", "P2_30_0_60s"},
                                      {"P3: 150°/90°, 5 s", "P3_150_90_5s"},
                                      {"P4: triple, 120°/0°/0°, 5 s", "P4_120_0_0_5s"}}) {
        rows.push_back({words});
        for (const char* error : {"1e-03", "1e-06", "1e-09", "1e-12"})
            rows.back().push_back(two_digits(kept.ns(std::string(name) + "/" + error) / 1e3));
    }
    return table(rows);
}

/// The table of the measurements with --build.
std::string building(const Kept& kept) {
    std::vector<Cells> rows{{"", "time, s", "CPU time, s", "CPU time, units"}};
    for (const auto& [words, name] : {std::pair("a clean build of the program", "building/program"),
                                      {"then of all tests", "building/tests"},
                                      {"running all tests", "building/suite"}})
        if (kept.all().benchmarks.contains(name))
            rows.push_back({words, fmt::format("{:.0f}", kept.counter(name, "wall s")),
                            fmt::format("{:.0f}", kept.ns(name) / 1e9),
                            fmt::format("{:.1f}", kept.counter(name, "units"))});
    return rows.size() > 1 ? table(rows) : "Not measured on this machine yet (`tests/update-performance --build`).\n";
}

struct Table {
    const char* name;
    std::string (*text)(const Kept&);
};
constexpr Table tables[] = {{"machine", machine}, {"films", films},       {"simulation", simulation},
                            {"figures", figures}, {"accuracy", accuracy}, {"building", building}};

}  // namespace

std::string with_tables(const std::string& page, const Performance& all) {
    std::string made = page;
    for (const auto& [name, text] : tables) {
        const auto start = fmt::format("<!-- measured: {} -->\n", name),
                   end = fmt::format("<!-- end of {} -->\n", name);
        const auto from = made.find(start), to = made.find(end);
        if (from == std::string::npos || to == std::string::npos || to < from)
            throw bad_input("docs/performance.md lacks the lines \"{}\" and \"{}\"", start.substr(0, start.size() - 1),
                            end.substr(0, end.size() - 1));
        made.replace(from + start.size(), to - from - start.size(), text(Kept(all)));
    }
    return made;
}

}  // namespace doppel
