#include "integrate/methods.hpp"
#include "picture/theme.hpp"
#include "scene/preset.hpp"
#include "scene/side_reader.hpp"
#include "scene/toml_reader.hpp"

#include <algorithm>
#include <cstdlib>

namespace doppel {
namespace {

using namespace std::string_view_literals;

constexpr std::array encoder_presets{"ultrafast"sv, "superfast"sv, "veryfast"sv, "faster"sv,  "fast"sv,
                                     "medium"sv,    "slow"sv,      "slower"sv,   "veryslow"sv};
constexpr std::array formats{"mp4"sv, "png"sv};
constexpr std::array kinds{"pair"sv};
constexpr std::array panel_names{"pendulums"sv, "distance"sv, "energy"sv};
constexpr int smallest_picture = 64, largest_picture = 16384;  // px; more than any GL takes, which says so itself

toml::table parse(const std::string& text, const std::string& path, TomlTexts& texts) {
    try {
        texts[path] = text;
        return toml::parse(text, path);
    } catch (const toml::parse_error& fault) {
        const auto at = fault.source().begin;
        throw bad_input("{}:{}:{}: {}", path, at.line, at.column, fault.description());
    }
}

/// Puts the value of `change` into the tables of `root`, in place of what is there.
void apply(toml::table& root, const Override& change, TomlTexts& texts) {
    auto dot = change.key.find('.');
    toml::table* table = &root;
    std::string key = change.key;
    for (; dot != std::string::npos; dot = key.find('.')) {
        const auto head = key.substr(0, dot);
        if (!table->contains(head)) table->insert(head, toml::table{});
        table = table->get_as<toml::table>(head);
        if (!table) throw bad_input("{}: \"{}\" is no table", change.origin, head);
        key = key.substr(dot + 1);
    }
    toml::table given;
    try {
        auto& text = texts[change.origin] = "value = " + change.value;
        given = toml::parse(text, change.origin);
    } catch (const toml::parse_error& fault) {
        throw bad_input("{}: \"{}\" is no TOML value ({}); strings want quotes: '{}=\"{}\"'", change.origin,
                        change.value, fault.description(), change.key, change.value);
    }
    if (given.size() != 1) throw bad_input("{}: \"{}\" is more than one value", change.origin, change.value);
    // moved, not copied: a copy would forget where it comes from
    std::move(*given.get("value")).visit([&]<class Node>(Node&& node) {
        table->erase(key);
        table->insert(key, std::forward<Node>(node));
    });
}

void apply(toml::table& root, const std::vector<Override>& overrides, TomlTexts& texts) {
    for (std::size_t i = 0; i < overrides.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j)
            if (overrides[i].key == overrides[j].key)
                throw bad_input("{} is given twice: {} and {}", overrides[i].key, overrides[j].origin,
                                overrides[i].origin);
        apply(root, overrides[i], texts);
    }
}

void read_video(TomlReader& table, VideoSpec& video) {
    std::array<double, 2> size{double(video.size.width), double(video.size.height)};
    table.read_numbers("size", size, "width and height");
    for (const double pixels : size) {
        if (pixels != std::floor(pixels) || pixels < smallest_picture || pixels > largest_picture)
            throw table.fault("size", "must be whole numbers from {} to {}; it is [{}, {}]", smallest_picture,
                              largest_picture, size[0], size[1]);
        if (std::fmod(pixels, 2) != 0)
            throw table.fault("size", "must be even, as H.264 needs it; it is [{}, {}]; [{}, {}] would do", size[0],
                              size[1], size[0] + std::fmod(size[0], 2), size[1] + std::fmod(size[1], 2));
    }
    video.size = {static_cast<int>(size[0]), static_cast<int>(size[1])};

    if (table.has("fps")) table.read_positive_ratio("fps", video.fps.emplace());
    table.read_positive_ratio("speed", video.speed);
    table.read_choice("format", video.format, formats);
    table.read_choice("preset", video.preset, encoder_presets);
    table.read_whole("crf", video.crf, 0, 51);

    std::vector<std::string_view> theme_names;
    for (const auto& theme : themes) theme_names.push_back(theme.name);
    table.read_choice("theme", video.theme, theme_names);
    if (const auto colors = table.read_texts("side_colors")) {
        if (colors->size() != 2)
            throw table.fault("side_colors", "must have 2 colours, a and b; it has {}", colors->size());
        auto& sides = video.side_colors.emplace();
        for (std::size_t i = 0; i < 2; ++i) {
            const auto color = parse_color((*colors)[i]);
            if (!color)
                throw table.fault("side_colors", "must be colours such as \"#ff9f40\"; [{}] is \"{}\"", i,
                                  (*colors)[i]);
            sides[i] = *color;
        }
    }
    if (table.has("trail_s")) {
        table.read_number("trail_s", video.trail_s);
        if (video.trail_s < 0 || video.trail_s > 3600)
            throw table.fault("trail_s", "must be from 0 (none) to 3600; it is {}", video.trail_s);
    }
    if (const auto panels = table.read_texts("panels")) {
        const auto shows = [&](std::string_view name) {
            return std::find(panels->begin(), panels->end(), name) != panels->end();
        };
        for (const auto& panel : *panels)
            if (std::find(panel_names.begin(), panel_names.end(), panel) == panel_names.end())
                throw table.fault("panels", "may hold \"{}\"; \"{}\" is none of them", fmt::join(panel_names, "\", \""),
                                  panel);
        if (panels->empty())
            throw table.fault("panels", "must hold at least one of \"{}\"", fmt::join(panel_names, "\", \""));
        video.pendulums = shows("pendulums");
        video.distance = shows("distance");
        video.energy = shows("energy");
    }
    const auto read_range = [&](std::string_view key, std::optional<Range>& into) {
        if (!table.has(key)) return;
        std::array<double, 2> ends{};
        table.read_positives(key, ends, "lowest and highest");
        if (!(ends[1] >= 10 * ends[0]) || ends[1] / ends[0] > 1e60)
            throw table.fault(key, "must rise by 1 to 60 powers of ten; it is [{}, {}]", ends[0], ends[1]);
        into = Range{ends[0], ends[1]};
    };
    read_range("distance_range", video.distance_range);
    read_range("energy_range", video.energy_range);
    table.finish();
}

/// The whole-number rates next to `rate` (rounded) that divide `steps_per_second`, for the error that has to name them.
std::string rates_that_divide(const Rational& steps_per_second, double rate) {
    const auto divides = [&](long n) {
        const auto ratio = n > 0 ? quotient(steps_per_second, {n, 1}) : std::nullopt;
        return ratio && ratio->is_whole();
    };
    const long start = std::lround(std::min(rate, 1e6));
    std::string text;
    for (long n = start; n > 0 && n > start - 10000; --n)
        if (divides(n)) {
            text = fmt::format("{}", n);
            break;
        }
    for (long n = start + 1; n < start + 10000; ++n)
        if (divides(n)) return text.empty() ? fmt::format("{} would", n) : fmt::format("{} or {} would", text, n);
    return text.empty() ? "a longer or shorter step_s would" : text + " would";
}

/// Steps, samples and frames must fall on each other exactly.
void check_rates(const Preset& preset, const TomlReader& scene, const TomlReader& video) {
    for (const auto* side : {&preset.a, &preset.b}) {
        if (find_method(side->integrator)->adaptive) continue;
        const auto rate = quotient({1, 1}, side->step());
        const auto steps = rate ? quotient(*rate, preset.sample_hz) : std::nullopt;
        if (!steps || !steps->is_whole())
            throw scene.fault("sample_hz", "must divide the step rate, {} Hz on side {}; it is {}; {} do",
                              rate ? rate->text() : "?", side == &preset.a ? "a" : "b", preset.sample_hz.text(),
                              rate ? rates_that_divide(*rate, preset.sample_hz.value()) : "another");
    }
    const auto samples = product(preset.duration_s, preset.sample_hz);
    if (!samples || !samples->is_whole())
        throw scene.fault("duration_s", "must be a whole number of samples at {} Hz; {} s are {}",
                          preset.sample_hz.text(), preset.duration_s.text(), samples ? samples->text() : "too many");
    constexpr long most_samples = 100'000'000;
    if (samples->numerator > most_samples)
        throw scene.fault("duration_s", "must be at most {} samples; it is {}", most_samples, samples->numerator);

    const auto sampled = product(preset.sample_hz, preset.video.speed);
    const auto fps = preset.video.fps ? preset.video.fps : sampled;
    constexpr double most_fps = 1000;
    constexpr long most_digits = 1'000'000;
    if (!fps || fps->value() > most_fps || fps->numerator > most_digits || fps->denominator > most_digits)
        throw video.fault("fps", "must be at most {} and a fraction of whole numbers up to {}; it is {}", most_fps,
                          most_digits, fps ? fps->text() : "beyond them");
    if (!preset.video.fps) return;
    const auto stride = sampled ? quotient(*sampled, *preset.video.fps) : std::nullopt;
    if (!stride || !stride->is_whole())
        throw video.fault("fps", "must divide sample_hz · speed = {}, so that each frame is a sample; it is {}",
                          sampled ? sampled->text() : "?", preset.video.fps->text());
    if (samples->numerator % stride->numerator != 0)
        throw video.fault("fps", "must let the last of {} samples be a frame; with {} one sample in {} is one",
                          samples->numerator, preset.video.fps->text(), stride->numerator);
}

}  // namespace

