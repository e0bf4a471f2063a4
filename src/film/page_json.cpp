#include "film/page_json.hpp"

#include "film/layer.hpp"
#include "film/strips.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace doppel {
namespace {

constexpr std::size_t most_links = 3;  // in chain.js

/// The JSON of what pictures consist of; of an item, the name of the function that draws it in player.js and its
/// arguments. Lengths, px, are rounded to 1/100.
struct PictureJson {
    const Typeface& type;

    template <class... Parts>
    Json list(const Parts&... parts) const {
        return Json::array({(*this)(parts)...});
    }
    template <class Items>
    Json all(const Items& items) const {
        Json json = Json::array();
        for (const auto& item : items) json.push_back(std::visit(*this, Item(item)));
        return json;
    }
    Json operator()(const char* text) const { return text; }
    Json operator()(double length) const { return std::round(100 * length) / 100; }
    Json operator()(const Color& color) const { return hexadecimal(color); }
    Json operator()(const Point& point) const { return list(point.x, point.y); }
    Json operator()(const Area& area) const { return list(area.left, area.top, area.right, area.bottom); }
    Json operator()(const Box& box) const {
        return list("box", box.left, box.top, box.right - box.left, box.bottom - box.top, box.corner, box.color);
    }
    Json operator()(const Capsule& line) const { return list("line", line.from, line.to, line.radius, line.color); }
    Json operator()(const Ring& ring) const { return list("ring", ring.center, ring.radius, ring.width, ring.color); }
    Json operator()(const Stroke&) const { return nullptr; }  // no backdrop contains one
    Json operator()(const Label& words) const {
        constexpr std::array<const char*, 3> sides{"left", "center", "right"};
        return list("text", words.text.c_str(), words.anchor, words.size, sides[static_cast<std::size_t>(words.align)],
                    words.weight == Weight::bold ? 700 : 400, words.color,
                    type.width(words.text, words.size, words.weight));
    }
};

/// A strip: its axes, the position of its value if it has one, and colours and widths of curves. Adds its constant
/// items to `backdrop`.
Json strip_json(const FilmState& state, std::size_t index, const PictureJson& json_of, DisplayList& backdrop) {
    const auto& strip = state.layout.strips[index];
    const double start_distance = state.snapshot.pair.distance;
    make_strip_layer(state, index)->backdrop(backdrop);
    const auto curves = strip_curves(strip.kind, state.scene, state.snapshot.pair, start_distance, state.layout.style);
    auto words = placed_caption(strip, state.scene, state.layout, curves, start_distance == 0);
    Json json{{"kind", name_of(strip.kind)},
              {"isHeld", !page_computes(strip.kind)},  // the file contains its curves
              {"area", json_of(strip.area)},
              {"time", axis_json(strip.time)},
              {"axis", axis_json(strip.value)}};
    const bool has_value =
        strip.kind == StripKind::distance || (strip.kind == StripKind::exponent && start_distance > 0);
    if (has_value && words.back().color == curves[0].color) {
        json["value"] = json_of(words.back());
        words.pop_back();
    }
    backdrop.insert(backdrop.end(), words.begin(), words.end());
    for (const auto& curve : curves) json["pens"].push_back(json_of.list(curve.color, curve.width));
    return json;
}

/// A picture of the film's layout: pixels of `scene`'s size. `first`: the snapshot at the start.
Json picture_json(const Scene& scene, const MotionBounds& bounds, const Snapshot& first) {
    const FilmState state{scene, make_layout(scene, bounds), first};
    const auto& layout = state.layout;
    const auto& style = layout.style;
    const auto& video = scene.preset.video;
    const PictureJson json_of{style.type};
    Json json{{"size", {video.size.width, video.size.height}},
              {"unit", layout.unit},
              {"text", layout.text},
              {"reach", layout.reach},
              {"bob", layout.bob_radius},
              {"last_bob", layout.last_bob_radius},
              {"rod", layout.rod_radius},
              {"glow", style.glow},
              {"font", style.font.strip},
              {"em", style.font.axis},
              {"words", json_of.all(layout.words)},
              {"panels", Json::array()},
              {"strips", Json::array()}};
    for (const auto& width : width_names) json[std::string(width.key)] = style.width.*width.member;
    DisplayList backdrop;
    if (!video.transparent) backdrop.push_back(filled(video.size, style.theme.background));
    for (const auto& panel : layout.panels) {
        make_pendulum_layer(state, panel)->backdrop(backdrop);
        json["panels"].push_back({{"area", json_of(panel.area)},
                                  {"shown", panel.shown},
                                  {"center", json_of(panel.center)},
                                  {"origin", {panel.center_x, panel.center_y}},
                                  {"scale", panel.px_per_m}});
    }
    if (const auto& phase = layout.phase) {
        make_phase_layer(state, *phase)->backdrop(backdrop);
        json["phase"] = {
            {"area", json_of(phase->area)}, {"angle", axis_json(phase->angle)}, {"rate", axis_json(phase->rate)}};
    }
    for (std::size_t i = 0; i < layout.strips.size(); ++i)
        json["strips"].push_back(strip_json(state, i, json_of, backdrop));
    json["backdrop"] = json_of.all(backdrop);
    for (const auto& [key, label] : {std::pair("clock", &layout.clock), {"speed", &layout.speed}})
        if (*label) json[key] = json_of(**label);
    return json;
}

/// The number of a bob, or a place.
Json end_json(const End<double>& end) {
    if (const auto* bob = std::get_if<std::size_t>(&end)) return *bob;
    const auto& place = std::get<Place<double>>(end);
    return {place[0], place[1]};
}

/// A pendulum's masses, lines and chain.
Json body_json(const ShownPendulum& pendulum) {
    constexpr std::array<const char*, 5> kinds{"rod", "spring", "anchor", "slot_line", "slot_circle"};
    const auto& [motion, side, mass, color] = pendulum;
    Json lines = Json::array();
    for (const auto& line : side.lines)
        lines.push_back(
            {kinds[static_cast<std::size_t>(line.kind)], end_json(line.from), end_json(line.to), line.width});
    return {{"mass", mass},
            {"color", hexadecimal(color)},
            {"lines", lines},
            {"least_bob", pendulum.least_bob()},
            {"chain", side.replay ? Json() : chain_json(motion)}};
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

}  // namespace

Json axis_json(const Axis& axis, const std::string& label) {
    return {{"label", label},     {"from", axis.low}, {"to", axis.high}, {"logarithmic", axis.logarithmic},
            {"start", axis.from}, {"end", axis.to}};
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
    const auto shown = shown_pendulums(scene);
    return std::ranges::all_of(shown, [&](const ShownPendulum& pendulum) {
        return !pendulum.side.replay && chain_json(pendulum.motion).contains("method") &&
               pendulum.motion.chain->links() == shown[0].motion.chain->links();
    });
}

bool page_computes(StripKind kind) {
    return kind == StripKind::distance || kind == StripKind::exponent || kind == StripKind::energy;
}

Json page_json(const Scene& scene, const MotionBounds& bounds, long samples) {
    const auto& video = scene.preset.video;
    const auto style = make_style(video, 1, 1);
    const auto clock = clock_text(scene, 0);
    Json bodies = Json::array(), pictures = Json::array();
    for (const auto& pendulum : shown_pendulums(scene, style)) bodies.push_back(body_json(pendulum));
    PairRun pair(scene);
    const Snapshot first{pair.next(never_stopped), {}};
    pictures.push_back(picture_json(scene, bounds, first));
    if (!is_tall(video)) {
        auto upright = scene;
        upright.preset.video.size = {1080, 1920};
        pictures.push_back(picture_json(upright, bounds, first));
    }
    Json json{{"title", scene.preset.title},
              {"caption", scene_caption(scene, wording_of(scene))},
              {"layout", name_of(video.layout)},
              {"show", video.show},
              {"transparent", video.transparent},
              {"follow", video.view.follow},
              {"view", video.view.height_m || video.view.center_m || video.view.follow > 0},
              {"samples", samples},
              {"sample_s", quotient({1, 1}, scene.preset.sample_hz)->value()},
              {"duration_s", scene.time(samples)},
              {"trail_s", video.trail_s},
              {"sample_hz", {scene.preset.sample_hz.numerator, scene.preset.sample_hz.denominator}},
              {"poster_s", video.poster_s ? Json(video.poster_s->value()) : Json(nullptr)},
              {"fps", scene.fps.value()},
              {"decimals", clock == "0 s" ? 0 : clock.size() - 4},
              {"speed", speed_json(scene)},
              {"limits", Json::array()},
              {"true_divergence", true_divergence_words(scene)},
              {"bodies", bodies},
              {"pictures", pictures}};
    for (const auto& [time, text] : limits_of(scene)) json["limits"].push_back({time, text});
    for (const auto& color : color_names)
        json["theme"][std::string(color.key)] = hexadecimal(style.theme.*color.member);
    if (video.layout == Arrangement::phase)
        json["phase"] = {{"kind", name_of(video.phase)}, {"link", video.phase_link - 1}};
    return json;
}

}  // namespace doppel
