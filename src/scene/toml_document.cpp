#include "scene/toml_document.hpp"

#include <utility>

namespace doppel {
namespace {

toml::table parse(const std::string& text, const std::string& path, TomlTexts& texts) {
    try {
        texts[path] = text;
        return toml::parse(text, path);
    } catch (const toml::parse_error& fault) {
        const auto at = fault.source().begin;
        throw bad_input("{}:{}:{}: {}", path, at.line, at.column, fault.description());
    }
}

/// Puts the value of `change` into the tables of `root`, in place of what is there.
void apply(toml::table& root, const Override& change, TomlTexts& texts) {
    auto dot = change.key.find('.');
    toml::table* table = &root;
    std::string key = change.key;
    for (; dot != std::string::npos; dot = key.find('.')) {
        const auto head = key.substr(0, dot);
        if (!table->contains(head)) table->insert(head, toml::table{});
        table = table->get_as<toml::table>(head);
        if (!table) throw bad_input("{}: \"{}\" is no table", change.origin, head);
        key = key.substr(dot + 1);
    }
    toml::table given;
    try {
        auto& text = texts[change.origin] = "value = " + change.value;
        given = toml::parse(text, change.origin);
    } catch (const toml::parse_error& fault) {
        throw bad_input("{}: \"{}\" is no TOML value ({}); strings want quotes: '{}=\"{}\"'", change.origin,
                        change.value, fault.description(), change.key, change.value);
    }
    if (given.size() != 1) throw bad_input("{}: \"{}\" is more than one value", change.origin, change.value);
    // moved, not copied: a copy would forget where it comes from
    std::move(*given.get("value")).visit([&]<class Node>(Node&& node) {
        table->erase(key);
        table->insert(key, std::forward<Node>(node));
    });
}

void apply(toml::table& root, const std::vector<Override>& overrides, TomlTexts& texts) {
    for (std::size_t i = 0; i < overrides.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j)
            if (overrides[i].key == overrides[j].key)
                throw bad_input("{} is given twice: {} and {}", overrides[i].key, overrides[j].origin,
                                overrides[i].origin);
        apply(root, overrides[i], texts);
    }
}

}  // namespace

TomlDocument parse_document(const PresetText& source, const std::vector<Override>& overrides) {
    TomlDocument document{.path = source.path, .root = {}, .texts = {}};
    document.root = parse(source.text, source.path, document.texts);
    apply(document.root, overrides, document.texts);
    return document;
}

Override parse_set(const std::string& argument) {
    const auto equals = argument.find('=');
    const auto key = argument.substr(0, equals);
    if (equals == std::string::npos || key.empty() || key.starts_with('.') || key.ends_with('.') ||
        key.find("..") != std::string::npos)
        throw bad_input("--set wants table.key=VALUE; it is \"{}\"", argument);
    return {key, argument.substr(equals + 1), "--set " + key};
}

}  // namespace doppel
