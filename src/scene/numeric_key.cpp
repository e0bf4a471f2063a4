#include "scene/numeric_key.hpp"

#include "scene/captions.hpp"
#include "scene/preset_fields.hpp"
#include "scene/side_keys.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace doppel {
namespace {

/// Visits lists of fields, and hands the number of one key to `use`.
template <class Use>
class NumberVisitor {
public:
    NumberVisitor(std::string_view key, const Use& use) : key_(key), use_(use) {}

    template <class T>
    void operator()(const Field& field, T& member) {
        if constexpr (std::is_invocable_v<const Use&, const Field&, T&>) {
            names_.push_back(field.key);
            if (field.key != key_) return;
            found_ = true;
            use_(field, member);
        }
    }
    static bool from_command_line(std::string_view) { return false; }
    template <class Visit>
    static void table(std::string_view, const Visit&) {}  // visit_side() goes there itself

    bool found() const { return found_; }
    const std::vector<std::string_view>& names() const { return names_; }

private:
    std::string_view key_;
    const Use& use_;
    bool found_ = false;
    std::vector<std::string_view> names_;
};

/// What numbers are made of: use(field, value) for one that is there, or may be.
template <class UseReal, class UseWhole, class UseStep>
struct NumberUse {
    std::optional<std::size_t> element;
    UseReal real;
    UseWhole whole;
    UseStep step;

    void operator()(const Field& field, Quad& x) const { real(field, std::span(&x, 1)); }
    void operator()(const Field& field, std::optional<Quad>& x) const {
        if (!x) x.emplace(0);
        real(field, std::span(&*x, 1));
    }
    void operator()(const Field& field, std::vector<Quad>& x) const { real(field, std::span(x)); }
    void operator()(const Field& field, QuadPair& x) const { real(field, std::span(x)); }
    void operator()(const Field& field, std::optional<QuadPair>& x) const {
        if (!x) x.emplace();
        real(field, std::span(*x));
    }
    void operator()(const Field& field, int& x) const { whole(field, x); }
    void operator()(const Field& field, std::optional<Rational>& x) const { step(field, x); }
};
template <class R, class W, class S>
NumberUse(std::optional<std::size_t>, R, W, S) -> NumberUse<R, W, S>;

/// "force.spring.stiffness_N_per_m": the table's key, the entry's name and the entry's key; or the last alone.
struct Place {
    std::string_view table, entry, key;

