#include "base/text.hpp"
#include "scene/resolved.hpp"
#include "scene/toml_reader.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace doppel {
namespace {

std::string listed(std::span<const std::string_view> choices) {
    std::string text;
    for (std::size_t i = 0; i < choices.size(); ++i)
        text += fmt::format("{}\"{}\"", i == 0 ? "" : i + 1 == choices.size() ? " or " : ", ", choices[i]);
    return text;
}

/// {1} for key[1]; converted to text only for errors.
using Element = std::initializer_list<std::size_t>;

std::string index_text(Element element) {
    std::string text;
    for (const auto index : element) text += fmt::format("[{}]", index);
    return text;
}

/// Reads the value of a key into a member, by the member's type.
class ValueReader {
public:
    ValueReader(const TomlReader& table, const Field& field) : table_(table), field_(field) {}

    void read(const toml::node& node, std::string& into) const {
        if (!node.is_string()) throw error("must be a string; {}", found(node));
        into = node.as_string()->get();
        if (field_.is_drawn) table_.require_drawable(field_.key, into);
        const auto& names = field_.names;
        if (names.empty() || std::find(names.begin(), names.end(), into) != names.end()) return;
        throw error("must be {}; it is \"{}\"{}", listed(names), into,
                    did_you_mean("; ", into, {names.begin(), names.end()}));
    }

    void read(const toml::node& node, int& into) const {
        if (!node.is_integer()) throw error("must be a whole number; {}", found(node));
        const auto value = static_cast<double>(node.as_integer()->get());
        check(value);
        into = static_cast<int>(value);
    }

    void read(const toml::node& node, bool& into) const {
        if (!node.is_boolean()) throw error("must be true or false; {}", found(node));
        into = node.as_boolean()->get();
    }

    template <class Number>
    requires std::is_same_v<Number, double> || std::is_same_v<Number, Quad>
    void read(const toml::node& node, Number& into) const {
        into = number(node, {}, into);
        check(into);
    }

    /// A number, or "a/b" in quotes.
    void read(const toml::node& node, Rational& into) const {
        std::optional<Rational> value;
        if (const auto* text = node.as_string()) {
            value = parse_rational(text->get());
            if (!value) throw error("must be a number or a fraction such as \"1/30000\"; it is {}", shown(node));
        } else if (const auto* whole = node.as_integer()) {
            value = reduced(whole->get(), 1);
        } else {
            // with all written digits
            const Quad decimal = number(node, {}, Quad());
            value = rational_from_decimal(static_cast<double>(decimal));
            const Quad rounding = parse_quad("1e-32") * abs(decimal);
            if (value && abs(Quad(value->as<Quad>() - decimal)) > rounding) value.reset();
        }
        if (!value) throw error("has too many digits; it is {}", shown(node));
        const bool is_open = field_.bounds.is_open;
        if (value->numerator < (is_open ? 1 : 0))
            throw error("must be {} 0; it is {}", is_open ? ">" : "≥", shown(node));
        check(value->value());
        into = *value;
    }

    /// 1 to `maximum` numbers.
    void read(const toml::node& node, std::vector<double>& into) const {
        if (node.is_number() && is_typed(node)) {
            into.resize(1);
            return read(node, into[0]);
        }
        into.resize(some_of(node, "numbers").size());
        read_array(node, std::span(into));
    }

    /// One number for all, or as many as the member already has: other keys give the count.
    void read(const toml::node& node, std::vector<Quad>& into) const {
        if (node.is_array()) return read_array(node, std::span(into), "links");
        if (!node.is_number())
            throw error("must be a number, or an array of {} numbers, {}; {}", into.size(), field_.each, found(node));
        std::fill(into.begin(), into.end(), number(node, {}, Quad()));
        check(into[0], {0});
    }

    void read(const toml::node& node, QuadPair& into) const {
        if (!node.is_array()) throw error("must be two numbers, [x, y]; {}", found(node));
        ValueReader(table_, {.key = field_.key, .each = "x and y"}).read_array(node, std::span<Quad>(into));
    }

