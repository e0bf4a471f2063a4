#pragma once

#include <expat.h>
#include <fmt/format.h>

#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace doppel::test {

/// An XML element; its text excludes that of its child elements.
struct Element {
    std::string name, text;
    std::map<std::string, std::string> attributes;
    std::vector<Element> children;

    const std::string& operator[](const std::string& attribute) const { return attributes.at(attribute); }

    /// All elements of that name below it, itself included.
    std::vector<const Element*> all(std::string_view wanted) const {
        std::vector<const Element*> found;
        if (name == wanted) found.push_back(this);
        for (const auto& child : children)
            for (const auto* element : child.all(wanted)) found.push_back(element);
        return found;
    }
};

/// The root element. Throws std::runtime_error with the position of the byte where the text is not well-formed XML.
inline Element document_of(const std::string& text) {
    using Elements = std::vector<Element>;
    Elements open(1);  // what contains the root, and the elements that have not ended
    const std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser(XML_ParserCreate("UTF-8"),
                                                                              XML_ParserFree);
    XML_SetUserData(parser.get(), &open);
    XML_SetElementHandler(
        parser.get(),
        [](void* data, const char* name, const char** attributes) {
            auto& element = static_cast<Elements*>(data)->emplace_back();
            element.name = name;
            for (; *attributes; attributes += 2) element.attributes.emplace(attributes[0], attributes[1]);
        },
        [](void* data, const char* /*name*/) {
            auto& elements = *static_cast<Elements*>(data);
            auto ended = std::move(elements.back());
            elements.pop_back();
            elements.back().children.push_back(std::move(ended));
        });
    XML_SetCharacterDataHandler(parser.get(), [](void* data, const char* letters, int count) {
        static_cast<Elements*>(data)->back().text.append(letters, static_cast<std::size_t>(count));
    });
    if (XML_Parse(parser.get(), text.data(), static_cast<int>(text.size()), XML_TRUE) != XML_STATUS_OK)
        throw std::runtime_error(fmt::format("{} at byte {}", XML_ErrorString(XML_GetErrorCode(parser.get())),
                                             XML_GetCurrentByteIndex(parser.get())));
    return open.front().children.at(0);
}

}  // namespace doppel::test