    explicit Place(std::string_view inside) : key(inside) {
        const auto first = inside.find('.'), last = inside.rfind('.');
        if (first == std::string_view::npos) return;
        table = inside.substr(0, first);
        entry = first == last ? "" : inside.substr(first + 1, last - first - 1);
        key = inside.substr(last + 1);
    }
};

/// The entry of that name, or the only one of that kind; null where there is none.
template <class Spec>
Spec* entry_named(std::vector<Spec>& entries, std::string_view name) {
    const auto named = std::find_if(entries.begin(), entries.end(), [&](const Spec& e) { return e.name == name; });
    if (named != entries.end()) return &*named;
    if constexpr (requires { Spec::kinds; }) {
        const auto is_kind = [&](const Spec& entry) { return kind_name(entry) == name; };
        const auto first = std::find_if(entries.begin(), entries.end(), is_kind);
        if (first != entries.end() && std::none_of(first + 1, entries.end(), is_kind)) return &*first;
    }
    return nullptr;
}

template <class Visitor>
void visit_side(SideSpec& side, const Place& place, Visitor& visit) {
    if (place.table.empty()) {
        if (side.particles.empty()) {
            chain_fields(visit, side);
            physical_fields(visit, side.physical);
        }
        gravity_field(visit, side);
        if (side.accuracy)
            visit(accuracy_field, side.accuracy);
        else
            method_fields(visit, side);
        precision_fields(visit, side);
        return;
    }
    const auto visit_part = [&](auto& entries) {
        if (auto* entry = entry_named(entries, place.entry))
            std::visit([&](auto& part) { part_fields(visit, part, kind_name(*entry)); }, entry->part);
    };
    if (place.table == "constraint") visit_part(side.constraints);
    if (place.table == "force") visit_part(side.forces);
    if (place.table == "pivot") pivot_fields(visit, side.physical.pivot);
    if (place.table == "torque")
        if (auto* torque = entry_named(side.physical.torques, place.entry)) part_fields(visit, *torque);
    if (place.table == "particle")
        if (auto* particle = entry_named(side.particles, place.entry)) part_fields(visit, *particle);
}

std::string label_of(const NumericKey& key, const Field& field) {
    const Place place(key.inside);
    static constexpr std::array<std::array<std::string_view, 3>, 4> of_links{
        {{"angle_deg", "release angle", "θ"},
         {"mass_kg", "mass", "m"},
         {"length_m", "length", "l"},
         {"omega_deg_per_s", "rate at the start", "ω"}}};
    auto words = words_of_key(place.key);
    if (place.table.empty())
        for (const auto& [name, meaning, symbol] : of_links)
            if (place.key == name)
                words = key.element ? fmt::format("{} {}{}", meaning, symbol, subscript(*key.element + 1))
                                    : fmt::format("{} of all links", meaning);
    if (!place.entry.empty())
        words = fmt::format("{} of {}{}", words, place.entry, key.element ? *key.element == 0 ? ", x" : ", y" : "");
    if (key.sides != NumericKey::Sides::both) words += key.sides == NumericKey::Sides::a ? " of side a" : " of side b";
    const auto unit = field.unit == "deg" ? "°" : field.unit == "deg/s" ? "°/s" : field.unit;
    return unit.empty() ? words : fmt::format("{}, {}", words, unit);
}

/// "system.mass_kg[1]": takes the sides and the element off it.
void split(const TomlReader& table, std::string_view key, NumericKey& into) {
    std::string_view rest = into.path;
    using Sides = NumericKey::Sides;
    for (const auto& [name, sides] : {std::pair("system.", Sides::both), {"a.", Sides::a}, {"b.", Sides::b}})
        if (rest.starts_with(name)) {
            into.sides = sides;
            into.inside = rest.substr(std::string_view(name).size());
        }
    if (into.inside.empty())  // no key of a side at all
        throw table.fault(key,
                          "must be a numeric key such as \"system.gravity_m_per_s2\" or \"b.mass_kg[1]\", or "
                          "\"theta1_deg\", \"theta2_deg\", \"mass_ratio\" or \"length_ratio\"; it is \"{}\"",
                          into.path);
    const auto bracket = into.inside.find('[');
    if (bracket == std::string::npos) return;
    std::size_t element = 0;
    const char *first = into.inside.data() + bracket + 1, *end = into.inside.data() + into.inside.size();
    const auto [after, fault] = std::from_chars(first, end, element);
    if (fault != std::errc() || after + 1 != end || *after != ']')
        throw table.fault(key, "must end like \"mass_kg[1]\" where it is one of several; it is \"{}\"", into.path);
    into.element = element;
    into.inside.resize(bracket);
}

/// Checks the number against one side, and takes what its field says.
void find_in(SideSpec side, const TomlReader& table, std::string_view key, NumericKey& number) {
    const Place place(number.inside);
    const auto demand_counting = [&](const Field& field) {
        if (!field.only.holds && !field.only.fault.empty())
            throw table.fault(key, "\"{}\" {}", number.path, field.only.fault);
        number.bounds = field.bounds;
        number.label = label_of(number, field);
    };
    const auto demand_single = [&] {
        if (number.element) throw table.fault(key, "\"{}\" is a number, not an array", number.path);
    };
    const NumberUse use{number.element,
                        [&](const Field& field, std::span<Quad> values) {
                            demand_counting(field);
                            const bool is_array = !field.each.empty() || values.size() > 1;
                            if (!is_array) demand_single();
                            if (number.element && *number.element >= values.size())
                                throw table.fault(key, "\"{}\" is beyond the array, whose last is [{}]", number.path,
                                                  values.size() - 1);
                            if (!number.element && field.each.empty() && values.size() > 1)
                                throw table.fault(key, "\"{}\" has two numbers; give {}[0] or {}[1]", number.path,
                                                  number.path, number.path);
                        },
                        [&](const Field& field, int&) {
                            demand_single();
                            demand_counting(field);
                            number.is_whole = true;
                        },
                        [&](const Field& field, std::optional<Rational>&) {
                            demand_single();
                            demand_counting(field);
                            number.is_step = true;
                        }};
    NumberVisitor visit(place.key, use);
    visit_side(side, place, visit);
    if (visit.found()) return;
    if (place.key == "accuracy")
        throw table.fault(key, "\"{}\" is varied where the preset gives an accuracy", number.path);
    if (visit.names().empty() && !place.table.empty())
        throw table.fault(key, "\"{}\" is of no particle, constraint or force of the preset", number.path);
    throw table.fault(key, "\"{}\" is no number of the preset; there are {}", number.path,
                      fmt::join(visit.names(), ", "));
}

void put(SideSpec& side, const NumericKey& number, const Quad& value, const Rational& sample_hz) {
    const Place place(number.inside);
    const NumberUse use{
        number.element,
        [&](const Field&, std::span<Quad> values) {
            if (number.element)
                values[*number.element] = value;
            else
                std::fill(values.begin(), values.end(), value);
        },
        [&](const Field&, int& whole) { whole = static_cast<int>(std::lround(static_cast<double>(value))); },
        [&](const Field&, std::optional<Rational>& step) {
            const auto interval = quotient({1, 1}, sample_hz);
            const auto steps = std::lround(static_cast<double>(Quad(interval->as<Quad>() / value)));
            step = interval ? quotient(*interval, {steps, 1}) : std::nullopt;
        }};
    NumberVisitor visit(place.key, use);
    if (!number.is_whole) return visit_side(side, place, visit);
    // links of one kind stay so
    const auto old = side;
    visit_side(side, place, visit);
    const auto spread = [](const std::vector<Quad>& before, std::vector<Quad>& now) {
        if (std::all_of(before.begin(), before.end(), [&](const Quad& x) { return x == before.front(); }))
            std::fill(now.begin(), now.end(), before.front());
    };
    spread(old.mass_kg, side.mass_kg);
    spread(old.length_m, side.length_m);
    spread(old.angle_deg, side.angle_deg);
    spread(old.omega_deg_per_s, side.omega_deg_per_s);
    const auto old_lists = old.physical.lists();
    const auto lists = side.physical.lists();
    for (std::size_t i = 0; i < lists.size(); ++i) spread(*old_lists[i], *lists[i]);
    if (!old.physical.center_m.empty()) spread(old.physical.center_m, side.physical.center_m = side.length_m);
}

}  // namespace

NumericKey::NumericKey(const TomlReader& table, std::string_view key, std::string given, const Preset& preset)
    : path(std::move(given)) {
    split(table, key, *this);
    if (sides != Sides::b) find_in(preset.a, table, key, *this);
    if (sides != Sides::a) find_in(preset.b, table, key, *this);
    keeps_method = !is_whole && !is_step && inside != "accuracy" && inside != "tolerance";
}

Quad NumericKey::taken(const Quad& value, const Preset& preset) const {
    if (is_whole) return Quad(round(value));
    if (!is_step) return value;
    auto probe = preset;
    set(probe, value, 0);
    return (sides == Sides::b ? probe.b : probe.a).step().as<Quad>();
}

void NumericKey::set(Preset& preset, const Quad& value, const Quad& difference) const {
    if (sides != Sides::b) put(preset.a, *this, value, preset.sample_hz);
    if (sides != Sides::a)
        put(preset.b, *this, sides == Sides::both ? Quad(value + difference) : value, preset.sample_hz);
}

}  // namespace doppel
