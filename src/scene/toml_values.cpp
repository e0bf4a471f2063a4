#include "base/text.hpp"
#include "scene/resolved.hpp"
#include "scene/toml_reader.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

std::string listed(std::span<const std::string_view> choices) {
    std::string text;
    for (std::size_t i = 0; i < choices.size(); ++i)
        text += fmt::format("{}\"{}\"", i == 0 ? "" : i + 1 == choices.size() ? " or " : ", ", choices[i]);
    return text;
}

/// Reads the value of a key, or one of its elements, into a member, by the member's type.
class ValueReader {
public:
    /// `at` = the place of an element, "[1]".
    ValueReader(const TomlReader& table, const Field& field, std::string at = "")
        : table_(table), field_(field), at_(std::move(at)) {}

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

    void read(const toml::node& node, double& into) const {
        into = rounded(node);
        check(into);
    }
    void read(const toml::node& node, Quad& into) const {
        into = exact(node);
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
            const Quad decimal = exact(node);
            value = rational_from_decimal(static_cast<double>(decimal));
            const Quad rounding = parse_quad("1e-32") * abs(decimal);
            if (value && abs(Quad(value->as<Quad>() - decimal)) > rounding) value.reset();
        }
        if (!value) throw error("is no fraction of whole numbers up to 9.2e18; it is {}", shown(node));
        const bool is_open = field_.bounds.is_open;
        if (value->numerator < (is_open ? 1 : 0))
            throw error("must be {} 0; it is {}", is_open ? ">" : "≥", shown(node));
        check(value->value());
        into = *value;
    }

    /// 1 to `maximum` numbers; one needs no brackets.
    void read(const toml::node& node, std::vector<double>& into) const {
        if (node.is_number()) {
            into.resize(1);
            return read(node, into[0]);
        }
        into.resize(some_of(node, "numbers").size());
        read_array(node, into, "numbers");
    }

    /// One number for all, or as many as the member already has: other keys give the count. If the field has a
    /// `maximum`, 1 to so many.
    void read(const toml::node& node, std::vector<Quad>& into) const {
        if (field_.maximum > 0) into.resize(node.is_array() ? some_of(node, "numbers").size() : 1);
        const auto count = fmt::format("{} number{}, {}", into.size(), into.size() == 1 ? "" : "s", field_.each);
        if (node.is_array()) return read_array(node, into, count, "links");
        if (!node.is_number()) throw error("must be a number, or an array of {}; {}", count, found(node));
        at(0).read(node, into[0]);
        std::fill(into.begin(), into.end(), into[0]);
    }

    void read(const toml::node& node, QuadPair& into) const { read_array(node, into, "2 numbers, x and y"); }

    void read(const toml::node& node, EndSpec& into) const {
        if (node.is_string())
            read(node, into.emplace<std::string>());
        else
            read(node, into.emplace<QuadPair>());
    }

    void read(const toml::node& node, std::array<int, 2>& into) const {
        read_array(node, into, fmt::format("2 whole numbers, {}", field_.each));
    }
    void read(const toml::node& node, Size& into) const {
        std::array<int, 2> size{};
        read(node, size);
        into = {size[0], size[1]};
    }

    /// For bounds > 0, a logarithmic axis.
    void read(const toml::node& node, Range& into) const {
        std::array<double, 2> range{};
        read_array(node, range, "2 numbers, lowest and highest");
        const auto [low, high] = range;
        if (field_.bounds.is_open && (!(high >= 10 * low) || high / low > 1e60))
            throw error("must increase by 1 to 60 powers of ten; it is [{}, {}]", low, high);
        if (!(high > low) || !std::isfinite(high - low)) throw error("must increase; it is [{}, {}]", low, high);
        into = {low, high};
    }

    void read(const toml::node& node, std::vector<std::string>& into) const {
        into.clear();
        if (node.is_string()) return read(node, into.emplace_back());
        const auto* array = node.as_array();
        if (!array) throw error("must be an array of strings; {}", found(node));
        if (field_.is_drawn && array->size() > max_texts)
            throw error("must be at most {} texts; they are {}", max_texts, array->size());
        into.resize(array->size());
        read_array(node, into, "strings");
    }

    void read(const toml::node& node, ChosenText& into) const {
        into = {};
        if (node.is_boolean()) return read(node, into.shown);
        if (!node.is_array() && !node.is_string())
            throw error("must be true, false, text or a list of text; {}", found(node));
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
            read(node, element == 0 ? into.width : into.height);
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
            else if (release.is_array() || release.is_number())
                ValueReader(table_, numbers_of_release(field_.key, angle_bounds), fmt::format("[{}]", k))
                    .read(release, member.angle_deg);
            else
                refuse(fmt::format("{} is {}", shown(release), kind_of(release)));
        }
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

    void read(const toml::node& node, Color& into) const {
        const auto* text = node.as_string();
        const auto color = text ? parse_color(text->get()) : std::nullopt;
        if (!color) throw error("must be a colour such as \"#ff9f40\"; {}", found(node));
        into = *color;
    }
    void read(const toml::node& node, std::array<Color, 2>& into) const {
        read_array(node, into, "2 colours, a and b");
    }

    void read(const toml::node& node, Panels& into) const {
        std::vector<std::string> panels;
        read(node, panels);
        if (panels.empty()) throw error("must contain at least one of {}", listed(field_.names));
        into = {false, {}};
        for (const auto& panel : panels) {
            const auto kind = value_named<StripKind>(panel);
            if (panel == "pendulums")
                into.pendulums = true;
            else if (std::ranges::find(into.strips, kind) == into.strips.end())
                into.strips.push_back(kind);
        }
    }

