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

/// Visits lists of fields (scene/preset_fields.hpp) and keeps what they hold.
class KeyCollector {
public:
    explicit KeyCollector(std::vector<SideKey>& all) : all_(all) {}

    template <class T>
    void operator()(const Field& field, const T& value) {
        if (!field.only.holds && !field.only.fault.empty()) return;
        if constexpr (is_optional<T>) {
            if (value) (*this)(field, *value);
        } else if constexpr (std::is_same_v<T, EndSpec>) {
            std::visit([&](const auto& end) { (*this)(field, end); }, value);
        } else {
            SideKey key{.place = place_, .key = field.key, .unit = field.unit, .is_of_part = is_part_};
            if constexpr (std::is_same_v<T, Quad>)
                key.numbers = {value};
            else if constexpr (std::is_same_v<T, QuadPair> || std::is_same_v<T, std::vector<Quad>>)
                key.numbers.assign(value.begin(), value.end());
            else
                key.text = toml_value(value);
            all_.push_back(std::move(key));
        }
    }
    template <class Visit>
    void table(std::string_view key, const Visit& visit) {
        place_ = key;
        visit(*this);
        place_.clear();
    }
    static bool from_command_line(std::string_view) { return false; }

    /// visit(collector) visits the fields of an entry.
    template <class Visit>
    void entry(const std::string& place, bool is_part, const Visit& visit) {
        all_.push_back({.place = place, .key = "", .unit = "", .is_of_part = is_part});
        place_ = place;
        is_part_ = is_part;
        visit(*this);
        place_.clear();
        is_part_ = false;
    }

private:
    std::vector<SideKey>& all_;
    std::string place_;
    bool is_part_ = false;
};

/// Entries of a kind by their names, or by their numbers.
class EntryNames {
public:
    std::string next(std::string_view kind, const std::string& name) {
        const int number = ++counts_[std::string(kind)];
        return name.empty() ? fmt::format("{} {}", kind, number) : fmt::format("{} \"{}\"", kind, name);
    }

private:
    std::map<std::string, int> counts_;
};

std::vector<SideKey> keys_of(const SideSpec& side) {
    std::vector<SideKey> all;
    KeyCollector collect(all);
    EntryNames names;
    auto complete = side;
    complete.step_s = side.step();
    complete.tolerance = side.allowed_error();
    const auto& spec = complete;
    side_fields(collect, spec);
    for_each_entry(spec,
                   [&](std::string_view table, std::string_view kind, const std::string& name, const auto& fields) {
                       const bool is_part = (table == "constraint" || table == "force") && kind != "droplet";
                       collect.entry(names.next(kind, name), is_part, fields);
                   });
    return all;
}

bool hold_the_same(const SideKey& one, const SideKey& other) {
    return one.numbers == other.numbers && one.text == other.text;
}

}  // namespace

std::string words_of_key(std::string_view key) {
    constexpr std::array<std::string_view, 16> units{
        "_m3_per_kg_s2", "_N_s2_per_m2", "_N_s_per_m", "_deg_per_s", "_m_per_s2", "_N_per_m", "_m_per_s", "_per_s",
        "_N_m_s2",       "_N_m_s",       "_N_m",       "_kg_m2",     "_deg",      "_kg",      "_hz",      "_m"};
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
    const auto twin_of = [](const SideKey& key, const Index& others) -> std::optional<SideKey> {
        const auto twin = others.find(Name(key.place, key.key));
        return twin == others.end() ? std::nullopt : std::optional(*twin->second);
    };
    // where the other side lacks the entry, its keys are not told one by one
    const auto is_of_entry = [](const SideKey& key, const Index& others) {
        return !key.place.empty() && !key.key.empty() && !others.contains(Name(key.place, ""));
    };
    for (const auto& key : of_a) {
        const auto twin = twin_of(key, in_b);
        if (twin ? !hold_the_same(key, *twin) : !is_of_entry(key, in_b)) all.push_back({key, twin});
    }
    for (const auto& key : of_b)
        if (!twin_of(key, in_a) && !is_of_entry(key, in_a)) all.push_back({std::nullopt, key});
    return all;
}

std::string KeyDifference::words(bool of_b) const {
    const auto &self = of_b ? b : a, &other = of_b ? a : b;
    const auto& known = any();
    if (known.key.empty()) return fmt::format("{} {}", self ? "with" : "no", known.place);
    const auto name = fmt::format("{}{}{}", known.place, known.place.empty() ? "" : " ", words_of_key(known.key));
    if (!self) return fmt::format("no {}", name);
    if (self->numbers.empty()) return fmt::format("{} {}", name, self->text);
    const auto unit = fmt::format("{}{}", known.unit.empty() ? "" : " ", known.unit);
    // of a long list, the first number in which the sides differ
    constexpr std::size_t most_listed = 3;
    const auto& numbers = self->numbers;
    if (numbers.size() > most_listed && other && other->numbers.size() == numbers.size()) {
        const auto at = std::mismatch(numbers.begin(), numbers.end(), other->numbers.begin()).first;
        return fmt::format("{}[{}] {}{}", name, at - numbers.begin(), text_of(*at), unit);
    }
    std::vector<std::string> texts;
    for (const auto& number : numbers) texts.push_back(text_of(number));
    if (texts.size() > most_listed) {
        texts.resize(most_listed);
        texts.emplace_back("…");
    }
    return fmt::format("{} {}{}", name, fmt::join(texts, "/"), unit);
}

}  // namespace doppel