    void read(const toml::node& node, EndSpec& into) const {
        if (node.is_string())
            read(node, into.emplace<std::string>());
        else
            read(node, into.emplace<QuadPair>());
    }

    void read(const toml::node& node, std::array<int, 2>& into) const {
        read_whole_pair(node, "two whole numbers", into[0], into[1]);
    }
    void read(const toml::node& node, Size& into) const {
        read_whole_pair(node, "whole numbers", into.width, into.height);
    }

    /// For bounds > 0, a logarithmic axis.
    void read(const toml::node& node, Range& into) const {
        const auto [low, high] = two_numbers(node);
        if (field_.bounds.is_open && (!(high >= 10 * low) || high / low > 1e60))
            throw error("must increase by 1 to 60 powers of ten; it is [{}, {}]", low, high);
        if (!(high > low) || !std::isfinite(high - low)) throw error("must increase; it is [{}, {}]", low, high);
        into = {low, high};
    }

    /// Each must be one of `names`, if there are any.
    void read(const toml::node& node, std::vector<std::string>& into) const {
        auto texts = texts_in(node);
        for (const auto& text : texts) {
            if (field_.is_drawn) table_.require_drawable(field_.key, text);
            if (!field_.names.empty() &&
                std::find(field_.names.begin(), field_.names.end(), text) == field_.names.end())
                throw error("must be of {}; \"{}\" is not", fmt::join(field_.names, ", "), text);
        }
        into = std::move(texts);
    }

    void read(const toml::node& node, ChosenText& into) const {
        into = {};
        if (node.is_boolean()) return read(node, into.shown);
        if (node.is_string()) return read(node, into.own.emplace().emplace_back());
        if (!node.is_array()) throw error("must be true, false, text or a list of text; {}", found(node));
        read(node, into.own.emplace());
    }

    /// 1 to `maximum` values.
    void read(const toml::node& node, TomlValues& into) const {
        into.texts.clear();
        for (const auto& element : some_of(node, "values")) into.texts.push_back(text_in(element));
    }

    /// Reads a given list of numbers, texts or colours.
    template <class T>
    void read_element(const toml::node& node, std::size_t element, T& into) const {
        const auto check_size = [&](std::size_t size) {
            if (element >= size)
                throw size == 0 ? error("is an element of a list that the preset does not have; give the whole list")
                                : error("is beyond the list, whose last element is [{}]", size - 1);
        };
        if constexpr (std::is_same_v<T, TomlValues>) {
            check_size(into.texts.size());
            into.texts[element] = text_in(node);
        } else if constexpr (std::is_same_v<T, Size>) {
            check_size(2);
            const Field number{.key = field_.key, .bounds = field_.bounds};  // the unit is not shown
            ValueReader(table_, number).read(node, element == 0 ? into.width : into.height);
        } else if constexpr (is_optional<T>) {
            check_size(into ? element + 1 : 0);
            read_element(node, element, *into);
        } else if constexpr (requires { read(node, into[element]); } && !std::is_same_v<T, std::string>) {
            check_size(into.size());
            read(node, into[element]);
        } else {
            throw error("is not an element of a list of numbers");
        }
    }

    void read(const toml::node& node, Members& into) const {
        into.releases.clear();
        const auto* releases = node.as_array();
        if (!releases) return read(node, into.count);
        const auto refuse = [&](const std::string& what) {
            throw error("must be a whole number, or 2 to {} lists of angles or tables; {}", Members::max_releases,
                        what);
        };
        if (releases->size() < 2 || releases->size() > Members::max_releases) refuse(found(node));
        for (std::size_t k = 0; k < releases->size(); ++k) {
            const auto& release = *releases->get(k);
            auto& member = into.releases.emplace_back();
            if (const auto* table = release.as_table())
                read_release(*table, k, member);
            else if (const auto* list = release.as_array();
                     (list && !list->empty()) || (release.is_number() && is_typed(node)))
                read_numbers(release, {"angle_deg"}, k, member.angle_deg);
            else
                refuse(fmt::format("{} is {}", shown(release), kind_of(release)));
        }
    }

