#include "film/page.hpp"

#include "base/embedded.hpp"
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

/// Channels of `count` words of `word_bytes` bytes: differences in time, `order` times; first the lowest byte of all,
/// then the next one …; compressed by zlib, as base64.
std::string packed(std::vector<std::uint32_t> words, std::size_t count, int order, std::size_t word_bytes) {
    for (; order > 0; --order)
        for (std::size_t i = words.size(); i-- > 0;)
            if (i % count > 0) words[i] -= words[i - 1];
    std::string bytes(words.size() * word_bytes, '\0');
    for (std::size_t i = 0; i < words.size(); ++i)
        for (std::size_t k = 0; k < word_bytes; ++k)
            bytes[k * words.size() + i] = static_cast<char>((words[i] >> (8 * k)) & 0xff);
    return deflated(bytes);
}

/// Whether the positions of its bobs follow from the angles and lengths of its links.
bool is_by_angles(const Side& side) {
    return side.has_angles && side.motion.model == Model::angles && !side.replay;
}

/// What the file contains of one sample.
struct Numbers {
    std::vector<double> places;  // of all pendulums: angles or coordinates of bobs, then of the pivot if it moves
    std::vector<double> curves;  // of all strips, then of a phase panel
};

/// `computes` = whether the script computes the motion: then places are left out.
Numbers page_numbers(const Scene& scene, const Snapshot& snapshot, double start_distance, bool computes) {
    const auto& pair = snapshot.pair;
    const auto& video = scene.preset.video;
    Numbers numbers;
    auto& [places, curves] = numbers;
    const auto pendulums = computes ? std::vector<ShownPendulum>() : shown_pendulums(scene);
    for (std::size_t k = 0; k < pendulums.size(); ++k) {
        const auto& side = pendulums[k].side;
        const auto& seen = &side == &scene.a ? pair.a : pair.b;
        for (const auto& bob : snapshot.members.empty() ? seen.bobs : snapshot.members[k])
            if (is_by_angles(side))
                places.push_back(std::remainder(bob.theta, 2 * pi));
            else
                places.insert(places.end(), {bob.x, bob.y});
        if (side.pivot_reach > 0) places.insert(places.end(), {seen.pivot.x, seen.pivot.y});
    }
    for (const auto kind : video.strips)
        if (!computes || !page_computes(kind))
            for (const auto& curve : strip_curves(kind, scene, pair, start_distance))
                curves.push_back(curve.value.value_or(NAN));
    for (const auto* seen : {&pair.a, &pair.b}) {
        if (video.layout != Arrangement::phase || computes) break;
        const auto& bob = seen->bobs[static_cast<std::size_t>(video.phase_link - 1)];
        curves.insert(curves.end(), {bob.theta, bob.omega, seen->bobs[0].theta});
    }
    return numbers;
}

/// The player with the data of a film.
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

FilmPage::FilmPage(const Scene& scene, const MotionBounds& bounds, Transaction& parts)
    : scene_(scene),
      bounds_(bounds),
      place_(parts.file(scene.preset.name + ".html")),
      computes_(page_computes(scene)),
      parts_(parts) {}

void FilmPage::add(const Snapshot& snapshot) {
    if (snapshot.pair.share > 0) return;
    if (snapshot.pair.sample == 0) start_distance_ = snapshot.pair.distance;
    const auto now = page_numbers(scene_, snapshot, start_distance_, computes_);
    for (auto [channels, numbers] : {std::pair(&places_, &now.places), {&curves_, &now.curves}}) {
        channels->resize(numbers->size());
        for (std::size_t i = 0; i < numbers->size(); ++i) (*channels)[i].push_back(static_cast<float>((*numbers)[i]));
    }
    ++samples_;
}

/// Angles in steps of 2^−bits of a turn, times √N for a chain of N links, whose errors add up randomly; `low` is −half
/// the range. Coordinates in steps of 2^−bits of their range. Stores second differences in time.
Json FilmPage::motion_json() const {
    const int bits = scene_.preset.video.position_bits;
    std::vector<double> turns;  // the step of a channel of angles, rad; 0: of coordinates
    Json pendulums = Json::array();
    for (const auto& [motion, side, mass, color] : shown_pendulums(scene_)) {
        const auto links = mass.size();
        const double turn = is_by_angles(side) ? std::ldexp(2 * pi, -bits) * std::sqrt(static_cast<double>(links)) : 0;
        turns.resize(turns.size() + (turn > 0 ? links : 2 * links), turn);
        if (side.pivot_reach > 0) turns.resize(turns.size() + 2, 0);
        pendulums.push_back({{"turn", turn}, {"moves", side.pivot_reach > 0}});
        if (turn > 0) pendulums.back()["length"] = motion.chain->cast<double>().length;
    }
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t c = 0; c < turns.size(); ++c)
        for (const float number : places_[c])
            if (turns[c] == 0) low = std::min<double>(low, number), high = std::max<double>(high, number);
    if (!(high > low)) low = 0, high = 1;
    const double step = (high - low) / (std::ldexp(1, bits) - 1);
    std::vector<std::uint32_t> words;
    for (std::size_t c = 0; c < turns.size(); ++c)
        for (const float number : places_[c])
            words.push_back(static_cast<std::uint32_t>(
                std::lround(turns[c] > 0 ? number / turns[c] + std::ldexp(1, bits - 1) : (number - low) / step)));
    return {{"bits", bits},
            {"low", low},
            {"step", step},
            {"pendulums", pendulums},
            {"words", packed(std::move(words), places_[0].size(), 2, bits > 16 ? 3 : 2)}};
}

void FilmPage::finish() {
    auto film = page_json(scene_, bounds_, samples_ - 1);
    if (!places_.empty()) film["motion"] = motion_json();
    std::vector<std::uint32_t> bits;
    for (const auto& curve : curves_)
        for (const float number : curve) bits.push_back(std::bit_cast<std::uint32_t>(number));
    if (!bits.empty()) film["curves"] = packed(std::move(bits), curves_[0].size(), 1, sizeof(float));
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
    return player(scene, page_json(scene, Recording(scene, {1}, true, never_stopped).bounds(), scene.samples));
}

double estimated_page_bytes(const Scene& scene) {
    constexpr double script = 34e3, place = 1.3 / 16, number = 4;  // bytes; per bit of a place, measured: 0.05 to 0.13
    const auto one = page_numbers(scene, blank_snapshot(scene), 0, page_computes(scene));
    const double per_sample = place * scene.preset.video.position_bits * static_cast<double>(one.places.size()) +
                              number * static_cast<double>(one.curves.size());
    return script + static_cast<double>(scene.samples) * per_sample;
}

}  // namespace doppel
