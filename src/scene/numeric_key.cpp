#include "scene/numeric_key.hpp"

#include "scene/captions.hpp"
#include "scene/side_keys.hpp"
#include "scene/toml_reader.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

/// "force.spring.stiffness_N_per_m": the key of the table, the name of the entry, and the entry's key; or only the last
/// one.
struct Place {
    std::string_view table, entry, key;

    explicit Place(std::string_view inside) : key(inside.substr(inside.rfind('.') + 1)) {
        const auto first = inside.find('.'), last = inside.rfind('.');
        if (first != std::string_view::npos) table = inside.substr(0, first);
        if (first != last) entry = inside.substr(first + 1, last - first - 1);
    }
};

/// A number of a side: one or all elements of an array, a single number, a whole number, or the step size.
struct FoundNumber {
    std::optional<Field> field = {};
    std::span<Quad> values = {};
    bool is_whole = false;
    std::optional<Rational>* step = nullptr;
    std::vector<std::string_view> names = {};  // of all numbers in its table
};

/// The index of the entry with this name, or of the only entry of this kind; 0 = the side itself, or its pivot.
int entry_meant(SideSpec& side, const Place& place) {
    constexpr int several = -1;
    int of_kind = 0;
    for (const auto& entry : entries_of(side)) {
        if (entry.table != place.table) continue;
        if (entry.name == place.entry) return entry.number;
        if (entry.kind == place.entry && entry.kind != entry.table) of_kind = of_kind == 0 ? entry.number : several;
    }
    return of_kind;
}

/// `put_whole` replaces a whole number before its dependent keys are listed.
FoundNumber find_number(SideSpec& side, const Place& place, std::optional<int> put_whole = {}) {
    FoundNumber found;
    const int entry = entry_meant(side, place);
    for_each_key(side, [&](const SideEntry& owner, const Field& field, const KeyMember& any) {
        if (owner.table != place.table || owner.number != entry) return;
        const auto* whole = std::get_if<int*>(&any);
        const auto* step = std::get_if<std::optional<Rational>*>(&any);
        const auto values = numbers_of(any);
        if (!whole && !step && (!values || (values->empty() && field.absent.empty()))) return;
        found.names.push_back(field.key);
        if (field.key != place.key) return;
        found.field = field;
        found.is_whole = whole;
        if (whole) **whole = put_whole.value_or(**whole);
        if (step) found.step = *step;
        if (values) found.values = *numbers_of(any, true);
    });
    return found;
}

/// All numbers of a chain, array by array.
std::vector<std::span<Quad>> all_numbers(SideSpec& side) {
    std::vector<std::span<Quad>> all;
    for_each_key(side, [&](const SideEntry&, const Field&, const KeyMember& any) {
        all.push_back(numbers_of(any).value_or(std::span<Quad>()));
    });
    return all;
}

std::string label_of(const NumericKey& key, const Field& field) {
    const Place place(key.inside);
    auto words = caption_of(field);
    if (!field.symbol.empty() && !field.each.empty())
        words = key.element ? fmt::format("{} {}{}", words, field.symbol, subscript(*key.element + 1))
                            : fmt::format("{} of all links", words);
    if (!place.entry.empty())
        words = fmt::format("{} of {}{}", words, place.entry, key.element ? *key.element == 0 ? ", x" : ", y" : "");
    if (key.sides != NumericKey::Sides::both) words += key.sides == NumericKey::Sides::a ? " of side a" : " of side b";
    const auto unit = field.unit == "deg" ? "°" : field.unit == "deg/s" ? "°/s" : field.unit;
    return unit.empty() ? words : fmt::format("{}, {}", words, unit);
}

/// Splits "system.mass_kg[1]" into sides, key and element.
void split(const TomlReader& table, std::string_view key, NumericKey& into) {
    std::string_view rest = into.path;
    using Sides = NumericKey::Sides;
    for (const auto& [name, sides] : {std::pair("system.", Sides::both), {"a.", Sides::a}, {"b.", Sides::b}})
        if (rest.starts_with(name)) {
            into.sides = sides;
            into.inside = rest.substr(std::string_view(name).size());
        }
    if (into.inside.empty())  // not a key of a side
        throw table.error(key,
                          "must be a numeric key such as \"system.gravity_m_per_s2\" or \"b.mass_kg[1]\", or "
                          "\"theta1_deg\", \"theta2_deg\", \"mass_ratio\" or \"length_ratio\"; it is \"{}\"",
                          into.path);
    if (!take_element(into.inside, into.element))
        throw table.error(key, "must end like \"mass_kg[1]\" where it is one of several; it is \"{}\"", into.path);
}

/// Of a link's mass_kg and rod_mass_kg one may be 0, as in films.
Bounds bounds_of(const SideSpec& side, const NumericKey& number, const Field& field) {
    const bool is_of_ends = number.inside == "mass_kg";
    if (!is_of_ends && number.inside != "rod_mass_kg") return field.bounds;
    const auto& others = is_of_ends ? side.physical.rod_mass_kg : side.mass_kg;
    const auto is_0 = [](const Quad& mass) { return mass == 0; };
    const bool is_any_0 = number.element ? is_0(others[*number.element]) : std::ranges::any_of(others, is_0);
    return is_any_0 ? positive : not_negative;
}