    /// Reads the keys of member number `k` of an ensemble, from 0.
    void read_release(const toml::table& table, std::size_t k, Release& member) const {
        for (const auto& [key, value] : table) {
            const auto list = std::ranges::find(Release::lists, key.str(), &Release::List::key);
            if (list != Release::lists.end())
                read_numbers(value, list->key, k, member.*list->member);
            else if (key.str() == "color")
                read(value, member.color.emplace());
            else
                throw error("[{}] may have angle_deg, mass_kg, length_m and color; \"{}\" is none of them", k,
                            key.str());
        }
    }
    void read_numbers(const toml::node& node, std::string_view key, std::size_t k, std::vector<Quad>& into) const {
        const Field field{.key = field_.key, .bounds = key == "angle_deg" ? angle_bounds : positive};
        const auto add = [&](const toml::node& element) {
            const Element place{k, into.size()};
            into.push_back(number(element, place, Quad()));
            ValueReader(table_, field).check(into.back(), place);
        };
        if (const auto* list = node.as_array())
            for (const auto& element : *list) add(element);
        else
            add(node);
        if (into.empty()) throw error("[{}] {} must have numbers, one a link; it is []", k, key);
    }

    void read(const toml::node& node, Speed& into) const {
        const auto* array = node.as_array();
        into.changes.clear();
        if (!array) return read(node, into.constant);
        constexpr std::string_view form = "must be a speed, or times, s, with speeds such as [[0, 1], [6.8, 0.25]]";
        if (array->empty()) throw error("{}; it is []", form);
        for (const auto& element : *array) {
            const auto* pair = element.as_array();
            if (!pair || pair->size() != 2) throw error("{}; {} is none", form, shown(element));
            auto& [at_s, speed] = into.changes.emplace_back();
            ValueReader(table_, {.key = field_.key, .bounds = not_negative}).read(*pair->get(0), at_s);
            ValueReader(table_, {.key = field_.key, .bounds = changing_speeds}).read(*pair->get(1), speed);
        }
    }

    /// Reads "#rrggbb".
    void read(const toml::node& node, Color& into) const {
        const auto* text = node.as_string();
        const auto color = text ? parse_color(text->get()) : std::nullopt;
        if (!color) throw error("must be a colour such as \"#ff9f40\"; {}", found(node));
        into = *color;
    }

    void read(const toml::node& node, std::array<Color, 2>& into) const {
        const auto colors = texts_in(node);
        if (colors.size() != 2) throw error("must have 2 colours, a and b; it has {}", colors.size());
        for (std::size_t i = 0; i < 2; ++i) {
            const auto color = parse_color(colors[i]);
            if (!color) throw error("must be colours such as \"#ff9f40\"; [{}] is \"{}\"", i, colors[i]);
            into[i] = *color;
        }
    }

    /// "pendulums" and the strips, in order.
    void read(const toml::node& node, Panels& into) const {
        const auto panels = texts_in(node);
        into = {false, {}};
        for (const auto& panel : panels) {
            if (std::ranges::find(field_.names, panel) == field_.names.end())
                throw error("may contain \"{}\"; \"{}\" is none of them", fmt::join(field_.names, "\", \""), panel);
            const auto kind = value_named<StripKind>(panel);
            if (panel == "pendulums")
                into.pendulums = true;
            else if (std::ranges::find(into.strips, kind) == into.strips.end())
                into.strips.push_back(kind);
        }
        if (panels.empty()) throw error("must contain at least one of \"{}\"", fmt::join(field_.names, "\", \""));
    }

private:
    template <class... Args>
    KeyError error(fmt::format_string<Args...> format, Args&&... args) const {
        return table_.error(field_.key, format, std::forward<Args>(args)...);
    }
    /// An error of an element of the key's array.
    template <class... Args>
    KeyError error_of(Element element, fmt::format_string<Args...> format, Args&&... args) const {
        return table_.error_at(field_.key, fmt::format("{}{} {}", table_.subject(field_.key), index_text(element),
                                                       fmt::format(format, std::forward<Args>(args)...)));
    }

