#include "film/page.hpp"

#include "base/embedded.hpp"
#include "embedded/film.hpp"
#include "film/layer.hpp"
#include "film/strips.hpp"
#include "numeric/state.hpp"
#include "scene/side_keys.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>

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
    Json all(const DisplayList& items) const {
        Json json = Json::array();
        for (const auto& item : items) json.push_back(std::visit(*this, item));
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

/// A strip: its axes, the position of its value if it has one, the texts of its marks before and after the divergence,
/// and colours and widths of curves. Adds its other words to `backdrop`.
Json strip_json(const FilmState& state, const Outcome& outcome, const StripLayout& strip, const PictureJson& json_of,
                DisplayList& backdrop) {
    const double start_distance = state.snapshot.pair.distance;
    const auto curves = strip_curves(strip.kind, state.scene, state.snapshot.pair, start_distance, state.layout.style);
    auto words = placed_caption(strip, state.scene, state.layout, curves, start_distance == 0);
    Json json{{"kind", name_of(strip.kind)},
              {"left", json_of(strip.cell.left)},
              {"area", json_of(strip.area)},
              {"time", axis_json(strip.time)},
              {"axis", axis_json(strip.value)}};
    const bool has_value =
        strip.kind == StripKind::distance || (strip.kind == StripKind::exponent && start_distance > 0);
    if (has_value && !words.empty() && words.back().color == curves[0].color) {
        json["value"] = json_of(words.back());
        words.pop_back();
    }
    backdrop.insert(backdrop.end(), words.begin(), words.end());
    for (const auto& of : {state.outcome, outcome})
        json["marks"].push_back(json_of.all(placed_marks(state, of, strip)));
    for (const auto& curve : curves) json["pens"].push_back(json_of.list(curve.color, curve.width));
    return json;
}

/// A picture of the film's layout: pixels of `scene`'s size. `first`: the snapshot at the start. "marks": what
/// marks limits, below the backdrop.
Json picture_json(const Scene& scene, const MotionBounds& bounds, const Snapshot& first, const Outcome& outcome) {
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
    DisplayList marks, backdrop;
    for (const auto& layer : layers_of(state)) {
        layer->marks(marks);
        layer->backdrop(backdrop);
    }
    json["marks"] = json_of.all(marks);
    for (const auto& panel : layout.panels)
        json["panels"].push_back({{"area", json_of(panel.area)},
                                  {"shown", panel.shown},
                                  {"center", json_of(panel.center)},
                                  {"origin", {panel.center_x, panel.center_y}},
                                  {"scale", panel.px_per_m}});
    if (const auto& phase = layout.phase)
        json["phase"] = {
            {"area", json_of(phase->area)}, {"angle", axis_json(phase->angle)}, {"rate", axis_json(phase->rate)}};
    for (const auto& strip : layout.strips)
        json["strips"].push_back(strip_json(state, outcome, strip, json_of, backdrop));
    for (const auto& [key, label] : {std::pair("clock", &layout.clock), {"speed", &layout.speed}})
        if (*label) json[key] = json_of(**label);
    json["backdrop"] = json_of.all(backdrop);
    return json;
}

/// The lengths of its links, m, if the positions of its bobs follow from them and angles, which the file then contains.
std::vector<double> lengths_of(const ShownPendulum& pendulum) {
    const auto& side = pendulum.side;
    const bool is_by_angles = side.has_angles && side.motion.model == Model::angles && !side.replay;
    return is_by_angles ? side.motion.chain->cast<double>().length : std::vector<double>();
}

/// The range of its angles in the file, rad: whole turns, so that a bob moves by a step of the range about as much as
/// the last one of a single link of the chain's length.
double angle_range(const std::vector<double>& lengths) {
    const double longest = lengths.empty() ? 1 : std::ranges::max(lengths);
    return 2 * pi * std::ceil(std::accumulate(lengths.begin(), lengths.end(), 0.0) / longest);
}

/// A pendulum's masses, lines and chain, and what the file contains of its motion.
Json body_json(const ShownPendulum& pendulum) {
    using Kind = MechanismLine::Kind;
    const auto lengths = lengths_of(pendulum);
    Json lines = Json::array();
    const auto end_json = [](const auto& bob_or_place) { return Json(bob_or_place); };
    for (const auto& line : pendulum.side.lines)
        if (line.kind == Kind::rod || line.kind == Kind::spring)
            lines.push_back({line.kind == Kind::rod ? "rod" : "spring", std::visit(end_json, line.from),
                             std::visit(end_json, line.to), line.width});
    return {{"mass", pendulum.mass},
            {"length", lengths.empty() ? Json() : Json(lengths)},
            {"moves", pendulum.side.pivot_reach > 0},
            {"color", hexadecimal(pendulum.color)},
            {"rod", hexadecimal(pendulum.rod)},
            {"bob", hexadecimal(pendulum.bob)},
            {"trail", hexadecimal(pendulum.trail)},
            {"ghost", hexadecimal(pendulum.ghost)},
            {"lines", lines},
            {"pivots", pivots_of(pendulum.side)},
            {"least_bob", pendulum.least_bob()},
            {"chain", pendulum.side.replay ? Json() : chain_json(pendulum.motion)}};
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

/// Channels of `count` words of `word_bytes` bytes: second differences in time, plus 128, so that those about zero differ
/// in their lowest byte alone; first the lowest byte of all, then the next one …; compressed by zlib, as base64.
std::string packed(std::vector<std::uint32_t> words, std::size_t count, std::size_t word_bytes) {
    for (int order = 0; order < 2; ++order)
        for (std::size_t i = words.size(); i-- > 0;)
            if (i % count > 0) words[i] -= words[i - 1];
    std::string bytes(words.size() * word_bytes, '\0');
    for (std::size_t i = 0; i < words.size(); ++i)
        for (std::size_t k = 0; k < word_bytes; ++k)
            bytes[k * words.size() + i] = static_cast<char>(((words[i] + 128) >> (8 * k)) & 0xff);
    return deflated(bytes);
}

/// What the file contains of one sample.
struct Numbers {
    std::vector<double> places;  // of all pendulums: angles or coordinates of bobs, then of the pivot if it moves
    std::vector<double> ranges;  // of each of them, if it is an angle, rad; otherwise 0
    std::vector<double> curves;  // of all strips, then of a phase panel
};

/// `computes` = whether the script computes the motion: then places are left out.
Numbers page_numbers(const Scene& scene, const Snapshot& snapshot, double start_distance, bool computes) {
    const auto& pair = snapshot.pair;
    const auto& video = scene.preset.video;
    Numbers numbers;
    auto& [places, ranges, curves] = numbers;
    const auto pendulums = computes ? std::vector<ShownPendulum>() : shown_pendulums(scene);
    for (std::size_t k = 0; k < pendulums.size(); ++k) {
        const auto& side = pendulums[k].side;
        const auto& seen = &side == &scene.a ? pair.a : pair.b;
        const auto& bobs = snapshot.members.empty() ? seen.bobs : snapshot.members[k];
        const auto lengths = lengths_of(pendulums[k]);
        const double range = angle_range(lengths), step = std::ldexp(range, -video.position_bits);
        double x = seen.pivot.x, y = seen.pivot.y;  // where the page has the joint; the next link makes up for rounding
        for (std::size_t i = 0; i < lengths.size(); ++i) {
            const double correction = std::atan2(bobs[i].x - x, y - bobs[i].y) - bobs[i].theta;
            const double angle = step * std::round((bobs[i].theta + std::remainder(correction, 2 * pi)) / step);
            x += lengths[i] * std::sin(angle);
            y -= lengths[i] * std::cos(angle);
            places.push_back(std::remainder(angle, range));
        }
        ranges.resize(places.size(), range);
        if (lengths.empty())
            for (const auto& bob : bobs) places.insert(places.end(), {bob.x, bob.y});
        if (side.pivot_reach > 0) places.insert(places.end(), {seen.pivot.x, seen.pivot.y});
        ranges.resize(places.size(), 0);
    }
    for (const auto kind : video.strips)
        if (!computes || kind == StripKind::rod_error || kind == StripKind::rod_force)
            for (const auto& curve : strip_curves(kind, scene, pair, start_distance))
                curves.push_back(curve.value.value_or(NAN));
    for (const auto* seen : {&pair.a, &pair.b}) {
        if (video.layout != Arrangement::phase || computes) break;
        const auto& bob = seen->bobs[static_cast<std::size_t>(video.phase_link - 1)];
        curves.insert(curves.end(), {bob.theta, bob.omega, seen->bobs[0].theta});
    }
    return numbers;
}

/// The page's data except its motion of samples 0 … `samples`, for src/film/page/player.js. `first`: the first of them.
Json page_json(const Scene& scene, const MotionBounds& bounds, const Snapshot& first, const Outcome& outcome,
               long samples) {
    const auto& video = scene.preset.video;
    const auto style = make_style(video, 1, 1);
    const auto clock = clock_text(scene, 0);
    auto preset = scene.preset;  // the whole film's own, as a video
    if (!video.transparent) preset.video.format = {};
    Json bodies = Json::array(), pictures = Json::array();
    for (const auto& pendulum : shown_pendulums(scene, style, !has_panel_for_each(video)))
        bodies.push_back(body_json(pendulum));
    pictures.push_back(picture_json(scene, bounds, first, outcome));
    for (const Size size : {Size{1080, 1920}, {400, 200}}) {  // for upright and for small windows
        auto other = scene;
        other.preset.video.size = size;
        if (!is_tall(video)) pictures.push_back(picture_json(other, bounds, first, outcome));
    }
    Json json{{"title", preset.title},
              {"preset", resolved_toml(preset)},
              {"caption", scene_caption(scene, wording_of(scene))},
              {"layout", name_of(video.layout)},
              {"show", video.show},
              {"transparent", video.transparent},
              {"follow", video.view.follow},
              {"view", video.view.height_m || video.view.center_m || video.view.follow > 0},
              {"samples", samples},
              {"sample_s", quotient({1, 1}, preset.sample_hz)->value()},
              {"duration_s", scene.time(samples)},
              {"trail_s", video.trail_s},
              {"sample_hz", {preset.sample_hz.numerator, preset.sample_hz.denominator}},
              {"poster_s", video.poster_s ? Json(video.poster_s->value()) : Json(nullptr)},
              {"fps", scene.fps.value()},
              {"decimals", clock == "0 s" ? 0 : clock.size() - 4},
              {"speed", speed_json(scene)},
              {"bodies", bodies},
              {"pictures", pictures}};
    for (const auto& color : color_names)
        json["theme"][std::string(color.key)] = hexadecimal(style.theme.*color.member);
    if (video.layout == Arrangement::phase)
        json["phase"] = {{"kind", name_of(video.phase)}, {"link", video.phase_link - 1}};
    return json;
}

HtmlPage player(const Scene& scene, Json film) {
    const auto file = [](std::string_view name) { return embedded_file(film_files(), name); };
    return {.kind = "film",
            .title = scene.preset.title,
            .body = std::string(file("film/page/player.html")),
            .styles = {file("film/page/player.css")},
            .scripts = {file("film/page/chain.js"), file("film/page/motion.js"), file("film/page/player.js"),
                        file("film/page/controls.js")},
            .data = {{"film", std::move(film)}}};
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

FilmPage::FilmPage(const Scene& scene, const MotionBounds& bounds, Transaction& parts)
    : scene_(scene),
      bounds_(bounds),
      place_(parts.file(scene.preset.name + ".html")),
      computes_(page_computes(scene)),
      parts_(parts) {}

void FilmPage::add(const Snapshot& snapshot) {
    if (snapshot.pair.share > 0) return;
    if (snapshot.pair.sample == 0) first_ = snapshot;
    const auto now = page_numbers(scene_, snapshot, first_.pair.distance, computes_);
    for (auto [channels, numbers] : {std::pair(&places_, &now.places), {&curves_, &now.curves}}) {
        channels->resize(numbers->size());
        for (std::size_t i = 0; i < numbers->size(); ++i) (*channels)[i].push_back(static_cast<float>((*numbers)[i]));
    }
    ++samples_;
}

/// Each channel from `low` on in steps of 2^−bits of its range; the range of an angle is about zero.
Json FilmPage::motion_json() const {
    const int bits = scene_.preset.video.position_bits;
    const auto ranges = page_numbers(scene_, first_, first_.pair.distance, computes_).ranges;
    Json channels = Json::array();
    std::vector<std::uint32_t> words;
    for (std::size_t c = 0; c < places_.size(); ++c) {
        const auto [least, most] = std::ranges::minmax(places_[c]);
        const double found = most > least ? static_cast<double>(most) - least : 1;
        const double step = ranges[c] > 0 ? std::ldexp(ranges[c], -bits) : found / (std::ldexp(1, bits) - 1);
        const double low = ranges[c] > 0 ? -0.5 * ranges[c] : least;
        channels.push_back({low, step});
        for (const float number : places_[c])
            words.push_back(static_cast<std::uint32_t>(std::lround((number - low) / step)));
    }
    return {{"bits", bits},
            {"channels", channels},
            {"words", packed(std::move(words), places_[0].size(), bits > 16 ? 3 : 2)}};
}

void FilmPage::finish(const Outcome& outcome) {
    auto film = page_json(scene_, bounds_, first_, outcome, samples_ - 1);
    if (!places_.empty()) film["motion"] = motion_json();
    std::vector<std::uint32_t> bits;
    for (const auto& curve : curves_)
        for (const float number : curve) bits.push_back(std::bit_cast<std::uint32_t>(number));
    if (!bits.empty()) film["curves"] = packed(std::move(bits), curves_[0].size(), sizeof(float));
    write_file(place_, page_text(player(scene_, std::move(film))));
    parts_.finished(scene_.preset.name + ".html");
}

std::optional<HtmlPage> film_player(Scene scene) {
    for (const auto& pendulum : shown_pendulums(scene))
        if (chain_json(pendulum.motion).is_null()) return std::nullopt;
    auto& video = scene.preset.video;
    video = {};
    if (differing_keys(scene.preset.a, scene.preset.b).empty()) {
        video.layout = Arrangement::single;
        video.strips.clear();
    }
    PairRun pair(scene);
    return player(scene, page_json(scene, Recording(scene, {1}, true, never_stopped).bounds(),
                                   {pair.next(never_stopped), {}}, {}, scene.samples));
}

}  // namespace doppel
