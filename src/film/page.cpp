#include "film/page.hpp"

#include "base/embedded.hpp"
#include "base/text.hpp"
#include "embedded/film.hpp"
#include "film/page_json.hpp"
#include "film/strips.hpp"
#include "numeric/state.hpp"
#include "scene/side_keys.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace doppel {
namespace {

/// Words of `word_bytes` bytes, compressed by zlib, as base64: first the lowest byte of all words, then the next one …
std::string packed(const std::vector<std::uint32_t>& words, std::size_t word_bytes) {
    std::string bytes(words.size() * word_bytes, '\0');
    for (std::size_t i = 0; i < words.size(); ++i)
        for (std::size_t k = 0; k < word_bytes; ++k)
            bytes[k * words.size() + i] = static_cast<char>((words[i] >> (8 * k)) & 0xff);
    return deflated(bytes);
}

/// Floats, each stored as the difference of its bits from the previous one.
std::string packed_floats(const std::vector<std::vector<float>>& channels) {
    std::vector<std::uint32_t> words;
    for (const auto& numbers : channels) {
        std::uint32_t last = 0;
        for (const float number : numbers) {
            const auto bits = std::bit_cast<std::uint32_t>(number);
            words.push_back(bits - last);
            last = bits;
        }
    }
    return packed(words, sizeof(float));
}

/// The side of a pendulum, or for members the side with the same layout.
const Side& side_of(const Scene& scene, std::size_t pendulum) {
    return pendulum == 1 && scene.members.empty() ? scene.b : scene.a;
}

/// Whether the positions of its bobs follow from the angles and lengths of its links.
bool is_by_angles(const Side& side) {
    return side.has_angles && side.motion.model == Model::angles && !side.replay;
}

/// The step of the stored angles, rad.
double turn_step(const Side& side, int bits) {
    return std::ldexp(2 * pi, -bits) * std::sqrt(static_cast<double>(side.mass.size()));
}

/// The page without its data.
HtmlPage player(const Scene& scene) {
    const auto file = [](std::string_view name) { return embedded_file(film_files(), name); };
    std::string body(file("film/page/player.html"));
    for (const auto& [name, text] : {std::pair<std::string_view, std::string>{"{title}", scene.preset.title},
                                     {"{caption}", scene_caption(scene, wording_of(scene))}})
        body.replace(body.find(name), name.size(), markup(text));
    return {.kind = "film",
            .title = scene.preset.title,
            .body = std::move(body),
            .styles = {file("film/page/player.css")},
            .scripts = {file("film/page/chain.js"), file("film/page/motion.js"), file("film/page/player.js"),
                        file("film/page/controls.js")},
            .is_packed = true};
}

}  // namespace

FilmPage::FilmPage(const Scene& scene, const MotionBounds& bounds, Transaction& parts)
    : scene_(scene),
      bounds_(bounds),
      place_(parts.file(scene.preset.name + ".html")),
      computes_(page_computes(scene)),
      parts_(parts) {}

void FilmPage::add(const Snapshot& snapshot) {
    if (snapshot.pair.share > 0) return;
    if (snapshot.pair.sample == 0) start_distance_ = snapshot.pair.distance;
    ++samples_;
    if (!computes_) add_positions(snapshot);
    add_curves(snapshot.pair);
}

void FilmPage::add_positions(const Snapshot& snapshot) {
    const auto &a = snapshot.pair.a, &b = snapshot.pair.b;
    std::vector<const Bobs<double>*> pendulums;
    for (const auto& member : snapshot.members) pendulums.push_back(&member);
    if (pendulums.empty()) pendulums.push_back(&a.bobs);
    if (snapshot.members.empty() && !scene_.is_single()) pendulums.push_back(&b.bobs);
    positions_.resize(pendulums.size());
    for (std::size_t k = 0; k < pendulums.size(); ++k) {
        const auto& side = side_of(scene_, k);
        const auto& pivot = (&side == &scene_.a ? a : b).pivot;
        auto& channels = positions_[k];
        channels.resize((is_by_angles(side) ? 1 : 2) * pendulums[k]->size() + (side.pivot_reach > 0 ? 2 : 0));
        auto channel = channels.begin();
        const auto take = [&](double number) { (channel++)->push_back(static_cast<float>(number)); };
        for (const auto& bob : *pendulums[k]) {
            if (is_by_angles(side)) take(std::remainder(bob.theta, 2 * pi));
            if (!is_by_angles(side)) take(bob.x), take(bob.y);
        }
        if (side.pivot_reach > 0) take(pivot.x), take(pivot.y);
    }
}

void FilmPage::add_curves(const PairState& state) {
    std::size_t channel = 0;
    const auto take = [&](double number) {
        if (channel == curves_.size()) curves_.emplace_back();
        curves_[channel++].push_back(static_cast<float>(number));
    };
    for (const auto kind : scene_.preset.video.strips)
        if (!computes_ || !page_computes(kind))
            for (const auto& curve : strip_curves(kind, scene_, state, start_distance_, themes[0], 1))
                take(curve.value.value_or(NAN));
    if (scene_.preset.video.layout != Arrangement::phase || computes_) return;
    for (const auto* seen : {&state.a, &state.b}) {
        const auto& bob = seen->bobs[static_cast<std::size_t>(scene_.preset.video.phase_link - 1)];
        for (const double number : {bob.theta, bob.omega, seen->bobs[0].theta}) take(number);
    }
}