    std::string text_in(const toml::node& value) const {
        return value.is_number() ? text_of(number(value, {}, Quad())) : written(value);
    }

    template <class Number>
    void check(const Number& value, Element element = {}) const {
        const auto& bounds = field_.bounds;
        const auto& [low, high, is_open, zero, why, is_positive] = bounds;
        if ((is_open ? value > low : value >= low) && value <= high) return;
        // keys usually contain the unit
        const auto unit =
            field_.unit.empty() || field_.key.ends_with(field_.unit) ? "" : fmt::format(" {}", field_.unit);
        const auto right = is_positive && !(value > 0) ? "> 0"
                           : is_open && !(value > low) ? fmt::format("> {}", low)
                           : is_open                   ? fmt::format("at most {}{}", high, unit)
                           : !bounds.has_high()
                               ? fmt::format("{} {}", is_positive ? "at least" : "≥", low)
                               : fmt::format("from {}{} to {}{}{}", low, zero.empty() ? "" : fmt::format(" ({})", zero),
                                             high, unit, why.empty() ? "" : fmt::format(": {}", why));
        const auto error = error_of(why.empty() ? element : Element{}, "must be {}; {} is {}", right,
                                    why.empty() ? "it" : "one", toml_value(value));
        // together with other keys, if the key would accept the number without them
        const auto& widest = field_.otherwise;
        throw widest && value >= widest->low && value <= widest->high ? error.with(table_.beside(field_.only.beside))
                                                                      : error;
    }

    double number(const toml::node& node, Element element, double) const {
        if (!node.is_number()) throw error_of(element, "must be a number; {}", found(node));
        const double value = node.is_integer() ? static_cast<double>(node.as_integer()->get()) : *node.value<double>();
        if (!std::isfinite(value)) throw error_of(element, "must be finite; it is {}", value);
        return value + 0.0;  // turns −0 into 0
    }
    /// A number with all written digits.
    Quad number(const toml::node& node, Element element, const Quad&) const {
        const double rounded = number(node, element, 0.0);
        if (const auto* whole = node.as_integer()) return Quad(whole->get());
        const auto literal = literal_of(node, table_.texts());
        if (!literal) return Quad(rounded);
        const Quad value = parse_quad(*literal) + 0;
        // the literal must equal the number that was read; otherwise its place is wrong
        constexpr double rounding = 1e-15, minimum = 1e-322;
        if (!(std::abs(static_cast<double>(value) - rounded) <= rounding * std::abs(rounded) + minimum))
            throw error_of(element, "has digits that cannot be found in the text; it is {}", rounded);
        constexpr std::size_t always_held = 33;
        if (literal->size() <= always_held) return value;
        const auto digits = significant_digits(*literal);
        if (digits.size() > always_held && digits != significant_digits(text_of(value)))
            throw error_of(element, "must have at most 34 digits, the precision of quad; it has {}", digits.size());
        return value;
    }

