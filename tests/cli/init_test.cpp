// The preset that "doppel init" writes. With the real program.
#include "cli/process.hpp"
#include "figure/kind_tables.hpp"
#include "figure/kinds.hpp"
#include "figure/preset.hpp"
#include "scene/resolved.hpp"

#include <functional>
#include <map>
#include <set>
#include <sstream>

namespace doppel::init_test {

namespace fs = std::filesystem;
using namespace test;
using Init = ProgramTest;

Preset read(const std::string& text) {
    return read_preset({"mine", "mine.toml", text, "mine.toml"});
}

TEST_F(Init, WritesAPresetThatIsCheckedAndRendered) {
    const auto result = done("init mine.toml");
    EXPECT_EQ(result.out, "mine.toml: edit it, then: doppel check mine.toml\n");
    EXPECT_EQ(listing(folder), (Names{"mine.toml", "stdout", "stderr"}));
    done("check mine.toml --set scene.duration_s=0.1");
    done("render mine.toml --set scene.duration_s=0.1 --size 160x90");
    EXPECT_TRUE(fs::exists(folder / "out/mine/mine.mp4"));
    // butterfly with an accuracy instead of the study's method
    const auto preset = read(bytes_of(folder / "mine.toml"));
    EXPECT_EQ(preset.a.accuracy, parse_quad("1e-3"));
    const auto again = read_preset(find_preset("butterfly"), {parse_set("system.accuracy=1e-3")});
    EXPECT_EQ(resolved_pair(preset), resolved_pair(again));
    for (const auto* entry : {"torque", "particle", "constraint", "force"})
        EXPECT_TRUE(has(bytes_of(folder / "mine.toml"), fmt::format("[[system.{}]]", entry))) << entry;
}

/// The keys in comments that cannot be uncommented alone.
Names refused_keys(const std::string& whole, const std::function<void(const std::string&)>& read_text,
                   std::size_t& keys) {
    std::istringstream lines(whole);
    std::size_t at = 0;
    Names refused;
    for (std::string line; std::getline(lines, line); at += line.size() + 1) {
        if (line.size() < 2 || line[0] != '#' || !std::isalpha(static_cast<unsigned char>(line[1]))) continue;
        auto text = whole;
        text.erase(at, 1);
        ++keys;
        try {
            read_text(text);
        } catch (const std::exception&) {
            refused.insert(line.substr(1, line.find(' ') - 1));
        }
    }
    return refused;
}

TEST_F(Init, EachKeyCanBeUncommented) {
    done("init mine.toml");
    std::size_t keys = 0;
    const auto refused = refused_keys(bytes_of(folder / "mine.toml"), read, keys);
    EXPECT_GT(keys, 50u);
    // keys that require other values of other keys
    const Words expected =
        "angles_range codec energies_a_range energies_b_range energy_range exponent_range integrator "
        "members phase phase_link pivot.direction_deg pivot.frequency_hz pivot.phase_deg position_bits "
        "rates_range rod_error_range rod_force_range speed_ease_s stabilise_rate_per_s step_s tolerance "
        "total_energy_range track.offset_deg track.start_s";
    EXPECT_EQ(refused, Names(expected.begin(), expected.end()));
}

TEST_F(Init, WritesAPresetOfEveryKindOfFigure) {
    for (const auto& kind : figure_kinds()) {
        const std::string name(kind.name), file = name + ".toml";
        EXPECT_EQ(done({"init", "--figure", name}).out, file + ": edit it, then: doppel check " + file + "\n");
        // `check` of a work-precision figure computes the references of all problems, 5 s
        const Words check = name == "work-precision" ? "figure --list-outputs"
                            : name == "section"      ? "check"
                                                     : "check --set scene.duration_s=1";
        done(with(check, file));
        const auto text = bytes_of(folder / file);
        EXPECT_EQ(doppel({"show", file}).out, text);
        EXPECT_EQ(kind_of_preset({name, file, text, file}), name);
        for (const auto& table : tables_of(name))
            for (const auto& field : table.fields) {
                const auto key = std::string(field.key) + " = ";
                EXPECT_TRUE(has(text, "\n" + key) || has(text, "\n#" + key)) << name << ": " << key;
                if (field.key == "title" || field.key == "kind") continue;  // given by the file's name and the option
                EXPECT_TRUE(has(text, "# " + std::string(field.help) + " (")) << name << ": " << key;
            }
    }
}

TEST_F(Init, EachKeyOfAFigureCanBeUncommented) {
    // keys that require other values of other keys, and keys that the figure sets itself
    std::map<std::string_view, Names> beside{
        {"grid",
         {"threshold", "exponent_duration_s", "flip_tolerance", "integrator", "link", "periods", "right",
          "stabilise_rate_per_s", "step_s", "tolerance", "transient_periods", "mark_step_s", "x.labels",
          "x.tolerance_from", "x.tolerance_to", "x.tolerance_points", "pivot.direction_deg", "pivot.frequency_hz",
          "pivot.phase_deg"}},
        {"series",
         {"integrator", "step_s", "tolerance", "check_tolerance", "duration_s", "film_column", "samples",
          "points_per_decade", "evaluations_per_s", "methods", "projected", "stabilise_rate_per_s",
          "pivot.direction_deg", "pivot.frequency_hz", "pivot.phase_deg"}},
        {"work-precision", {"duration_s"}}};
    for (const auto& kind : figure_kinds()) {
        const std::string name(kind.name);
        done({"init", "--figure", name});
        std::size_t keys = 0;
        auto whole = bytes_of(folder / (name + ".toml"));
        if (const auto at = whole.find("\nduration_s = 30"); at != std::string::npos)
            whole.replace(at, 16, "\nduration_s = 1");  // what an accuracy takes is computed for each key
        auto refused = refused_keys(
            whole,
            [](const auto& text) {
                read_figure({"x", "x.toml", text});
            },
            keys);
        EXPECT_GT(keys, 8u) << name;
        std::erase_if(refused, [](const std::string& key) {  // keys of axes that have no key
            return key.starts_with("y.") || key.starts_with("color.") || key.starts_with("panel.");
        });
        EXPECT_EQ(refused, beside[kind.name]) << name;
    }
}

TEST_F(Init, WritesAFigureThatIsDrawn) {
    done("init mine.toml --figure section");
    const auto figure = done(
        "figure mine.toml --set section.orbits=2 --set section.crossings=10 --set section.exponent_duration_s=100 "
        "--set chart.scale=0.25");
    EXPECT_TRUE(fs::exists(folder / "out/mine/mine.png"));
    // pairs that differ
    for (const auto& [kind, small, column] :
         {std::tuple{"grid", std::vector<std::string>{"grid.x.step=30", "scene.duration_s=2"}, "average_log_ratio"},
          {"grid",
           {"grid.x.points=8", "grid.y.key=\"theta2_deg\"", "grid.y.points=8", "grid.quantity=\"flip_time\"",
            "scene.duration_s=5"},
           "flip_time_s"}}) {
        const std::string file = std::string(kind) + ".toml";
        doppel({"init", "--figure", kind});
        std::vector<std::string> arguments{"figure", file, "--set", "chart.scale=0.25"};
        for (const auto& set : small) arguments.insert(arguments.end(), {"--set", set});
        done(arguments);
        const auto table = bytes_of(folder / "out" / kind / (std::string(kind) + ".csv"));
        EXPECT_TRUE(has(table, column));
        const std::string last = table.substr(table.rfind(',', table.size()) + 1);
        EXPECT_GT(last.size(), 4u) << kind << last;  // a number and a line end
    }
    EXPECT_EQ(doppel("init --figure pair").code, 2);
    EXPECT_EQ(doppel("init").err, "doppel: init needs the name of the new file: doppel init FILE.toml\n");
    EXPECT_EQ(doppel("init mine.toml --figure grid").err, "doppel: mine.toml: exists already; give a new name\n");
}

TEST_F(Init, NeverReplacesAFile) {
    write_bytes(folder / "mine.toml", "title = \"mine\"\n");
    fs::create_symlink("nowhere", folder / "link.toml");
    for (const auto& [name, message] : std::vector<std::pair<std::string, std::string>>{
             {"mine.toml", "mine.toml: exists already; give a new name"},
             {"link.toml", "link.toml: exists already; give a new name"},
             {"mine.txt", "mine.txt: the name of a preset's file ends in .toml"},
             {".toml", ".toml: the name of a preset's file ends in .toml"},
             {"a\nb.toml",
              "a b.toml: the name of the preset, \"a b\", is used for its folder and files, and contains the control "
              "character U+000A; rename it"}}) {
        const auto result = ends({"init", name}, 2);
        EXPECT_EQ(result.err, "doppel: " + message + "\n");
    }
    EXPECT_EQ(bytes_of(folder / "mine.toml"), "title = \"mine\"\n");
    const auto missing = ends("init no/such/folder/mine.toml", 4);
    EXPECT_TRUE(one_line(missing.err)) << missing.err;
    EXPECT_FALSE(fs::exists(folder / "no"));
}

TEST_F(Init, WritesNoOtherFile) {
    write_bytes(folder / "mine.toml.part", "mine");
    fs::create_directory(folder / "elsewhere");
    fs::create_directory_symlink("elsewhere", folder / "link");
    for (const char* name : {"mine.toml", "link/mine.toml"}) done({"init", name});
    EXPECT_EQ(bytes_of(folder / "mine.toml.part"), "mine");
    EXPECT_EQ(listing(folder),
              (Names{"elsewhere", "elsewhere/mine.toml", "link", "mine.toml", "mine.toml.part", "stderr", "stdout"}));
}

TEST_F(Init, NamesTheSchemaThatIsThere) {
    fs::create_directories(folder / "presets");
    fs::create_directories(folder / "films");
    fs::copy_file(fs::path(DOPPEL_SOURCE_DIR) / "presets/preset.schema.json", folder / "presets/preset.schema.json");
    done("init films/mine.toml");
    EXPECT_TRUE(bytes_of(folder / "films/mine.toml").starts_with("#:schema ../presets/preset.schema.json\n"));
    const auto check = doppel("check films/mine.toml --set scene.duration_s=0.1");
    EXPECT_FALSE(check.out.starts_with("films/mine.toml:")) << check.out;
}

}  // namespace doppel::init_test
