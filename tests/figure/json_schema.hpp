#pragma once

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <regex>
#include <stdexcept>
#include <string>

namespace doppel::test {

/// A JSON schema of Draft 4: the keywords that Doppel's schema uses, and no others.
class JsonSchema {
public:
    using Json = nlohmann::ordered_json;
    explicit JsonSchema(Json root) : root_(std::move(root)) {}

    bool accepts(const Json& value) const { return accepts(root_, value); }

    /// Throws std::logic_error for a keyword of the schema that is not supported here.
    bool accepts(const Json& schema, const Json& value) const {
        if (schema.contains("$ref"))
            return accepts(root_.at(Json::json_pointer(schema["$ref"].get<std::string>().substr(1))), value);
        for (const auto& [keyword, wanted] : schema.items())
            if (!holds(keyword, wanted, schema, value)) return false;
        return true;
    }

private:
    bool holds(const std::string& keyword, const Json& wanted, const Json& schema, const Json& value) const {
        for (const auto* silent : {"$schema", "definitions", "title", "description", "default", "exclusiveMinimum"})
            if (keyword == silent) return true;
        if (keyword == "type") return has_type(wanted.get<std::string>(), value);
        if (keyword == "enum") return std::find(wanted.begin(), wanted.end(), value) != wanted.end();
        if (keyword == "anyOf")
            return std::any_of(wanted.begin(), wanted.end(), [&](const Json& one) { return accepts(one, value); });
        if (keyword == "minimum") return !value.is_number() || at_least(value, wanted, schema);
        if (keyword == "maximum") return !value.is_number() || value.get<double>() <= wanted.get<double>();
        if (keyword == "multipleOf")
            return !value.is_number() || std::remainder(value.get<double>(), wanted.get<double>()) == 0;
        if (keyword == "minLength") return !value.is_string() || value.get<std::string>().size() >= wanted;
        if (keyword == "maxLength") {  // counts characters
            const auto text = value.is_string() ? value.get<std::string>() : std::string();
            return std::count_if(text.begin(), text.end(), [](char byte) { return (byte & 0xc0) != 0x80; }) <=
                   wanted.get<std::ptrdiff_t>();
        }
        if (keyword == "pattern")
            return !value.is_string() ||
                   std::regex_search(value.get<std::string>(), std::regex(wanted.get<std::string>()));
        if (keyword == "items" && wanted.is_array()) {  // one schema for each position
            for (std::size_t i = 0; value.is_array() && i < std::min(wanted.size(), value.size()); ++i)
                if (!accepts(wanted[i], value[i])) return false;
            return true;
        }
        if (keyword == "additionalItems" && wanted == false)
            return !value.is_array() || value.size() <= schema["items"].size();
        if (keyword == "items")
            return !value.is_array() ||
                   std::all_of(value.begin(), value.end(), [&](const Json& one) { return accepts(wanted, one); });
        if (keyword == "minItems") return !value.is_array() || value.size() >= wanted;
        if (keyword == "maxItems") return !value.is_array() || value.size() <= wanted;
        if (!value.is_object() &&
            (keyword == "required" || keyword == "properties" || keyword == "additionalProperties"))
            return true;
        if (keyword == "required")
            return std::all_of(wanted.begin(), wanted.end(),
                               [&](const Json& key) { return value.contains(key.get<std::string>()); });
        if (keyword == "properties") {
            for (const auto& [key, one] : wanted.items())
                if (value.contains(key) && !accepts(one, value[key])) return false;
            return true;
        }
        if (keyword != "additionalProperties" || wanted != false)
            throw std::logic_error("the validator does not know: " + keyword);
        for (const auto& [key, one] : value.items())
            if (!schema["properties"].contains(key)) return false;
        return true;
    }

    static bool at_least(const Json& value, const Json& minimum, const Json& schema) {
        const double number = value.get<double>(), low = minimum.get<double>();
        return schema.value("exclusiveMinimum", false) ? number > low : number >= low;
    }

    static bool has_type(const std::string& type, const Json& value) {
        if (type == "object") return value.is_object();
        if (type == "array") return value.is_array();
        if (type == "string") return value.is_string();
        if (type == "boolean") return value.is_boolean();
        if (type == "integer") return value.is_number_integer();
        if (type == "number") return value.is_number();
        throw std::logic_error("the validator does not know the type: " + type);
    }

    Json root_;
};

}  // namespace doppel::test
