#include "film/page.hpp"

#include "film/estimate.hpp"
#include "film/runs.hpp"
#include "numeric/state.hpp"
#include "output/packed.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <sstream>
#include <tuple>

namespace doppel::page_test {

namespace fs = std::filesystem;

std::string page_of(const std::string& text, const RunOptions& options = {}) {
    auto in = options;
    in.out = test::fresh_folder();
    render(scene_of_text(text), in);
    return test::bytes_of(in.out / "x" / "x.html");
}

/// The film's data.
nlohmann::ordered_json data_of(const std::string& page) {
    return test::data_of(page).at("film");
}

std::string html(const std::string& keys) {
    return keys + "\n[video]\nformat = \"html\"\n";
}

/// What a JavaScript engine prints for the page's chain.js followed by `program`; nothing without an engine.
std::optional<std::string> printed_by_script(const std::string& program) {
    const auto folder = test::fresh_folder();
    const auto script = folder / "script.js";
    test::write_bytes(script, test::bytes_of(fs::path(DOPPEL_SOURCE_DIR) / "src/film/page/chain.js") +
                                  "var write = typeof print === 'function' ? print : console.log;\n" + program);
    for (const std::string engine : {"qjs", "duk", "node"}) {
        if (std::system(fmt::format("command -v {} >/dev/null", engine).c_str()) != 0) continue;
        const auto out = folder / "out.txt";
        EXPECT_EQ(std::system(fmt::format("{} {} > {}", engine, script.string(), out.string()).c_str()), 0) << engine;
        return test::bytes_of(out);
    }
    return std::nullopt;
}

struct Chains {
    const char* name;
    std::string keys;
};

class PageChains : public testing::TestWithParam<Chains> {};

/// All angles and rates of both pendulums, and their distance: the page's values against Doppel's.
TEST_P(PageChains, AreComputedToTheLastBit) {
    const auto scene = scene_of_text(html(GetParam().keys));
    ASSERT_TRUE(page_computes(scene));
    const auto chains = Json{chain_json(scene.a.motion), chain_json(scene.b.motion)};
    const auto text = printed_by_script(fmt::format(
        "var of = {}, samples = {}, n = of[0].mass.length, none = function () {{}};\n"
        "var states = of.map(function (p) {{ return chains.run(p, p.method, p.step, p.steps, samples, none); }});\n"
        "for (var i = 0; i <= samples; ++i) {{\n"
        "  var line = [], bobs = of.map(function (p, k) {{ return chains.bobs(p, states[k], 2 * n * i); }});\n"
        "  for (var k = 0; k < 2; ++k) for (var j = 0; j < 2 * n; ++j) line.push(states[k][2 * n * i + j]);\n"
        "  line.push(chains.distance(bobs[0], bobs[1]), chains.energy(of[0].gravity, bobs[0]));\n"
        "  write(line.join(' '));\n"
        "}}\n",
        chains.dump(), scene.samples));
    if (!text && std::getenv("CI")) FAIL() << "no engine of JavaScript: install quickjs or duktape";
    if (!text) GTEST_SKIP() << "no engine of JavaScript: install quickjs or duktape";
    std::istringstream lines(*text);
    PairRun pair(scene);
    for (long sample = 0; sample <= scene.samples; ++sample) {
        const auto state = pair.next(never_stopped);
        std::vector<double> expected, found;
        for (const auto* seen : {&state.a, &state.b}) {
            for (const auto& bob : seen->bobs) expected.push_back(bob.theta);
            for (const auto& bob : seen->bobs) expected.push_back(bob.omega);
        }
        expected.insert(expected.end(), {state.distance, state.a.energy});
        std::string line;
        ASSERT_TRUE(std::getline(lines, line)) << sample;
        std::istringstream numbers(line);
        for (std::string number; numbers >> number;) found.push_back(std::strtod(number.c_str(), nullptr));
        ASSERT_EQ(found, expected) << "sample " << sample;
    }
}

std::string chains_of(const std::string& angles, const std::string& other, const std::string& more) {
    return "[scene]\nduration_s = 12\n[system]\nangle_deg = " + angles + "\n" + more + "\n[b]\nangle_deg = " + other;
}
const std::string one = "links = 1\nmass_kg = [1.3]\nlength_m = [0.8]\nomega_deg_per_s = [400]\n",
                  two = "mass_kg = [1, 0.3]\nlength_m = [1, 0.7]\n",
                  three = "links = 3\nmass_kg = [1, 0.4, 2]\nlength_m = [1, 0.7, 1.2]\nomega_deg_per_s = [1, 2, 3]\n";

std::string by(const std::string& method, int hz) {
    return fmt::format("integrator = \"{}\"\nstep_s = \"1/{}\"", method, hz);
}

INSTANTIATE_TEST_SUITE_P(
    Page, PageChains,
    testing::Values(Chains{"EulerOfOne", chains_of("[100]", "[100.01]", one + by("euler", 6000))},
                    Chains{"EulerOfTwo", chains_of("[90, 90]", "[90.003, 90]", by("euler", 30000))},
                    // h ω exceeds the largest turn for which sine and cosine are updated from step to step
                    Chains{"CoarseEulerOfTwo", chains_of("[120, 100]", "[121, 100]", two + by("euler", 1200))},
                    Chains{"EulerOfThree", chains_of("[120, 0, 40]", "[120.1, 0, 40]", three + by("euler", 6000))},
                    Chains{"SemiImplicitOfOne", chains_of("[100]", "[101]", one + by("semi-implicit-euler", 2400))},
                    Chains{"SemiImplicitOfTwo",
                           chains_of("[120, 90]", "[121, 90]", two + by("semi-implicit-euler", 2400))},
                    Chains{"SemiImplicitOfThree",
                           chains_of("[120, 0, 40]", "[120.1, 0, 40]", three + by("semi-implicit-euler", 2400))},
                    Chains{"Rk4OfOne", chains_of("[100]", "[100.01]", one + by("rk4", 2400))},
                    Chains{"Rk4OfTwo", chains_of("[120, 100]", "[120.1, 100]", two + by("rk4", 2400))},
                    Chains{"CoarseRk4OfThree", chains_of("[120, 0, 40]", "[120.1, 0, 40]", three + by("rk4", 480))}),
    [](const auto& parameter) { return parameter.param.name; });

TEST(Page, HasTheSizeThatCheckSays) {
    for (const char* name : {"butterfly", "phase-dance", "kapitza", "loop", "horizon"}) {
        auto preset = find_preset(name);
        const auto scene = make_scene(read_preset(preset, {{"video.format", "\"html\"", "test"}}));
        const RunOptions options{.out = test::fresh_folder()};
        render(scene, options);
        const auto bytes = static_cast<double>(fs::file_size(options.out / name / (name + std::string(".html"))));
        EXPECT_LT(bytes, std::string_view(name) == "butterfly" ? 40e3 : 400e3) << name;
        const auto& stop = never_stopped;
        const double ratio = bytes / estimated_render(scene, estimated_simulation(scene, stop), stop).film_bytes;
        EXPECT_NEAR(ratio, 1, 0.1) << name;  // measured: 0.001; more where only a part is tried
    }
}

/// The numbers of all channels, as the page's script reads them.
std::vector<std::vector<double>> channels_of(const Json& film) {
    const auto& motion = film.at("motion");
    const auto count = film.at("samples").get<std::size_t>() + 1;
    const unsigned bits = motion.at("bits"), bytes = bits > 16 ? 3 : 2, most = (1U << bits) - 1;
    const auto planes = test::inflated(motion.at("words"));
    std::vector<unsigned> words(planes.size() / bytes, -128U);
    for (std::size_t i = 0; i < planes.size(); ++i)
        words[i % words.size()] += static_cast<unsigned>(static_cast<unsigned char>(planes[i]))
                                   << (8 * (i / words.size()));
    for (int order = 0; order < 2; ++order)
        for (std::size_t i = 0; i < words.size(); ++i)
            if (i % count > 0) words[i] += words[i - 1];
    std::vector<std::vector<double>> channels;
    std::size_t at = 0;
    for (const auto& channel : motion.at("channels")) {
        auto& numbers = channels.emplace_back();
        for (std::size_t i = 0; i < count; ++i)
            numbers.push_back(channel[0].get<double>() + channel[1].get<double>() * (words[at++] & most));
    }
    EXPECT_EQ(at, words.size());
    return channels;
}

class PageMotion : public testing::TestWithParam<std::tuple<const char*, int>> {};

/// A coordinate is off by at most half a step plus the rounding to float. A chain's bob is off by half a step of its link and
/// a little along the chain, because the errors of other links do not add up.
TEST_P(PageMotion, IsHeldInSteps) {
    const auto& [keys, bits] = GetParam();
    const auto text = html(std::string("[scene]\nduration_s = 2\n") + keys) + fmt::format("position_bits = {}\n", bits);
    const auto data = data_of(page_of(text));
    const auto channels = channels_of(data);
    const auto scene = scene_of_text(text);
    for_each_snapshot(scene, scene.samples, [&](const Snapshot& snapshot) {
        const auto i = static_cast<std::size_t>(snapshot.pair.sample);
        std::size_t channel = 0;
        double error = 0;  // half a step
        const auto next = [&] {
            error = 0.5 * data.at("motion").at("channels")[channel][1].get<double>();
            return channels[channel++][i];
        };
        const auto expect_next = [&](double number) {
            const double found = next();
            EXPECT_NEAR(found, number, error + 3e-7) << i;
        };
        for (std::size_t k = 0; k < 2; ++k) {
            const auto& pendulum = data.at("bodies")[k];
            const auto& seen = k == 0 ? snapshot.pair.a : snapshot.pair.b;
            double x = seen.pivot.x, y = seen.pivot.y;
            for (std::size_t b = 0; b < seen.bobs.size(); ++b) {
                const auto& bob = seen.bobs[b];
                if (pendulum.at("length").is_null()) {
                    expect_next(bob.x);
                    expect_next(bob.y);
                    continue;
                }
                const double length = pendulum.at("length")[b], angle = next();
                x += length * std::sin(angle);
                y -= length * std::cos(angle);
                // measured: 1.2 of 2 links, 1.4 of 64
                EXPECT_LE(std::hypot(x - bob.x, y - bob.y), 1.5 * length * error + 3e-7) << i << " " << b;
            }
            if (!pendulum.at("moves")) continue;
            expect_next(seen.pivot.x);
            expect_next(seen.pivot.y);
        }
        EXPECT_EQ(channel, channels.size());
    });
}

INSTANTIATE_TEST_SUITE_P(
    Page, PageMotion,
    testing::Combine(
        testing::Values("[system]\nangle_deg = [120, 90]\nintegrator = \"taylor\"\n[b]\nangle_deg = [120.01, 90]\n",
                        "[system]\nangle_deg = [120, 90]\nintegrator = \"taylor\"\n"
                        "pivot = { amplitude_m = 0.1, frequency_hz = 2 }\n[b]\nangle_deg = [121, 90]\n",
                        "[system]\nlinks = 64\nangle_deg = 90\nlength_m = 0.03\n"
                        "integrator = \"taylor\"\n[b]\nangle_deg = 91\n",
                        "[system]\nangle_deg = [120, 90]\nmodel = \"constraints\"\nstep_s = \"1/6000\"\n[b]\nangle_deg "
                        "= [121, 90]\n"),
        testing::Values(16, 24)),
    [](const auto& parameter) {
        return fmt::format("OfMotion{}In{}Bits", parameter.index / 2, std::get<1>(parameter.param));
    });

TEST(Page, DoesNoHarmWithAnyWords) {
    const std::string words = R"(</script><script>harm()</script> \" ' & <b> ñ)";
    const auto page = page_of("title = \"" + words + "\"\n[scene]\nduration_s = 0.1\n[a]\nlabel = \"" + words + "\"\n" +
                              html("[b]\nangle_deg = [91, 90]"));
    EXPECT_EQ(page.find("harm()</script>"), std::string::npos);
    EXPECT_EQ(page.find("<b>"), std::string::npos);
    EXPECT_NE(page.find("<title>&lt;/script&gt;"), std::string::npos);
    EXPECT_NE(data_of(page).at("title").get<std::string>().find("</script><script>harm()"), std::string::npos);
}

const std::string pair = html("[scene]\nduration_s = 2\n[b]\nangle_deg = [91, 90]");

TEST(Page, HasTheFilmsOwnPreset) {
    auto preset = scene_of_text(pair).preset;
    preset.video.format = FilmFormat::mp4;
    const std::string own = data_of(page_of(pair)).at("preset");
    EXPECT_EQ(own, resolved_toml(preset));
    EXPECT_EQ(resolved_toml(scene_of_text(own).preset), own);
}

TEST(Page, IsAWholeFilm) {
    test::expect_error(ExitCode::bad_input, {"must begin at 0"}, [&] { page_of(pair, {.from_s = Rational{1, 1}}); });
    const auto part = data_of(page_of(pair, {.to_s = Rational{1, 1}}));
    EXPECT_EQ(part.at("samples"), 119);
    EXPECT_EQ(part.at("duration_s"), 119.0 / 120);
    EXPECT_EQ(part.at("preset"), data_of(page_of(pair)).at("preset")) << "what it is copied as";
    EXPECT_EQ(run_files(scene_of_text(pair), {}), (std::vector<std::string>{"x.html", "x.csv", "x.json"}));
}

TEST(Page, IsAloneWithPosterAndContactSheetLeftOut) {
    EXPECT_EQ(data_of(page_of(pair + "poster_s = 1\ncontact_sheet = [2, 2]\n")).at("poster_s"), 1);
}

/// docs/update-gallery writes the example.
TEST(Page, ExampleOfTheDocsHasTheScriptsOfNow) {
    const auto page = test::bytes_of(fs::path(DOPPEL_SOURCE_DIR) / "docs/butterfly.html");
    const std::string start = "<script type=\"text/packed\">";
    auto at = page.find(start);
    for (const std::string name : {"output/helpers.js", "film/page/chain.js", "film/page/motion.js",
                                   "film/page/player.js", "film/page/controls.js"}) {
        ASSERT_NE(at, std::string::npos) << name;
        const auto script = test::inflated(page.substr(at + start.size(), page.find('<', at + 1) - at - start.size()));
        EXPECT_EQ(script, "\n" + test::bytes_of(fs::path(DOPPEL_SOURCE_DIR) / "src" / name)) << name;
        at = page.find(start, at + 1);
    }
}

TEST(Page, SaysTheLimitsThatTheFilmMarks) {
    const auto without = data_of(page_of(pair)), with = data_of(page_of(pair + "model_limit_s = 0.5\n"));
    for (const std::size_t k : {0u, 1u}) {
        const auto texts = [&](const Json& film) -> const Json& {
            return film.at("pictures")[k].at("strips")[0].at("marks");
        };
        EXPECT_EQ(texts(without), Json({Json::array(), Json::array()}));
        std::string words;  // in rows, because the strip is narrow beside the mark
        for (const auto& row : texts(with)[0]) words += row[1].get<std::string>() + " ";
        EXPECT_EQ(words, "predictability limit of the model 0.5 s ");
        EXPECT_EQ(texts(with)[0], texts(with)[1]) << "they do not diverge";
        EXPECT_GT(with.at("pictures")[k].at("marks").size(), 3u) << "dashes";
        EXPECT_EQ(with.at("pictures")[k].at("backdrop"), without.at("pictures")[k].at("backdrop"));
        EXPECT_EQ(without.at("pictures")[k].at("marks"), Json::array());
    }
}

/// A wide film also has an upright and a small picture; the pictures equal those of the film.
TEST(Page, HasThePicturesOfTheFilm) {
    const auto data = data_of(page_of(pair));
    Json sizes;
    for (const auto& picture : data.at("pictures")) sizes.push_back(picture.at("size"));
    EXPECT_EQ(sizes, Json({{1920, 1080}, {1080, 1920}, {400, 200}}));
    const auto layout = make_layout(scene_of_text(pair));
    EXPECT_NEAR(data.at("pictures")[0].at("panels")[0].at("center")[0], layout.panels[0].center.x, 0.01);
    EXPECT_EQ(data_of(page_of(pair + "size = [720, 1280]\n")).at("pictures").size(), 1u);
}

TEST(Page, CutsNoHeadingThatJustFits) {
    auto preset = find_preset("raindrop");
    const auto scene = make_scene(read_preset(preset, {{"video.size", "[1080, 1920]", "test"}}));
    const auto words = make_layout(scene).words;
    EXPECT_TRUE(std::ranges::any_of(words, [](const Item& item) {
        const auto* label = std::get_if<Label>(&item);
        return label && label->text == "raindrop of 34 mg";
    }));
}

}  // namespace doppel::page_test
