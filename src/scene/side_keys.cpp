#include "scene/side_keys.hpp"

#include "base/error.hpp"
#include "integrate/methods.hpp"
#include "scene/captions.hpp"
#include "scene/resolved.hpp"
#include "scene/scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

namespace doppel {
namespace {

/// Sets the text of a value without decimals. Methods and steps have the words of captions; the other choices are
/// named after `caption`, if they have one.
void take_text(const Field& field, const KeyMember& member, SideKey& key) {
    const auto* choice = std::get_if<ChosenName>(&member);
    const auto* step = std::get_if<std::optional<Rational>*>(&member);
    key.text = choice                      ? std::string(choice->name)
               : step                      ? step_text(***step)
               : field.key == "integrator" ? std::string(find_method(**std::get_if<std::string*>(&member))->title)
                                           : toml_value(member);
    key.is_default = choice && choice->name == choice->names.front();
    if (key.is_setting) key.caption = field.caption;
}

constexpr std::string_view remedy = ". Set precision = \"quad\"";  // of double

/// Throws if the droplet's attraction of the first particle is lost in the rounding of gravity, m/s².
void check_droplets(const Scene& scene, const Side& side) {
    if (!side.motion.parts) return;
    const auto parts = side.motion.parts->cast<double>();
    for (const auto& force : parts.forces) {
        const auto* droplet = std::get_if<Droplet<double>>(&force);
        if (!droplet) continue;
        const double attraction =
            droplet->constant * droplet->mass / (parts.particles.front().place - droplet->place).squaredNorm();
        const double rounding = std::nextafter(side.gravity, 2 * side.gravity) - side.gravity;
        if (attraction >= rounding) continue;
        throw bad_input(
            "{}: the droplet attracts with {:.2g} m/s², below the rounding of g in double ({:.2g}): both sides would "
            "move identically{}",
            scene.preset.name, attraction, rounding, remedy);
    }
}

/// Throws if a number differs between the sides and is rounded to the same value in this precision.
void check_numbers(const Scene& scene, const std::vector<KeyPair>& differences, Precision precision) {
    const bool in_quad = precision == Precision::in_quad;
    for (const auto& [a, b] : differences) {
        if (!a || !b || a->numbers.size() != b->numbers.size()) continue;
        // angles become radians, frequencies rad/s
        const bool is_angle = a->unit.starts_with("deg"), is_frequency = a->unit == "Hz";
        const Quad factor = is_angle ? Quad(pi_of<Quad>() / 180) : is_frequency ? Quad(2 * pi_of<Quad>()) : Quad(1);
        const auto computed = [&](const Quad& number) {
            const Quad value = number * factor;
            return in_quad ? value : Quad(static_cast<double>(value));
        };
        for (std::size_t i = 0; i < a->numbers.size(); ++i) {
            const auto &of_a = a->numbers[i], &of_b = b->numbers[i];
            if (of_a == of_b || computed(of_a) != computed(of_b)) continue;
            throw bad_input(
                "{}: {}{} is {} on side a and {} on side b, the same number in {}: both sides would move identically{}",
                scene.preset.name, a->name(), a->numbers.size() > 1 ? fmt::format("[{}]", i) : "", text_of(of_a),
                text_of(of_b), name_of(precision), in_quad ? "" : remedy);
        }
    }
}

/// The system of a side and its initial state, in `Scalar`.
template <class Scalar>
struct System {
    std::optional<Pendulum<Scalar>> chain;
    std::optional<PhysicalPendulum<Scalar>> physical;
    std::optional<Assembly<Scalar>> parts;  // in place of the chain, if its links are particles

