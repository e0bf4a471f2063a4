#include "scene/side_keys.hpp"

#include "scene/preset_fields.hpp"
#include "scene/resolved.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <iterator>
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
    constexpr auto units = std::to_array<std::string_view>({"N", "deg", "hz", "kg", "m", "m2", "m3", "per", "s", "s2"});
    std::string words(field.key);
    for (auto last = words.rfind('_'); last != std::string::npos; last = words.rfind('_')) {
        if (std::ranges::find(units, std::string_view(words).substr(last + 1)) == units.end()) break;
        words.resize(last);
    }
    std::replace(words.begin(), words.end(), '_', ' ');
    return words;
}

std::vector<KeyDifference> differing_keys(const SideSpec& a, const SideSpec& b) {
    std::vector<KeyDifference> all;
    std::map<std::string, std::size_t> indices;  // of names
    for (auto& key : keys_of(a)) {
        indices.emplace(key.name(), all.size());
        all.push_back({std::move(key), std::nullopt});
    }
    for (auto& key : keys_of(b)) {
        const auto [index, is_new] = indices.emplace(key.name(), all.size());
        if (is_new)
            all.push_back({std::nullopt, std::move(key)});
        else
            all[index->second].b = std::move(key);
    }
    // of an entry that only one side has, the keys are not listed one by one
    const auto is_listed = [&](const KeyDifference& one) {
        if (one.a && one.b) return one.a->numbers != one.b->numbers || one.a->text != one.b->text;
        const auto& key = one.any();
        if (key.place.empty() || key.key.empty()) return true;
        const auto entry = indices.find(key.place);
        return entry != indices.end() && all[entry->second].a && all[entry->second].b;
    };
    std::vector<KeyDifference> differing;
    std::ranges::copy_if(all, std::back_inserter(differing), is_listed);
    return differing;
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