/// Checks the number for one side, and copies the properties of its field.
void find_in(SideSpec side, const Rational& sample_hz, const TomlReader& table, std::string_view key,
             NumericKey& number) {
    const Place place(number.inside);
    const auto found = find_number(side, place);
    const auto refuse = [&](std::string_view why) { throw table.error(key, "\"{}\" {}", number.path, why); };
    if (!found.field) {
        if (place.key == "accuracy") refuse("needs an accuracy in the preset");
        if (found.names.empty() && !place.table.empty()) refuse("names no particle, constraint or force of the preset");
        refuse(fmt::format("is not a number of the preset; there are {}", fmt::join(found.names, ", ")));
    }
    const auto& field = *found.field;
    const auto& values = found.values;
    number.is_whole = found.is_whole;
    number.is_step = found.step != nullptr;
    const bool is_array = !found.is_whole && !found.step && (!field.each.empty() || values.size() > 1);
    if (!field.only.applies && !field.only.error.empty()) refuse(field.only.error);
    if (!is_array && number.element) refuse("is a number, not an array");
    number.label = label_of(number, field);
    if (number.element && values.empty()) refuse(fmt::format("needs {} in the preset", field.key));
    if (number.element && *number.element >= values.size())
        refuse(fmt::format("is beyond the array, whose last element is [{}]", values.size() - 1));
    if (!number.element && field.each.empty() && values.size() > 1)
        refuse(fmt::format("has two numbers; give {0}[0] or {0}[1]", number.path));
    const bool is_open = number.bounds.is_open;  // for the other side
    number.bounds = bounds_of(side, number, field);
    number.bounds.is_open |= is_open;
    constexpr double rounding = 1e-6;
    if (found.step) number.bounds.high = (1 + rounding) / sample_hz.value();
    if (place.key != "links") return;
    for_each_key(side, [&](const SideEntry& owner, const Field& other, const KeyMember& any) {
        const auto all = numbers_of(any);
        if (owner.number == 0 && all && !all->empty() && !are_equal(*all))
            refuse(fmt::format("needs links that are all equal; {} has different numbers", other.key));
    });
}

/// The step nearest to `value` of which a sample takes a whole number.
Rational step_near(const Quad& value, const Rational& sample_hz) {
    const auto interval = *quotient({1, 1}, sample_hz);
    const auto steps = std::lround(static_cast<double>(Quad(interval.as<Quad>() / value)));
    return quotient(interval, {steps, 1}).value_or(default_step);
}

void put(SideSpec& side, const NumericKey& number, const Quad& value, const Rational& sample_hz) {
    const Place place(number.inside);
    if (!number.is_whole) {
        if (place.key == "center_m") side.physical.center_m.resize(side.links());  // if it was not given
        const auto found = find_number(side, place);
        if (found.step) *found.step = step_near(value, sample_hz);
        std::ranges::fill(number.element ? found.values.subspan(*number.element, 1) : found.values, value);
        return;
    }
    auto old = side;
    find_number(side, place, static_cast<int>(std::lround(static_cast<double>(value))));
    // equal links stay equal
    const auto numbers = all_numbers(side), were = all_numbers(old);
    for (std::size_t i = 0; i < numbers.size(); ++i)
        if (are_equal(were[i])) std::ranges::fill(numbers[i], were[i][0]);
    if (const auto& centers = old.physical.center_m; !centers.empty())
        side.physical.center_m.assign(side.links(), centers[0]);
}

}  // namespace

NumericKey::NumericKey(const TomlReader& table, std::string_view key, std::string given, const Preset& preset)
    : path(std::move(given)) {
    split(table, key, *this);
    if (sides != Sides::b) find_in(preset.a, preset.sample_hz, table, key, *this);
    if (sides != Sides::a) find_in(preset.b, preset.sample_hz, table, key, *this);
    keeps_method = !is_whole && !is_step && inside != "accuracy" && inside != "tolerance";
}

Quad NumericKey::taken(const Quad& value, const Preset& preset) const {
    if (is_whole) return Quad(round(value));
    return is_step ? step_near(value, preset.sample_hz).as<Quad>() : value;
}

void NumericKey::set(Preset& preset, const Quad& value, const Quad& difference) const {
    if (sides != Sides::b) put(preset.a, *this, value, preset.sample_hz);
    if (sides != Sides::a)
        put(preset.b, *this, sides == Sides::both ? Quad(value + difference) : value, preset.sample_hz);
}

SideSpec between(SideSpec from, SideSpec to, const Quad& share) {
    const auto numbers = all_numbers(from), ends = all_numbers(to);
    for (std::size_t i = 0; i < numbers.size(); ++i)
        for (std::size_t k = 0; k < std::min(numbers[i].size(), ends[i].size()); ++k)
            numbers[i][k] = Quad(numbers[i][k] + share * (ends[i][k] - numbers[i][k]));
    return from;
}

}  // namespace doppel