Preset read_preset(const PresetText& source, const std::vector<Override>& overrides) {
    TomlTexts texts;
    auto root = parse(source.text, source.path, texts);
    apply(root, overrides, texts);

    Preset preset;
    preset.name = preset.title = source.name;
    TomlReader top(&root, "", source.path, texts);
    top.read_text("title", preset.title);

    TomlReader scene(top.read_table("scene"), "[scene]", source.path, texts);
    std::string kind = "pair";
    scene.read_choice("kind", kind, kinds);
    scene.read_positive_ratio("duration_s", preset.duration_s);
    scene.read_positive_ratio("sample_hz", preset.sample_hz);
    scene.finish();

    TomlReader system(top.read_table("system"), "[system]", source.path, texts);
    read_side(system, preset.a);
    preset.b = preset.a;
    TomlReader a(top.read_table("a"), "[a]", source.path, texts), b(top.read_table("b"), "[b]", source.path, texts);
    read_side(a, preset.a);
    read_side(b, preset.b);
    if (preset.a.links() != preset.b.links())
        throw b.fault("links", "must be that of the other side, so that the two can be compared; they are {} and {}",
                      preset.a.links(), preset.b.links());

    TomlReader video(top.read_table("video"), "[video]", source.path, texts);
    read_video(video, preset.video);
    top.finish();
    check_rates(preset, scene, video);
    return preset;
}

Override parse_set(const std::string& argument) {
    const auto equals = argument.find('=');
    const auto key = argument.substr(0, equals);
    if (equals == std::string::npos || key.empty() || key.starts_with('.') || key.ends_with('.') ||
        key.find("..") != std::string::npos)
        throw bad_input("--set wants table.key=VALUE; it is \"{}\"", argument);
    return {key, argument.substr(equals + 1), "--set " + key};
}

}  // namespace doppel