    explicit System(const MotionSpec& motion) {
        if (motion.chain) chain = motion.chain->cast<Scalar>();
        if (motion.physical) physical = motion.physical->cast<Scalar>();
        if (motion.model == Model::constraints) parts = parts_of(*chain);
        if (motion.parts) parts = motion.parts->cast<Scalar>();
        if (parts) chain.reset();
    }
    friend bool operator==(const System&, const System&) = default;
};

template <class Scalar>
bool are_same(const Scene& scene) {
    return System<Scalar>(scene.a.motion) == System<Scalar>(scene.b.motion);
}

/// Throws if the sides' keys differ and their systems differ in quad, but not in double. A key may have no effect even
/// in quad, such as a length equal to the initial distance.
void check_systems(const Scene& scene, const std::vector<KeyPair>& differences) {
    if (scene.a.motion.model != scene.b.motion.model || !are_same<double>(scene) || are_same<Quad>(scene)) return;
    std::string names;
    for (const auto& difference : differences)
        if (const auto name = difference.any().name(); names.find(name) == std::string::npos)
            names += (names.empty() ? "" : ", ") + name;
    throw bad_input("{}: {} differ, but not in the numbers of double: both sides would move identically{}",
                    scene.preset.name, names, remedy);
}

}  // namespace

bool are_equal(std::span<const Quad> numbers) {
    return !numbers.empty() && std::ranges::all_of(numbers, [&](const Quad& x) { return x == numbers[0]; });
}

std::optional<std::span<Quad>> numbers_of(const KeyMember& member, bool is_put) {
    using Numbers = std::optional<std::span<Quad>>;
    const auto in = []<class T>(T& value) -> Numbers {
        if constexpr (std::is_same_v<T, Quad>) return std::span(&value, 1);
        if constexpr (std::is_same_v<T, QuadPair> || std::is_same_v<T, std::vector<Quad>>) return std::span(value);
        if constexpr (std::is_same_v<T, EndSpec>)
            if (auto* place = std::get_if<QuadPair>(&value)) return std::span(*place);
        return std::nullopt;
    };
    return std::visit(
        [&]<class M>(const M& of) -> Numbers {
            if constexpr (std::is_same_v<M, ChosenName>) {
                return std::nullopt;
            } else if constexpr (is_optional<std::remove_pointer_t<M>>) {
                typename std::remove_pointer_t<M>::value_type none{};
                if (!*of && !is_put) return in(none) ? Numbers(std::in_place) : std::nullopt;
                return in(*of ? **of : of->emplace());
            } else {
                return in(*of);
            }
        },
        member);
}

std::string caption_of(const Field& field) {
    if (!field.caption.empty()) return std::string(field.caption);
    constexpr auto units = std::to_array<std::string_view>({"N", "deg", "hz", "kg", "m", "m2", "m3", "per", "s", "s2"});
    std::string words(field.key);
    for (auto last = words.rfind('_'); last != std::string::npos; last = words.rfind('_')) {
        if (std::ranges::find(units, std::string_view(words).substr(last + 1)) == units.end()) break;
        words.resize(last);
    }
    std::replace(words.begin(), words.end(), '_', ' ');
    return words;
}

std::vector<SideKey> keys_of(SideSpec side) {
    side.step_s = side.step();
    side.tolerance = side.allowed_error();
    std::vector<SideKey> all;
    std::map<std::string_view, int> counts;  // entries of each kind
    int entry = 0;
    std::size_t existence = 0;  // index of the entry's first row
    std::string place;
    for_each_key(side, [&](const SideEntry& owner, const Field& field, const KeyMember& member) {
        const bool is_pivot = owner.table == "pivot";
        if (is_pivot && side.physical.pivot.amplitude_m == 0) return;
        if (owner.table.empty()) {
            place.clear();
        } else if (is_pivot ? place.empty() : owner.number != entry) {
            entry = owner.number;
            const int number = ++counts[owner.kind];
            place = is_pivot             ? "pivot"
                    : owner.name.empty() ? fmt::format("{} {}", owner.kind, number)
                                         : fmt::format("{} \"{}\"", owner.kind, owner.name);
            existence = all.size();
            all.push_back({.place = is_pivot ? "pivot motion" : place, .key = ""});
        }
        if (!field.only.applies && !field.only.error.empty()) return;
        SideKey key{.place = place,
                    .key = field.key,
                    .unit = field.unit,
                    .symbol = field.symbol,
                    .caption = caption_of(field),
                    .counts = field.only.applies,
                    .is_of_links = !field.each.empty() && place.empty(),
                    .is_setting = place.empty() && field.each.empty() && field.symbol.empty() && field.key != "links"};
        if (const auto numbers = numbers_of(member)) key.numbers.assign(numbers->begin(), numbers->end());
        if (key.numbers.empty()) take_text(field, member, key);
        if (key.numbers.empty() && key.text.empty()) return;
        if (!place.empty() && !key.unit.empty() && !is_zero(key.numbers))
            all[existence].text +=
                fmt::format(" {} {} {}", all[existence].text.empty() ? "of" : "and", key.caption, value_words(key));
        all.push_back(std::move(key));
    });
    return all;
}

bool KeyPair::differs() const {
    if (!a || !b) return true;
    return a->numbers != b->numbers || a->counts != b->counts || (a->text != b->text && !a->key.empty());
}

std::vector<KeyPair> paired(std::vector<SideKey> a, std::vector<SideKey> b) {
    std::vector<KeyPair> all;
    std::map<std::string, std::size_t> indices;  // of names
    for (auto* keys : {&a, &b})
        for (auto& key : *keys) {
            const auto [index, is_new] = indices.emplace(key.name(), all.size());
            if (is_new) all.emplace_back();
            (keys == &a ? all[index->second].a : all[index->second].b) = std::move(key);
        }
    std::vector<KeyPair> kept;
    std::ranges::copy_if(all, std::back_inserter(kept), [&](const KeyPair& pair) {
        const auto& key = pair.any();
        if ((pair.a && pair.b) || key.place.empty() || key.key.empty()) return true;
        const auto entry = indices.find(key.place);
        return entry != indices.end() && all[entry->second].a && all[entry->second].b;
    });
    return kept;
}

std::vector<KeyPair> differing_keys(const SideSpec& a, const SideSpec& b) {
    auto all = paired(keys_of(a), keys_of(b));
    std::erase_if(all, [](const KeyPair& pair) { return !pair.differs(); });
    return all;
}

bool are_one(const Scene& scene) {
    auto b = scene.preset.b;
    b.model = scene.preset.a.model;  // compares the resulting scenes
    return scene.a.motion.model == scene.b.motion.model && differing_keys(scene.preset.a, b).empty();
}

std::optional<std::string> no_difference(const Scene& scene) {
    if (scene.is_single() || scene.a.replay || scene.b.replay || !are_one(scene)) return std::nullopt;
    return "both sides are the same; give [b] a difference, or take layout = \"single\"";
}

void check_difference(const Scene& scene) {
    for (const auto* side : {&scene.a, &scene.b})
        if (side->motion.precision == Precision::in_double) check_droplets(scene, *side);
    const auto &a = scene.preset.a, &b = scene.preset.b;
    if (differ_in_kind(a, b) || !a.track.is_none() || !b.track.is_none()) return;
    const auto differences = differing_keys(a, b);
    if (differences.empty()) return;
    const auto precision = std::min(scene.a.motion.precision, scene.b.motion.precision);
    check_numbers(scene, differences, precision);
    if (precision == Precision::in_double) check_systems(scene, differences);
}

}  // namespace doppel