private:
    ValueReader at(std::size_t i) const { return {table_, field_, fmt::format("{}[{}]", at_, i)}; }

    template <class... Args>
    KeyError error(fmt::format_string<Args...> format, Args&&... args) const {
        return table_.error_at(field_.key, fmt::format("{}{} {}", table_.subject(field_.key), at_,
                                                       fmt::format(format, std::forward<Args>(args)...)));
    }

    std::string text_in(const toml::node& value) const {
        return value.is_number() ? text_of(exact(value)) : written(value);
    }

    template <class Number>
    void check(const Number& value) const {
        // keys usually contain the unit
        const auto range = missed_range(field_.bounds, value, field_.key.ends_with(field_.unit) ? "" : field_.unit);
        if (!range) return;
        const auto wrong = error("must be {}; it is {}", *range, toml_value(value));
        // together with other keys, if the key would accept the number without them
        const auto& widest = field_.otherwise;
        throw widest && value >= widest->low && value <= widest->high ? wrong.with(table_.beside(field_.only.beside))
                                                                      : wrong;
    }

    double rounded(const toml::node& node) const {
        if (!node.is_number()) throw error("must be a number; {}", found(node));
        const double value = node.is_integer() ? static_cast<double>(node.as_integer()->get()) : *node.value<double>();
        if (!std::isfinite(value)) throw error("must be finite; it is {}", value);
        return value + 0.0;  // turns −0 into 0
    }
    /// A number with all written digits.
    Quad exact(const toml::node& node) const {
        const double nearest = rounded(node);
        if (const auto* whole = node.as_integer()) return Quad(whole->get());
        const auto literal = literal_of(node, table_.texts());
        if (!literal) return Quad(nearest);
        const Quad value = parse_quad(*literal) + 0;
        // the literal must equal the number that was read; otherwise its place is wrong
        constexpr double rounding = 1e-15, minimum = 1e-322;
        if (!(std::abs(static_cast<double>(value) - nearest) <= rounding * std::abs(nearest) + minimum))
            throw error("has digits that cannot be found in the text; it is {}", nearest);
        constexpr std::size_t always_held = 33;
        if (literal->size() <= always_held) return value;
        const auto digits = significant_digits(*literal);
        if (digits.size() > always_held && digits != significant_digits(text_of(value)))
            throw error("must have at most 34 digits, the precision of quad; it has {}", digits.size());
        return value;
    }

    /// `what` = number and meaning of the elements; `other` = the key that gives their number
    template <class Array>
    void read_array(const toml::node& node, Array& into, std::string_view what, std::string_view other = "") const {
        const auto* array = node.as_array();
        if (!array) throw error("must be an array of {}; {}", what, found(node));
        if (array->size() != into.size()) {
            const auto length = error("must have {}; it has {}: {}", what, array->size(), shown(node));
            throw other.empty() ? length : length.with(table_.beside(other));
        }
        for (std::size_t i = 0; i < into.size(); ++i) at(i).read(*array->get(i), into[i]);
    }
    const toml::array& some_of(const toml::node& node, std::string_view what) const {
        const auto* array = node.as_array();
        if (!array || array->empty() || array->size() > field_.maximum)
            throw error("must be an array of 1 to {} {}; {}", field_.maximum, what, found(node));
        return *array;
    }

    static Field numbers_of_release(std::string_view key, const Bounds& bounds) {
        constexpr std::size_t max_links = 10'000;
        return {.key = key, .bounds = bounds, .maximum = max_links};
    }
    void read_release(const toml::table& table, std::size_t k, Release& member) const {
        auto keys = table_.inner(&table, fmt::format("{}[{}]", table_.subject(field_.key), k));
        for (const auto& list : Release::lists)
            keys(numbers_of_release(list.key, list.key == "angle_deg" ? angle_bounds : positive), member.*list.member);
        keys({.key = "color"}, member.color);
        keys.finish();
    }

    const TomlReader& table_;
    const Field& field_;
    std::string at_;
};

}  // namespace

bool is_typed(const toml::node& node) {
    const auto& origin = node.source().path;
    return origin && origin->starts_with("--");
}

std::optional<std::string> missed_range(const Bounds& bounds, const Quad& number, std::string_view unit) {
    const auto& [low, high, is_open, zero, why] = bounds;
    if ((is_open ? number > low : number >= low) && number <= high) return std::nullopt;
    if (is_open && !(number > low)) return fmt::format("> {}", low);
    const auto highest = fmt::format("{}{}{}", high, unit.empty() ? "" : " ", unit);
    if (is_open) return "at most " + highest;
    if (!bounds.has_high()) return fmt::format("≥ {}", low);
    return fmt::format("from {}{} to {}{}", low, zero.empty() ? "" : fmt::format(" ({})", zero), highest,
                       why.empty() ? "" : fmt::format(": {}", why));
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
