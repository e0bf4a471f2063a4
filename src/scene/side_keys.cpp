#include "scene/side_keys.hpp"

#include "scene/preset_fields.hpp"
#include "scene/resolved.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace doppel {
namespace {

std::vector<SideKey> keys_of(SideSpec side) {
    side.step_s = side.step();
    side.tolerance = side.allowed_error();
    std::vector<SideKey> all;
    std::map<std::string_view, int> counts;  // entries of each kind
    int entry = 0;
    std::string place;
    for_each_key(side, [&](const SideEntry& owner, const Field& field, const KeyMember& member) {
        const bool is_part = (owner.table == "constraint" || owner.table == "force") && owner.kind != "droplet";
        if (owner.number == 0) {
            place = owner.table;
        } else if (owner.number != entry) {
            entry = owner.number;
            const int number = ++counts[owner.kind];
            place = owner.name.empty() ? fmt::format("{} {}", owner.kind, number)
                                       : fmt::format("{} \"{}\"", owner.kind, owner.name);
            all.push_back({.place = place, .key = "", .unit = "", .is_of_part = is_part});
        }
        if (!field.only.applies && !field.only.error.empty()) return;
        SideKey key{.place = place,
                    .key = field.key,
                    .unit = field.unit,
                    .caption = caption_of(field),
                    .counts = field.only.applies,
                    .is_of_links = !field.each.empty() && field.symbol.empty() && place.empty(),
                    .is_of_part = is_part};
        if (const auto numbers = numbers_of(member)) key.numbers.assign(numbers->begin(), numbers->end());
        if (key.numbers.empty()) key.text = toml_value(member);
        if (!key.numbers.empty() || !key.text.empty()) all.push_back(std::move(key));
    });
    return all;
}

bool have_equal_values(const SideKey& one, const SideKey& other) {
    return one.numbers == other.numbers && one.text == other.text;
}

}  // namespace

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
    constexpr std::array<std::string_view, 16> units{
        "_m3_per_kg_s2", "_N_s2_per_m2", "_N_s_per_m", "_deg_per_s", "_m_per_s2", "_N_per_m", "_m_per_s", "_per_s",
        "_N_m_s2",       "_N_m_s",       "_N_m",       "_kg_m2",     "_deg",      "_kg",      "_hz",      "_m"};
    auto key = field.key;
    for (const auto unit : units)
        if (key.ends_with(unit)) {
            key.remove_suffix(unit.size());
            break;
        }
    std::string words(key.ends_with("_s") ? key.substr(0, key.size() - 2) : key);
    std::replace(words.begin(), words.end(), '_', ' ');
    return words;
}

std::string SideKey::name() const {
    return fmt::format("{}{}{}", place, place.empty() || key.empty() ? "" : " ", key);
}

std::vector<KeyDifference> differing_keys(const SideSpec& a, const SideSpec& b) {
    using Name = std::pair<std::string_view, std::string_view>;  // place and key
    using Index = std::map<Name, const SideKey*>;
    const auto of_a = keys_of(a), of_b = keys_of(b);
    const auto index_of = [](const std::vector<SideKey>& keys) {
        Index index;
        for (const auto& key : keys) index.emplace(Name(key.place, key.key), &key);
        return index;
    };
    const auto in_a = index_of(of_a), in_b = index_of(of_b);
    std::vector<KeyDifference> all;
    const auto counterpart_of = [](const SideKey& key, const Index& others) -> std::optional<SideKey> {
        const auto other = others.find(Name(key.place, key.key));
        return other == others.end() ? std::nullopt : std::optional(*other->second);
    };
    // if the other side lacks the entry, its keys are not listed one by one
    const auto is_of_entry = [](const SideKey& key, const Index& others) {
        return !key.place.empty() && !key.key.empty() && !others.contains(Name(key.place, ""));
    };
    for (const auto& key : of_a) {
        const auto other = counterpart_of(key, in_b);
        if (other ? !have_equal_values(key, *other) : !is_of_entry(key, in_b)) all.push_back({key, other});
    }
    for (const auto& key : of_b)
        if (!counterpart_of(key, in_a) && !is_of_entry(key, in_a)) all.push_back({std::nullopt, key});
    return all;
}

std::string KeyDifference::words(bool of_b) const {
    const auto &self = of_b ? b : a, &other = of_b ? a : b;
    const auto& known = any();
    if (known.key.empty()) return fmt::format("{} {}", self ? "with" : "no", known.place);
    const auto name = fmt::format("{}{}{}", known.place, known.place.empty() ? "" : " ", known.caption);
    if (!self || !self->counts) return fmt::format("no {}", name);
    if (self->numbers.empty()) return fmt::format("{} {}", name, self->text);
    const auto unit = fmt::format("{}{}", known.unit.empty() ? "" : " ", known.unit);
    // in longer lists, only the first number in which the sides differ is shown
    constexpr std::size_t max_listed = 3;
    const auto& numbers = self->numbers;
    if (numbers.size() > max_listed && other && other->numbers.size() == numbers.size()) {
        const auto at = std::mismatch(numbers.begin(), numbers.end(), other->numbers.begin()).first;
        const auto number = at - numbers.begin();
        const auto which = known.is_of_links ? fmt::format(" of link {}", number + 1) : fmt::format("[{}]", number);
        return fmt::format("{}{} {}{}", name, which, text_of(*at), unit);
    }
    std::vector<std::string> texts;
    for (const auto& number : numbers) texts.push_back(text_of(number));
    if (texts.size() > max_listed) {
        texts.resize(max_listed);
        texts.emplace_back("…");
    }
    return fmt::format("{} {}{}", name, fmt::join(texts, "/"), unit);
}

}  // namespace doppel
