#include "scene/captions.hpp"

#include "plot/axis.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <optional>

namespace doppel {
namespace {

constexpr std::size_t max_listed = 3;  // longer lists are not shown number by number

using Texts = std::vector<std::string>;

std::string joined(const Texts& parts) {
    return fmt::format("{}", fmt::join(parts, ", "));
}

/// "90°", "0.5°/s", "1.01 kg"
std::string with_unit(std::string_view number, std::string_view unit) {
    if (unit.starts_with("deg")) return fmt::format("{}°{}", number, unit.substr(3));
    return fmt::format("{}{}{}", number, unit.empty() ? "" : " ", unit);
}

/// The keys of a side with the model and method by which it is computed.
std::vector<SideKey> shown_keys(SideSpec spec, const Side& side) {
    spec.model = value_named<ModelChoice>(name_of(side.motion.model));
    auto keys = keys_of(spec);
    const auto accuracy = std::ranges::find(keys, "accuracy", &SideKey::key);
    if (accuracy != keys.end())
        keys.insert(accuracy, {.key = "integrator", .text = std::string(side.method.title), .is_setting = true});
    return keys;
}

/// The start first, then the system, then the computation.
std::vector<KeyPair> shown_pairs(const Scene& scene) {
    const auto keys = shown_keys(scene.preset.a, scene.a);
    auto pairs = paired(keys, scene.is_single() ? keys : shown_keys(scene.preset.b, scene.b));
    std::ranges::stable_sort(pairs, {}, [](const KeyPair& pair) {
        const auto& key = pair.any();
        return key.is_setting ? 2 : key.key == "angle_deg" || key.key == "omega_deg_per_s" ? 0 : 1;
    });
    return pairs;
}

/// A number with a true minus, and six digits, or one more than distinguish it from the other side's.
std::string short_text(const Quad& number, const Quad& other) {
    auto text = number_text(number);
    for (int digits = 5; digits < 15; ++digits) {
        const auto rounded = fmt::format("{:.{}g}", static_cast<double>(number), digits);
        if (number != other && rounded == fmt::format("{:.{}g}", static_cast<double>(other), digits)) continue;
        const auto brief = number_text(parse_quad(fmt::format("{:.{}g}", static_cast<double>(number), digits + 1)));
        if (brief.size() < text.size()) text = brief;
        break;
    }
    return text.starts_with('-') ? "−" + text.substr(1) : text;
}

/// What is said of a key with a symbol. Short chains: link by link. Long chains: the common number of the links, or the
/// links in which the sides differ.
Texts symbol_texts(const SideKey& key, const SideKey& other) {
    const auto &numbers = key.numbers, &others = other.numbers;
    const auto text = [&](const std::string& name, std::size_t i) {
        return fmt::format("{} = {}", name, with_unit(short_text(numbers[i], others[i]), key.unit));
    };
    const auto of_link = [&](std::size_t i) { return text(fmt::format("{}{}", key.symbol, subscript(i + 1)), i); };
    if (!key.is_of_links) return {text(std::string(key.symbol), 0)};
    const bool is_long = numbers.size() > max_listed;
    if (is_long && are_equal(numbers) && are_equal(others)) return {text(fmt::format("all {}", key.symbol), 0)};
    if (is_long && numbers == others) return {fmt::format("{}, {} …", of_link(0), of_link(1))};
    Texts all;
    for (std::size_t i = 0; i < numbers.size(); ++i)
        if (!is_long || numbers[i] != others[i]) all.push_back(of_link(i));
    return all;
}

/// What is said of a key of side b, or side a. The texts at the same index for both sides are about the same number.
Texts texts_of(const KeyPair& pair, bool of_b) {
    const auto &self = of_b ? pair.b : pair.a, &other = of_b ? pair.a : pair.b;
    const auto& known = pair.any();
    if (known.key.empty() && self && other) return {};
    if (known.key.empty()) return {self ? fmt::format("with {}{}", known.place, self->text) : "no " + known.place};
    constexpr std::string_view of_particle = "particle ";  // its name says enough
    const auto place = known.place.substr(known.place.starts_with(of_particle) ? of_particle.size() : 0);
    const auto name = fmt::format("{}{}{}", place, place.empty() ? "" : " ", known.caption);
    if (!self || !self->counts) {
        // a body without them is a point mass at the end
        if (known.key == "center_m") return {name + " at the end"};
        if (known.key == "inertia_kg_m2") return {"point mass"};
        return known.is_setting ? Texts{} : Texts{"no " + name};
    }
    const auto& numbers = self->numbers;
    const bool are_alike = other && other->numbers.size() == numbers.size();
    if (!known.symbol.empty()) return symbol_texts(*self, are_alike ? *other : *self);
    auto shown = *self;
    std::string link;
    if (known.is_of_links && are_equal(numbers) && (!are_alike || are_equal(other->numbers))) {
        shown.numbers.resize(1);
    } else if (are_alike && numbers.size() > max_listed && numbers != other->numbers) {
        // only the first number in which the sides differ
        const auto at = std::ranges::mismatch(numbers, other->numbers).in1;
        link = fmt::format(" of link {}", at - numbers.begin() + 1);
        shown.numbers = {*at};
    }
    return {fmt::format("{}{}{}{}", name, link, name.empty() ? "" : " ", value_words(shown))};
}

/// The settings of the computation of a side, except those that are the default; or only those of both sides.
Texts setting_texts(const std::vector<KeyPair>& pairs, bool of_b, bool of_both) {
    Texts all;
    for (const auto& pair : pairs) {
        const auto& self = of_b ? pair.b : pair.a;
        if (!self || !self->is_setting || self->is_default || (of_both && pair.differs())) continue;
        std::ranges::copy(texts_of(pair, of_b), std::back_inserter(all));
    }
    return all;
}

/// What is said of a side: how it differs from the other one, and the rest of its start.
struct SideTexts {
    Texts differs, start;
};

SideTexts side_texts(const std::vector<KeyPair>& pairs, bool of_b, bool are_comparable) {
    SideTexts all;
    for (const auto& pair : pairs) {
        if (!are_comparable && !(of_b ? pair.b : pair.a)) continue;
        const auto own = texts_of(pair, of_b), others = texts_of(pair, !of_b);
        for (std::size_t i = 0; i < own.size(); ++i)
            if (are_comparable && (i >= others.size() || own[i] != others[i]))
                all.differs.push_back(own[i]);
            else if (pair.any().key == "angle_deg")
                all.start.push_back(own[i]);
    }
    return all;
}

/// For side b or side a: the difference from the other side.
SideCaptions difference_captions(Texts differs, Texts start, bool of_b, bool has_label, Wording wording) {
    if (wording == Wording::plain) {
        start.clear();
        for (auto& text : differs)  // the number alone
            if (const auto at = text.find(" = "); at != std::string::npos) text.erase(0, at + 3);
    }
    // a heading contains two statements; the others go to the note
    constexpr std::size_t max_statements = 2, max_noted = 4;
    const auto rest = differs.begin() + static_cast<long>(std::min(max_statements, differs.size()));
    Texts heading(differs.begin(), rest), note(rest, differs.end());
    note.insert(note.end(), start.begin(), start.end());
    if (note.size() > max_noted) {
        note.resize(max_noted);
        note.back() = "…";
    }
    // with a label set by the preset, the note also states the difference
    if (has_label) note.insert(note.begin(), heading.begin(), heading.end());
    return {heading.empty() ? of_b ? "b, the same" : "a" : joined(heading), joined(note)};
}

/// "piece-02.csv, 500 Hz"
std::string track_words(const Side& side, const TrackSpec& spec) {
    const auto& samples = side.replay->samples();
    const double rate = static_cast<double>(samples.size() - 1) / samples.duration();
    return fmt::format("{}, {} Hz", std::filesystem::path(spec.file).filename().string(), two_digits(rate));
}

/// "double pendulum", "chain of 4 links", "mechanism of 3 masses"; in the plural "double pendulums".
std::string system_words(const SideSpec& side, std::string_view plural = "") {
    constexpr std::array<std::string_view, 3> words{"", "double ", "triple "};
    const auto masses = side.masses();
    if (!side.particles.empty())
        return fmt::format("mechanism{} of {}", plural, masses == 1 ? "one mass" : fmt::format("{} masses", masses));
    if (masses > words.size()) return fmt::format("chain{} of {} links", plural, masses);
    return fmt::format("{}pendulum{}", words[masses - 1], plural);
}

bool is_at_rest(const SideSpec& side) {
    const auto is_moving = [](const ParticleSpec& particle) { return particle.velocity_m_per_s != QuadPair{0, 0}; };
    return side.particles.empty() ? is_zero(side.omega_deg_per_s) : std::ranges::none_of(side.particles, is_moving);
}

// Subtitles of figures.

bool is_swept(const SweptKeys& swept, std::string_view key) {
    return std::ranges::any_of(swept.keys, [&](const std::string& path) {
        return path == key || path.find(fmt::format(".{}", key)) != std::string::npos;
    });
}

/// "two links in angles", "two particles with constraints"
std::string counted_words(const Scene& scene, const std::vector<KeyPair>& pairs, const SweptKeys& swept) {
    constexpr std::array numbers{"no", "one", "two", "three", "four", "five", "six"};
    constexpr std::array models{" in angles", " with constraints", " as a mechanism"};
    const auto& side = scene.preset.a;
    const auto model = scene.a.motion.model;
    const auto count = side.masses();
    const bool are_particles = !side.particles.empty() || model == Model::constraints;
    const auto words = fmt::format("{} {}{}", count < numbers.size() ? numbers[count] : fmt::format("{}", count),
                                   are_particles ? "particle" : "link", count == 1 ? "" : "s");
    const auto is_model = [](const KeyPair& pair) { return pair.any().key == "model" && !pair.differs(); };
    const bool is_common = std::ranges::any_of(pairs, is_model) && !is_swept(swept, "integrator");
    return (is_swept(swept, "links") ? "chains" : words) + (is_common ? models[static_cast<std::size_t>(model)] : "");
}

/// The release angles that all pairs share: "90°/90°", or those of the other links, "θ₂ = θ₃ = 0".
std::string release_words(const Scene& scene, const SweptKeys& swept) {
    const auto &angles = scene.preset.a.angle_deg, &others = scene.preset.b.angle_deg;
    const bool are_swept =
        std::ranges::any_of(swept.keys, [](const std::string& path) { return path.ends_with(".angle_deg"); });
    if (!scene.preset.a.particles.empty() || angles.size() > max_listed || are_swept) return "";
    if (is_swept(swept, "links")) return "released from " + slashed(angles, "°", true);
    if (swept.angles.empty() && angles == others)
        return (angles.size() == 1 ? "released from " : "") + slashed(angles, "°");
    const auto value = [](const Quad& angle) {
        return angle == 0 ? std::string(" = 0") : fmt::format(" = {}°", text_of(angle));
    };
    std::string words;
    std::optional<Quad> before;
    for (std::size_t i = 0; i < angles.size(); ++i) {
        if (angles[i] != others[i] || std::ranges::count(swept.angles, i) > 0) continue;
        if (before) words += *before == angles[i] ? " = " : value(*before) + ", ";
        words += "θ" + subscript(i + 1);
        before = angles[i];
    }
    return before ? words + value(*before) : "";
}

/// "1.2e-03" → "1.2 × 10⁻³"; other numbers are unchanged.
std::string with_power_of_ten(const std::string& digits) {
    const auto e = digits.find('e');
    if (e == std::string::npos) return digits;
    return fmt::format("{} × {}", digits.substr(0, e), power_of_ten(std::stoi(digits.substr(e + 1))));
}

}  // namespace

std::array<SideCaptions, 2> side_captions(const Scene& scene, Wording wording) {
    const auto& preset = scene.preset;
    const bool has_track = scene.a.replay || scene.b.replay, differ = differ_in_kind(preset.a, preset.b);
    const auto pairs = shown_pairs(scene);
    std::array<SideCaptions, 2> both;
    for (const bool of_b : {false, true}) {
        if (of_b && scene.is_single()) break;
        const auto& spec = of_b ? preset.b : preset.a;
        const auto& side = of_b ? scene.b : scene.a;
        const bool has_label = spec.label.has_value();
        const auto texts = side_texts(pairs, of_b, !scene.is_single() && !differ);
        const auto start = side.replay ? track_words(side, spec.track) : joined(texts.start);
        auto& words = both[of_b];
        if (scene.is_single())
            words = {start, has_label ? start : ""};
        else if (has_track)
            words = side.replay ? SideCaptions{"measured", start}
                                : SideCaptions{"computed", joined(setting_texts(pairs, of_b, false))};
        else
            words = differ ? SideCaptions{system_words(spec), start}
                           : difference_captions(texts.differs, texts.start, of_b, has_label, wording);
        words = {spec.label.value_or(words.heading), spec.note.value_or(words.note)};
    }
    return both;
}

std::string scene_caption(const Scene& scene, Wording wording) {
    const auto &a = scene.preset.a, &b = scene.is_single() ? a : scene.preset.b;
    if (scene.preset.subtitle) return *scene.preset.subtitle;
    if (scene.is_single() && scene.a.replay) return "a real double pendulum";
    if (scene.a.replay && scene.b.replay) return "two real double pendulums";
    if (scene.a.replay || scene.b.replay) return "a real double pendulum and its simulation";
    const auto number = scene.members.empty() ? std::string("two") : grouped(static_cast<long>(scene.members.size()));
    const auto systems = scene.is_single()      ? "a " + system_words(a)
                         : differ_in_kind(a, b) ? fmt::format("a {} and a {}", system_words(a), system_words(b))
                                                : fmt::format("{} {}", number, system_words(a, "s"));
    const auto physical = physical_words(a.physical);
    const bool alike = !physical.empty() && physical == physical_words(b.physical);
    const auto common = wording == Wording::plain ? Texts{} : setting_texts(shown_pairs(scene), false, true);
    return fmt::format("{}{}{}{}{}", systems, alike ? " with " + physical : "",
                       !alike && is_at_rest(a) && is_at_rest(b) ? ", released at rest" : "",
                       common.empty() ? "" : " · ", joined(common));
}

std::string pair_subtitle(const Scene& scene, const SweptKeys& swept, const std::string& difference) {
    auto pairs = shown_pairs(scene);
    std::erase_if(pairs, [&](const KeyPair& pair) {
        const auto& key = pair.any();
        const bool is_of_step = key.key == "step_s" || key.key == "tolerance" || key.key == "accuracy";
        return (!key.key.empty() && is_swept(swept, key.key)) ||
               (is_of_step && (swept.step || is_swept(swept, "integrator")));
    });
    Texts parts{counted_words(scene, pairs, swept)};
    // what is the same in all pairs, besides sizes and release
    for (const auto& pair : pairs) {
        const auto& key = pair.any();
        const bool is_property = key.symbol.empty() && !key.is_setting && !scene.preset.a.is_mechanism();
        if ((!is_property && key.symbol != "ω") || pair.differs() || !key.counts || is_zero(key.numbers)) continue;
        std::ranges::copy(texts_of(pair, false), std::back_inserter(parts));
    }
    parts.push_back(release_words(scene, swept));
    parts.push_back(difference);
    if (const auto differs = side_texts(pairs, false, true).differs; !differs.empty())
        parts.push_back(fmt::format("{} against {}", joined(differs), joined(side_texts(pairs, true, true).differs)));
    std::erase(parts, "");
    std::erase_if(pairs, [](const KeyPair& pair) { return pair.any().key == "model"; });
    const auto method = swept.method.empty() ? joined(setting_texts(pairs, false, true)) : swept.method;
    return fmt::format("{}{}{}", joined(parts), method.empty() ? "" : "; ", method);
}

std::string motion_words(const SideSpec& side) {
    const auto physical = physical_words(side.physical);
    const auto rates = is_at_rest(side) ? "" : fmt::format(" at {} °/s", slashed(side.omega_deg_per_s));
    return fmt::format("a {}{} released{} from {}{}, {}", system_words(side),
                       physical.empty() ? "" : fmt::format(" with {},", physical), is_at_rest(side) ? " at rest" : "",
                       slashed(side.angle_deg, "°"), rates, links_words(side));
}

std::string links_words(const SideSpec& side) {
    return fmt::format("{} of {} m and {} kg, g = {} m/s²", side.links() == 1 ? "a link" : "links",
                       slashed(side.length_m, "", true), slashed(side.mass_kg, "", true),
                       text_of(side.gravity_m_per_s2));
}

std::string physical_words(const PhysicalSpec& physical) {
    Texts words;
    for (const auto& property : PhysicalSpec::properties)
        if (physical.has(property) && (words.empty() || words.back() != property.kind))
            words.emplace_back(property.kind);
    if (physical.pivot.amplitude_m != 0) words.emplace_back("a moving pivot");
    if (const auto motors = physical.torques.size(); motors > 0) words.emplace_back(motors == 1 ? "a motor" : "motors");
    return words.size() < 2 ? joined(words) : joined({words.begin(), words.end() - 1}) + " and " + words.back();
}

std::string slashed(const std::vector<Quad>& numbers, std::string_view unit, bool once) {
    constexpr std::size_t max_slashed = 4;
    const bool is_long = numbers.size() > max_slashed;
    Texts texts;
    for (const auto& number : numbers) texts.push_back(fmt::format("{}{}", text_of(number), unit));
    if ((is_long || once) && are_equal(numbers)) return texts[0];
    if (!is_long) return fmt::format("{}", fmt::join(texts, "/"));
    const auto [low, high] = std::ranges::minmax_element(numbers);
    return fmt::format("{1}{0} to {2}{0}", unit, text_of(*low), text_of(*high));
}

std::string value_words(const SideKey& key) {
    if (key.numbers.empty()) return key.text;
    Texts texts;
    for (std::size_t i = 0; i < std::min(key.numbers.size(), max_listed); ++i)
        texts.push_back(number_text(key.numbers[i]));
    if (key.numbers.size() > max_listed) texts.emplace_back("…");
    const bool is_place = !key.is_of_links && texts.size() == 2;
    return with_unit(is_place ? fmt::format("({})", joined(texts)) : fmt::format("{}", fmt::join(texts, "/")),
                     key.unit);
}

std::string step_text(const Rational& step) {
    return step.numerator == 1 ? fmt::format("1/{} s", grouped(step.denominator)) : fmt::format("{} s", step.value());
}

std::string step_control_text(const Side& side) {
    return side.method.adaptive ? "tolerance " + number_text(side.motion.tolerance) : step_text(side.step);
}

std::string number_text(const Quad& number) {
    const auto text = with_power_of_ten(text_of(number));
    return text.starts_with("1 × ") ? text.substr(std::string_view("1 × ").size()) : text;
}

std::string subscript(std::size_t number) {
    constexpr std::array<std::string_view, 10> digits{"₀", "₁", "₂", "₃", "₄", "₅", "₆", "₇", "₈", "₉"};
    std::string text;
    for (const char digit : fmt::format("{}", number)) text += digits[static_cast<std::size_t>(digit - '0')];
    return text;
}

std::string grouped(long number) {
    auto digits = fmt::format("{}", number);
    if (digits.size() < 5) return digits;
    for (auto at = static_cast<long>(digits.size()) - 3; at > 0; at -= 3)
        digits.insert(static_cast<std::size_t>(at), " ");
    return digits;
}

std::string two_digits(double value) {
    return with_digits(value, 2);
}

std::string with_digits(double value, int digits) {
    const double unit = std::pow(10.0, std::floor(std::log10(std::max(value, 1.0))) - digits + 1);
    return unit < 1 ? fmt::format("{:.{}g}", value, digits) : grouped(std::lround(std::round(value / unit) * unit));
}

std::string scientific(double value) {
    if (!(value > 0)) return "0";
    if (value >= 0.1 && value < 1000) return two_digits(value);
    return with_power_of_ten(fmt::format("{:.1e}", value));
}

}  // namespace doppel
