#include "integrate/methods.hpp"
#include "scene/numeric_key.hpp"
#include "scene/resolved.hpp"
#include "scene/side_keys.hpp"
#include "scene/toml_reader.hpp"

#include <algorithm>
#include <memory>
#include <tuple>

namespace doppel {
namespace {

/// What layouts, strips and views require of the sides, and of each other.
void check_layout(const Preset& preset, TomlReader& top, TomlReader& video, const TomlReader& scene) {
    const auto &a = preset.a, &b = preset.b;
    const auto& spec = preset.video;
    const auto name = name_of(spec.layout);
    const auto is = [&](Arrangement layout) { return spec.layout == layout; };
    const bool is_ensemble = is(Arrangement::ensemble), is_phase = is(Arrangement::phase);
    const bool are_chains = a.particles.empty() && b.particles.empty();
    const auto masses = static_cast<int>(std::min(a.masses(), b.masses()));
    const auto links = static_cast<int>(std::min(a.links(), b.links()));
    if (is(Arrangement::single) && top.has("b"))
        throw video.error("layout",
                          "\"single\" shows side a alone, but the preset has a table [b]; leave [b] out, or take "
                          "\"side-by-side\"");
    for (const auto strip : spec.strips) {
        using enum StripKind;
        if (is(Arrangement::single) && (strip == distance || strip == exponent || strip == energies_b))
            throw video.error("panels", "must be about side a for the layout \"single\"; \"{}\" is about a pair",
                              name_of(strip));
        if (!are_chains && (strip == angles || strip == rates))
            throw video.error("panels", "\"{}\" is for chains; the sides are mechanisms", name_of(strip));
    }
    if (spec.view.follow > masses)
        throw video.inner("view").error("follow", "must be from 0 to {}, as there are masses; it is {}", masses,
                                        spec.view.follow);
    if (!spec.pendulums && (spec.view.follow > 0 || spec.view.center_m || spec.view.height_m))
        throw video.error("view",
                          "is about the pendulums, but panels does not contain \"pendulums\"; leave [video.view] out");
    if (preset.member_columns && !is_ensemble)
        throw scene.error("member_columns", "is for the layout \"ensemble\"; it is \"{}\"", name);
    if (!are_chains && (is_ensemble || is_phase))
        throw video.error("layout", "\"{}\" is for chains; the sides are mechanisms", name);
    if (is_phase && spec.phase == PhaseKind::section && (links < 2 || spec.phase_link == 1))
        throw video.error("phase", "\"section\" is where link 1 passes 0 upwards, so it needs phase_link from 2 on");
    if (is_phase && spec.phase_link > links)
        throw video.error("phase_link", "must be from 1 to {}, as there are links; it is {}", links, spec.phase_link);
    if (!is_ensemble) return;
    if (differ_in_kind(a, b))
        throw video.error(
            "layout",
            "\"ensemble\" interpolates between the sides, so both need the same number of links; they have {} and {}",
            a.links(), b.links());
    if (!a.track.is_none() || !b.track.is_none())
        throw video.error("layout", "\"{}\" needs two simulations; a side shows a track", name);
    if (a.is_mechanism() || b.is_mechanism())
        throw video.error("layout", "\"{}\" is for chains without further constraints and forces", name);
    for (const auto& pair : differing_keys(a, b))
        if (const auto& key = pair.any(); key.is_setting || (!pair.has_numbers() && key.place != "pivot motion"))
            throw video.error("layout", "\"{}\" needs sides that differ only in numbers of the system, not in {}", name,
                              key.name());
}

void check_layout(const TomlReader& table, const VideoSpec& video) {
    const bool is_portrait = video.layout == Arrangement::portrait;
    if (is_portrait && video.size.height < video.size.width)
        throw table.error("size", "must be higher than wide for the layout \"portrait\"; it is [{}, {}]",
                          video.size.width, video.size.height);
    if (!video.pendulums && video.layout != Arrangement::side_by_side && !is_portrait &&
        video.layout != Arrangement::single)
        throw table.error("panels", "must contain \"pendulums\" for the layout \"{}\"", name_of(video.layout));
}

/// A quarter of the pixels and the least effort; the command line overrides this.
void make_preview(TomlReader& table, VideoSpec& video) {
    const auto half = [](int pixels) { return std::max(pixels / 4 * 2, static_cast<int>(size_field.bounds.low)); };
    if (!table.from_command_line("size")) video.size = {half(video.size.width), half(video.size.height)};
    if (!video.format_row().is_encoded()) return;
    if (!table.from_command_line("preset")) video.preset = "ultrafast";
    if (!table.from_command_line("crf")) video.crf = 26;
}

void read_video(TomlReader& table, VideoSpec& video) {
    bool is_preview = false;
    table(preview_field, is_preview);
    table(size_field, video.size);
    video_fields(table, video);
    if (video.layout == Arrangement::portrait && !table.has("size")) video.size = {1080, 1920};
    // members of an ensemble have short trails
    if (video.layout == Arrangement::ensemble && !table.has("trail_s"))
        video.trail_s = video.members.releases.empty() ? 0.3 : 1;
    table.finish();
    table.check_together([&] {
        check_layout(table, video);
        // the frame rate is checked once it is known
        if (const auto error = format_error(video)) throw table.error(error->key, "{}", error->words);
        if (video.layout == Arrangement::ensemble && video.glow_px.value_or(0) > 0)
            throw table.error("glow_px", "must be 0 for the layout \"ensemble\", whose trails do not glow; it is {}",
                              *video.glow_px);
    });
    if (is_preview) make_preview(table, video);
}

/// Reads the font of the film's text first, because it decides which letters are allowed. The path is relative to the
/// preset, or else to the current folder; from the command line always to the latter. Returns whether the font is
/// known.
bool read_font(TomlReader& top, const std::string& preset_path, VideoSpec& video) {
    auto fonts = top.inner("video").inner("fonts");
    constexpr std::string_view key = "text";
    std::string given;
    fonts({.key = key}, given);
    if (given.empty()) return !fonts.has(key);
    video.text_font = path_beside(preset_path, given, fonts.from_command_line(key));
    return fonts.guarded(key, [&] { video.typeface = Typeface::with_system_fonts(Font::from_file(*video.text_font)); });
}

/// If members of an ensemble are listed, its pair is the first and the last one. A list that some of them lack goes from
/// side a to side b there. Throws if the file gives a side other numbers, or lists with too many or too few of them.
void place_members(TomlReader& top, TomlReader& video, Preset& preset) {
    auto& members = preset.video.members.releases;
    if (members.empty()) return;
    for (std::size_t k = 0; k < members.size(); ++k)
        for (const auto& list : Release::lists)
            if (const auto count = (members[k].*list.member).size(); count > 0 && count != preset.a.links())
                throw video.error("members", "must have {} numbers each, one a link; {} of [{}] has {}",
                                  preset.a.links(), list.key, k, count);
    for (const auto& list : Release::lists) {
        if (std::ranges::all_of(members, [&](const Release& member) { return (member.*list.member).empty(); }))
            continue;
        for (std::size_t k = 0; k < members.size(); ++k)
            if (auto& numbers = members[k].*list.member; numbers.empty())
                numbers = between(preset.a, preset.b, Quad(k) / Quad(members.size() - 1)).*list.of_side;
        const auto &first = members.front().*list.member, &last = members.back().*list.member;
        auto &of_a = preset.a.*list.of_side, &of_b = preset.b.*list.of_side;
        for (const auto& [table, given, member] :
             {std::tuple("a", &of_a, &first), {"b", &of_b, &last}, {"system", &of_a, &first}}) {
            auto side = top.inner(table);
            const bool is_replaced = video.from_command_line("members") && !side.from_command_line(list.key);
            if (is_replaced || !side.has(list.key) || *given == *member) continue;
            throw video.error("members", "must begin with side a and end with side b; [{}] {} is {}, the member's {}",
                              table, list.key, toml_value(*given), toml_value(*member));
        }
        of_a = first;
        of_b = last;
    }
}

std::string kind_in(TomlReader& scene) {
    std::string kind(pair_kind);
    scene(kind_field, kind);
    return kind;
}

}  // namespace

std::string read_kind(TomlReader& scene, const PresetText& source, bool is_film) {
    const auto kind = kind_in(scene);
    scene.throw_if_any();  // without the kind it is unknown which tables are allowed
    if ((kind == pair_kind) == is_film) return kind;
    const auto wanted = is_film ? "\"pair\" for a film" : "that of a figure";
    if (scene.from_command_line("kind")) throw scene.error("kind", "must be {}; it is \"{}\"", wanted, kind);
    throw bad_input(
        "{}: this is a {} {}", source.path,
        is_film ? "figure, not a film; draw it with: doppel figure" : "film, not a figure; make it with: doppel render",
        source.call);
}

void check_clock(const Preset& preset, const TomlReader& scene) {
    constexpr long max_digits = 1'000'000'000;
    if (preset.sample_hz.numerator > max_digits || preset.sample_hz.denominator > max_digits)
        throw scene.error("sample_hz", "must be a fraction of whole numbers up to {}; it is {}", max_digits,
                          preset.sample_hz.text());
    for (const auto* side : {&preset.a, &preset.b}) {
        if (!side->track.is_none() || side->accuracy || find_method(side->integrator)->adaptive) continue;
        const auto rate = quotient({1, 1}, side->step());
        const auto steps = rate ? quotient(*rate, preset.sample_hz) : std::nullopt;
        if (!steps || !steps->is_whole())
            throw scene.error("sample_hz", "must divide the step rate, {} Hz on side {}; it is {}",
                              rate ? rate->text() : "?", side == &preset.a ? "a" : "b", preset.sample_hz.text());
    }
    const auto samples = product(preset.duration_s, preset.sample_hz);
    if (!samples || !samples->is_whole())
        throw scene.error("duration_s", "must be a whole number of samples at {} Hz; {} s are {}",
                          preset.sample_hz.text(), preset.duration_s.value(),
                          samples ? fmt::format("{}", samples->value()) : "too many");
    constexpr long max_samples = 100'000'000;
    if (samples->numerator > max_samples)
        throw scene.error("duration_s", "must be at most {} samples; it is {}", max_samples, samples->numerator);
}

Preset read_preset(const PresetText& source, const std::vector<Override>& overrides) {
    Preset preset;
    preset.document = std::make_shared<const TomlDocument>(parse_document(source, overrides));
    const auto& document = *preset.document;
    KeyErrors errors;
    preset.name = preset.title = source.name;
    auto first = document.top(&errors);
    const bool knows_font = read_font(first, source.path, preset.video);
    const auto font = preset.video.text_font;
    auto top = document.top(&errors, knows_font ? &preset.video.typeface : nullptr);
    top.require_title(preset.name);
    top(title_field, preset.title);
    top(subtitle_field, preset.subtitle);

    auto scene = top.inner("scene");
    read_kind(scene, source, true);
    film_fields(scene, preset);
    scene.finish();
    read_sides({&top}, preset, true);
    auto video = top.inner("video");
    read_video(video, preset.video);
    preset.video.text_font = font;  // path as found
    top.finish();
    errors.throw_if_any();
    place_members(top, video, preset);
    check_clock(preset, scene);
    check_frames(preset, video);
    check_layout(preset, top, video, scene);
    return preset;
}

std::string kind_of_preset(const PresetText& source) {
    const auto document = parse_document(source, {});
    auto scene = document.top().inner("scene");
    return kind_in(scene);
}

bool is_figure(const PresetText& source) {
    return kind_of_preset(source) != pair_kind;
}

}  // namespace doppel