    /// `other` = the key that gives the count.
    template <class Number>
    void read_array(const toml::node& node, std::span<Number> into, std::string_view other = "") const {
        const auto& array = *node.as_array();
        if (array.size() != into.size()) {
            const auto length = error("must have {} number{}, {}; it has {}: {}", into.size(),
                                      into.size() == 1 ? "" : "s", field_.each, array.size(), shown(node));
            throw other.empty() ? length : length.with(table_.beside(other));
        }
        for (std::size_t i = 0; i < into.size(); ++i) into[i] = number(*array.get(i), {i}, into[i]);
        for (std::size_t i = 0; i < into.size(); ++i) check(into[i], {i});
    }
    std::array<double, 2> two_numbers(const toml::node& node) const {
        if (!node.is_array()) throw error("must be an array of 2 numbers, {}; {}", field_.each, found(node));
        std::array<double, 2> pair{};
        read_array(node, std::span<double>(pair));
        return pair;
    }
    void read_whole_pair(const toml::node& node, std::string_view what, int& first, int& second) const {
        const auto pair = ValueReader(table_, {.key = field_.key, .each = field_.each}).two_numbers(node);
        const auto& [low, high] = std::pair(field_.bounds.low, field_.bounds.high);
        for (const double number : pair)
            if (number != std::floor(number) || number < low || number > high)
                throw error("must be {} from {} to {}; it is [{}, {}]", what, low, high, pair[0], pair[1]);
        first = static_cast<int>(pair[0]);
        second = static_cast<int>(pair[1]);
    }
    const toml::array& some_of(const toml::node& node, std::string_view what) const {
        const auto* array = node.as_array();
        if (!array || array->empty() || array->size() > field_.maximum)
            throw error("must be an array of 1 to {} {}; {}", field_.maximum, what, found(node));
        return *array;
    }
    std::vector<std::string> texts_in(const toml::node& node) const {
        if (const auto* text = node.as_string(); text && is_typed(node)) return {text->get()};
        const auto* array = node.as_array();
        if (!array) throw error("must be an array of strings; {}", found(node));
        std::vector<std::string> texts;
        for (const auto& element : *array) {
            if (!element.is_string())
                throw error("must be an array of strings; {} is {}", shown(element), kind_of(element));
            texts.push_back(element.as_string()->get());
        }
        if (field_.is_drawn && texts.size() > max_texts)
            throw error("must be at most {} texts; they are {}", max_texts, texts.size());
        return texts;
    }

    const TomlReader& table_;
    const Field& field_;
};

}  // namespace

bool is_typed(const toml::node& node) {
    const auto& origin = node.source().path;
    return origin && origin->starts_with("--");
}

std::string significant_digits(std::string_view decimal) {
    std::string digits;
    for (const char c : decimal.substr(0, decimal.find_first_of("eE")))
        if (c >= '0' && c <= '9' && !(c == '0' && digits.empty())) digits += c;
    while (digits.ends_with('0')) digits.pop_back();
    return digits;
}

void TomlReader::key(const Field& field, const KeyMember& member) {
    const auto elements = elements_of(field.key);
    for (const auto& [key, element] : elements) known_.emplace(key);
    const auto read = [&]<class M>(M into) {
        constexpr bool is_choice = std::is_same_v<M, ChosenName>;
        const bool does_count = counts(field);
        const auto* node = does_count ? find(field.key) : nullptr;
        const auto value_of_node = [&](auto value) {
            ValueReader(*this, field).read(*node, value);
            return value;
        };
        if constexpr (is_choice) {
            std::string name(into.name);
            if (node) ValueReader(*this, {.key = field.key, .names = into.names}).read(*node, name);
            into.choose(static_cast<std::size_t>(std::ranges::find(into.names, name) - into.names.begin()));
        } else if constexpr (is_optional<std::remove_pointer_t<M>>) {
            if (!does_count) into->reset();
            if (node) *into = value_of_node(typename std::remove_pointer_t<M>::value_type{});
            if (does_count) require(field, into->has_value());
        } else {
            if (node) *into = value_of_node(*into);
            if constexpr (requires { into->empty(); })
                if (does_count) require(field, !into->empty());
        }
        for (const auto& [key, element] : elements) {
            auto one = field;
            one.key = key;
            if constexpr (is_choice)
                throw error(key, "is not an element of a list of numbers");
            else
                ValueReader(*this, one).read_element(*find(key), element, *into);
        }
    };
    try {
        std::visit(read, member);
    } catch (KeyError& error) {
        if (!errors_) throw;
        error.key = field.key;                       // without an element's index
        if (name_.empty()) error.group = field.key;  // errors in a title are independent of the tables
        errors_->add(error);
    }
}

}  // namespace doppel
