#pragma once

#include <cctype>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
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

/// A strict parser of the XML that Doppel writes: elements, attributes, comments, the five entities and &#39;. Throws
/// std::runtime_error with the position of the byte where the text is not well-formed.
class XmlReader {
public:
    explicit XmlReader(std::string_view text) : text_(text) {
        for (const char c : text)
            if (static_cast<unsigned char>(c) < 0x20 && c != '\n') fail("a control character");
    }

    Element document() {
        skip_misc();
        Element root = element();
        skip_misc();
        if (at_ != text_.size()) fail("something after the last tag");
        return root;
    }

private:
    [[noreturn]] void fail(const std::string& what) const {
        throw std::runtime_error(what + " at byte " + std::to_string(at_));
    }
    bool is_next(std::string_view words) const { return text_.substr(at_).starts_with(words); }
    void expect(std::string_view words) {
        if (!is_next(words)) fail("not \"" + std::string(words) + "\"");
        at_ += words.size();
    }
    std::string_view until(std::string_view end) {
        const auto stop = text_.find(end, at_);
        if (stop == std::string_view::npos) fail("no \"" + std::string(end) + "\"");
        const auto passed = text_.substr(at_, stop - at_);
        at_ = stop + end.size();
        return passed;
    }
    void skip_space() {
        while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n')) ++at_;
    }
    void skip_misc() {
        for (skip_space(); is_next("<?") || is_next("<!"); skip_space())
            until(is_next("<!--") ? "-->" : is_next("<?") ? "?>" : ">");
    }
    std::string word() {
        const auto start = at_;
        while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) || text_[at_] == '-')) ++at_;
        if (at_ == start) fail("no name");
        return std::string(text_.substr(start, at_ - start));
    }
    std::string plain(std::string_view escaped) const {
        static const std::map<std::string, char, std::less<>> entities{{"amp", '&'},  {"lt", '<'},    {"gt", '>'},
                                                                       {"quot", '"'}, {"apos", '\''}, {"#39", '\''}};
        std::string result;
        while (!escaped.empty()) {
            if (escaped[0] == '<') fail("a bare <");
            if (escaped[0] != '&') {
                result += escaped[0];
                escaped.remove_prefix(1);
                continue;
            }
            const auto end = escaped.find(';');
            const auto entity = entities.find(escaped.substr(1, end - 1));
            if (end == std::string_view::npos || entity == entities.end()) fail("a bare &");
            result += entity->second;
            escaped.remove_prefix(end + 1);
        }
        return result;
    }
    Element element() {
        expect("<");
        Element result{word(), {}, {}, {}};
        for (skip_space(); !is_next(">") && !is_next("/>"); skip_space()) {
            const auto name = word();
            expect("=\"");
            if (!result.attributes.emplace(name, plain(until("\""))).second) fail(name + " twice");
        }
        if (is_next("/>")) return expect("/>"), result;
        expect(">");
        while (!is_next("</")) {
            if (is_next("<!--"))
                until("-->");
            else if (is_next("<"))
                result.children.push_back(element());
            else
                result.text += plain(until("<")), --at_;
        }
        expect("</" + result.name + ">");
        return result;
    }

    std::string_view text_;
    std::size_t at_ = 0;
};

}  // namespace doppel::test
