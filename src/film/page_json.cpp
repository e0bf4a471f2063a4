#include "film/page_json.hpp"

#include "film/composer.hpp"
#include "film/layer.hpp"
#include "film/strips.hpp"
#include "output/sink.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace doppel {
namespace {

constexpr std::size_t most_links = 3;  // in chain.js

/// Rounds to 1/100 px.
double rounded(double length) {
    return std::round(100 * length) / 100;
}

Json json_of(const Point& point) {
    return {rounded(point.x), rounded(point.y)};
}

Json json_of(const Area& area) {
    return {rounded(area.left), rounded(area.top), rounded(area.right), rounded(area.bottom)};
}

Json json_of(const Axis& axis) {
    return {axis.low, axis.high, rounded(axis.from), rounded(axis.to), axis.logarithmic};
}

/// The JSON of an item, which begins with a letter for its kind.
struct ItemJson {
    const Typeface& type;

    Json operator()(const Box& box) const {
        return {"b",
                rounded(box.left),
                rounded(box.top),
                rounded(box.right - box.left),
                rounded(box.bottom - box.top),
                rounded(box.corner),
                hexadecimal(box.color)};
    }
    Json operator()(const Capsule& line) const {
        return {"c", json_of(line.from), json_of(line.to), rounded(line.radius), hexadecimal(line.color)};
    }
    Json operator()(const Ring& ring) const {
        return {"r", json_of(ring.center), rounded(ring.radius), rounded(ring.width), hexadecimal(ring.color)};
    }
    Json operator()(const Stroke&) const { return nullptr; }  // no backdrop contains one
    Json operator()(const Label& words) const {
        return {"t",
                words.text,
                json_of(words.anchor),
                rounded(words.size),
                static_cast<int>(words.align),
                words.weight == Weight::bold,
                hexadecimal(words.color),
                rounded(type.width(words.text, words.size, words.weight))};
    }
};

template <class Items>
Json items_json(const Items& items, const Typeface& type) {
    Json list = Json::array();
    for (const auto& item : items) list.push_back(std::visit(ItemJson{type}, Item(item)));
    return list;
}

/// A strip: its axes, its constant items, and the position of its value if it has one.
Json strip_json(const FilmState& state, std::size_t index, double start_distance) {
    const auto& [scene, layout] = std::pair<const Scene&, const Layout&>(state.scene, state.layout);
    const auto& strip = layout.strips[index];
    DisplayList backdrop;
    make_strip_layer(state, index)->backdrop(backdrop);
    const auto curves = strip_curves(strip.kind, scene, state.snapshot.pair, start_distance, layout.style.theme,
                                     layout.style.width.trace);
    auto words = placed_caption(strip, scene, layout, curves, start_distance == 0);
    const bool has_value =
        strip.kind == StripKind::distance || (strip.kind == StripKind::exponent && start_distance > 0);
    Json json{{"area", json_of(strip.area)}, {"time", json_of(strip.time)}, {"axis", json_of(strip.value)}};
    if (has_value && words.back().color == curves[0].color) {
        json["value"] = ItemJson{layout.style.type}(words.back());
        words.pop_back();
    }
    json["words"] = items_json(words, layout.style.type);
    json["backdrop"] = items_json(backdrop, layout.style.type);
    for (const auto& curve : curves) json["widths"].push_back(rounded(curve.width));
    return json;
}

/// A picture of the film's layout: pixels of `scene`'s size.
Json picture_json(const Scene& scene, const MotionBounds& bounds, const Snapshot& first, double start_distance) {
    const FilmState state{scene, make_layout(scene, bounds), first};
    const auto& layout = state.layout;
    const auto& style = layout.style;
    const auto& video = scene.preset.video;
    DisplayList backdrop;
    if (!video.transparent) backdrop.push_back(filled(video.size, style.theme.background));
    Json panels = Json::array(), strips = Json::array();
    for (const auto& panel : layout.panels) {
        make_pendulum_layer(state, panel)->backdrop(backdrop);
        panels.push_back({{"area", json_of(panel.area)},
                          {"sides", panel.sides},
                          {"center", json_of(panel.center)},
                          {"origin", {panel.center_x, panel.center_y}},
                          {"scale", panel.px_per_m}});
    }
    if (layout.phase) make_phase_layer(state, *layout.phase)->backdrop(backdrop);
    for (std::size_t i = 0; i < layout.strips.size(); ++i) strips.push_back(strip_json(state, i, start_distance));
    Json json{{"size", {video.size.width, video.size.height}},
              {"unit", layout.unit},
              {"text", layout.text},
              {"backdrop", items_json(backdrop, style.type)},
              {"words", items_json(layout.words, style.type)},
              {"panels", panels},
              {"strips", strips},
              {"reach", layout.reach},
              {"bob", layout.bob_radius},
              {"lastBob", layout.last_bob_radius},
              {"rod", layout.rod_radius},
              {"trail", style.width.trail},
              {"trace", style.width.trace},
              {"mark", style.width.mark},
              {"grid", style.width.grid},
              {"glow", style.glow},
              {"font", style.font.strip},
              {"em", style.font.axis}};
    if (layout.clock) json["clock"] = ItemJson{style.type}(*layout.clock);
    if (layout.speed) json["speed"] = ItemJson{style.type}(*layout.speed);
    if (layout.phase)
        json["phase"] = {{"area", json_of(layout.phase->area)},
                         {"angle", json_of(layout.phase->angle)},
                         {"rate", json_of(layout.phase->rate)}};
    return json;
}

Json end_json(const End<double>& end) {
    if (const auto* bob = std::get_if<std::size_t>(&end)) return *bob;
    const auto& place = std::get<Place<double>>(end);
    return {place[0], place[1]};
}

/// A pendulum's masses, lines and chain.
Json body_json(const MotionSpec& motion, const Side& side, const std::vector<double>& masses, const Color& color) {
    Json lines = Json::array();
    for (const auto& line : side.lines)
        lines.push_back({static_cast<int>(line.kind), end_json(line.from), end_json(line.to), line.width});
    return {{"mass", masses}, {"color", hexadecimal(color)}, {"lines", lines}, {"chain", chain_json(motion)}};
}

/// The speed over time: [time, s; seconds of motion per second of film; the film's text].
Json speed_json(const Scene& scene) {
    const auto& video = scene.preset.video;
    if (!video.speed.changes_over_time()) return {{0, video.speed.constant.value(), speed_text(scene, 0)}};
    Json table = Json::array();
    constexpr int points = 200;
    const double end = scene.time(scene.samples), dt = end / points;
    for (int i = 0; i < points; ++i)
        table.push_back(
            {i * dt, dt / (film_time(video, (i + 1) * dt) - film_time(video, i * dt)), speed_text(scene, i * dt)});
    return table;
}

Json theme_json(const Theme& theme) {
    Json json;
    for (const auto& color : color_names) json[std::string(color.key)] = hexadecimal(theme.*color.member);
    json["sides"] = {hexadecimal(theme.sides[0]), hexadecimal(theme.sides[1])};
    return json;
}

}  // namespace