/// Angles in steps of 2^−bits of a turn, times √N for a chain of N links, whose errors add up randomly. Other positions
/// in steps of 2^−bits of their range. Stores second differences in time, less those of the previous pendulum.
Json FilmPage::motion_json() const {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    const auto is_angle = [&](std::size_t k, std::size_t channel) {
        const auto& side = side_of(scene_, k);
        return is_by_angles(side) && channel < side.mass.size();
    };
    for (std::size_t k = 0; k < positions_.size(); ++k)
        for (std::size_t c = 0; c < positions_[k].size(); ++c)
            for (const float number : positions_[k][c])
                if (!is_angle(k, c)) low = std::min<double>(low, number), high = std::max<double>(high, number);
    if (!(high > low)) low = 0, high = 1;
    const int bits = scene_.preset.video.position_bits;
    const std::uint32_t most = (std::uint32_t{1} << bits) - 1;
    std::vector<std::uint32_t> words;
    std::vector<std::pair<std::size_t, std::size_t>> begins;  // start and word count of pendulums like the previous one
    Json pendulums = Json::array();
    for (std::size_t k = 0; k < positions_.size(); ++k) {
        const auto& side = side_of(scene_, k);
        const auto count = positions_[k].size() * static_cast<std::size_t>(samples_), begin = words.size();
        const bool is_like_last = k > 0 && positions_[k - 1].size() == positions_[k].size();
        for (std::size_t c = 0; c < positions_[k].size(); ++c) {
            std::uint32_t last = 0, change = 0;
            for (const float number : positions_[k][c]) {
                const double steps =
                    is_angle(k, c) ? number / turn_step(side, bits) : most * ((number - low) / (high - low));
                const auto step = static_cast<std::uint32_t>(std::lround(steps)), moved = step - last;
                words.push_back((moved - change) & most);
                last = step, change = moved;
            }
        }
        Json json{{"angles", is_by_angles(side)}, {"pivot", side.pivot_reach > 0}, {"like_last", is_like_last}};
        if (is_by_angles(side)) {
            json["length"] = side.motion.chain->cast<double>().length;
            json["step"] = turn_step(side, bits);
        }
        pendulums.push_back(std::move(json));
        // backwards below, so that the previous pendulum's words are still unchanged
        if (is_like_last) begins.emplace_back(begin, count);
    }
    for (auto at = begins.rbegin(); at != begins.rend(); ++at)
        for (std::size_t i = at->first; i < at->first + at->second; ++i)
            words[i] = (words[i] - words[i - at->second]) & most;
    return {{"bits", bits},
            {"low", low},
            {"high", high},
            {"pendulums", pendulums},
            {"words", packed(words, bits > 16 ? 3 : 2)}};
}

void FilmPage::finish() {
    const auto& preset = scene_.preset;
    auto data = page_json(scene_, bounds_);
    data["samples"] = samples_ - 1;
    data["duration_s"] = scene_.time(samples_ - 1);
    if (!positions_.empty()) data["motion"] = motion_json();
    if (!curves_.empty()) data["curves"] = packed_floats(curves_);
    auto page = player(scene_);
    page.data = std::move(data);
    write_file(place_, page_text(page));
    parts_.finished(preset.name + ".html");
}

std::optional<HtmlPage> film_player(Scene scene) {
    if (std::ranges::any_of(shown_motions(scene), [](const auto* motion) { return chain_json(*motion).is_null(); }))
        return std::nullopt;
    auto& video = scene.preset.video;
    video = {};
    if (differing_keys(scene.preset.a, scene.preset.b).empty()) {
        video.layout = Arrangement::single;
        video.strips.clear();
    }
    auto page = player(scene);
    page.data = page_json(scene, Recording(scene, {1}, true, never_stopped).bounds());
    return page;
}

double estimated_page_bytes(const Scene& scene) {
    constexpr double script = 33e3, place = 1.3, number = 4;  // bytes, measured: 0.8 to 2 per position
    double places = 0, numbers = scene.preset.video.layout == Arrangement::phase ? 6 : 0;
    for (std::size_t k = 0; k < shown_motions(scene).size(); ++k)
        places += static_cast<double>(side_of(scene, k).mass.size()) * (is_by_angles(side_of(scene, k)) ? 1 : 2);
    const bool computes = page_computes(scene);
    if (computes) places = numbers = 0;
    places *= scene.preset.video.position_bits / 16.0;
    for (const auto kind : scene.preset.video.strips)
        if (!computes || !page_computes(kind))
            numbers += kind == StripKind::distance || kind == StripKind::exponent ? 1 : 2;
    return script + static_cast<double>(scene.samples) * (place * places + number * numbers);
}

}  // namespace doppel