std::vector<const MotionSpec*> shown_motions(const Scene& scene) {
    std::vector<const MotionSpec*> motions;
    for (const auto& member : scene.members) motions.push_back(&member);
    for (const char letter : scene.letters())
        if (scene.members.empty()) motions.push_back(&scene.side(letter).motion);
    return motions;
}

Json chain_json(const MotionSpec& motion) {
    if (!motion.chain || motion.physical || motion.parts || motion.chain->links() > most_links) return nullptr;
    const auto chain = motion.chain->cast<double>();
    Json json{{"mass", chain.mass},
              {"length", chain.length},
              {"angle", chain.angle},
              {"rate", chain.rate},
              {"gravity", chain.gravity}};
    constexpr std::array<std::string_view, 3> methods{"euler", "semi-implicit-euler", "rk4"};
    if (motion.model == Model::angles && motion.precision == Precision::in_double &&
        std::ranges::find(methods, motion.method) != methods.end()) {
        json["method"] = motion.method;
        json["step"] = motion.sample_interval.value() / static_cast<double>(motion.steps_per_sample);
        json["steps"] = motion.steps_per_sample;
    }
    return json;
}

bool page_computes(const Scene& scene) {
    const auto motions = shown_motions(scene);
    return std::ranges::none_of(scene.letters(), [&](char letter) { return scene.side(letter).replay.has_value(); }) &&
           std::ranges::all_of(motions, [&](const MotionSpec* motion) {
               return chain_json(*motion).contains("method") && motion->chain->links() == motions[0]->chain->links();
           });
}

bool page_computes(StripKind kind) {
    return kind == StripKind::distance || kind == StripKind::exponent || kind == StripKind::energy;
}

Json page_json(const Scene& scene, const MotionBounds& bounds) {
    const auto& video = scene.preset.video;
    const auto style = make_style(video, 1, 1);
    Json bodies = Json::array(), pictures = Json::array(), strips = Json::array();
    for (std::size_t k = 0; k < scene.members.size(); ++k) {
        const auto& motion = scene.members[k];
        bodies.push_back(body_json(motion, scene.a, masses_of(scene, motion), member_color(style, scene, k)));
    }
    for (const char letter : scene.letters()) {
        const auto& side = scene.side(letter);
        if (!scene.members.empty()) break;
        bodies.push_back(body_json(side.motion, side, side.mass, style.theme.sides[letter == 'a' ? 0 : 1]));
        if (side.replay) bodies.back()["chain"] = nullptr;
    }
    PairRun pair(scene);
    const Snapshot first{pair.next(never_stopped), {}};
    const double start_distance = first.pair.distance;
    pictures.push_back(picture_json(scene, bounds, first, start_distance));
    if (!is_tall(video)) {
        auto upright = scene;
        upright.preset.video.size = {1080, 1920};
        pictures.push_back(picture_json(upright, bounds, first, start_distance));
    }
    for (const auto kind : video.strips) {
        Json curves = Json::array();
        for (const auto& curve : strip_curves(kind, scene, first.pair, start_distance, style.theme, 1))
            curves.push_back(hexadecimal(curve.color));
        strips.push_back({{"kind", name_of(kind)}, {"colors", curves}});
    }
    Json json{{"title", scene.preset.title},
              {"layout", name_of(video.layout)},
              {"show", video.show},
              {"transparent", video.transparent},
              {"trail_s", video.trail_s},
              {"samples", scene.samples},
              {"sample_s", quotient({1, 1}, scene.preset.sample_hz)->value()},
              {"duration_s", scene.time(scene.samples)},
              {"fps", scene.fps.value()},
              {"decimals", clock_text(scene, 0) == "0 s" ? 0 : clock_text(scene, 0).size() - 4},
              {"speed", speed_json(scene)},
              {"start_s", video.poster_s ? video.poster_s->value() : 0},
              {"follow", video.view.follow},
              {"view", video.view.height_m || video.view.center_m || video.view.follow > 0},
              {"theme", theme_json(style.theme)},
              {"bodies", bodies},
              {"strips", strips},
              {"pictures", pictures}};
    if (video.layout == Arrangement::phase)
        json["phase"] = {{"kind", name_of(video.phase)}, {"link", video.phase_link - 1}};
    return json;
}

}  // namespace doppel
