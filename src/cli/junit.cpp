#include "base/embedded.hpp"
#include "base/text.hpp"
#include "cli/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace doppel {
namespace {

/// What a picture that does not pass has within its test case.
std::string fault(const ComparedPicture& picture) {
    const auto& verdict = picture.verdict;
    const auto element = [&](std::string_view tag, std::string_view type, const std::string& more) {
        return fmt::format("      <{0} message=\"{1}\" type=\"{2}\">{1}{3}</{0}>\n", tag, markup(picture.message), type,
                           markup(more));
    };
    if (picture.match == Match::unreadable) return element("error", "unreadable", "");
    if (picture.match == Match::missing) return element("failure", "missing", "");
    if (picture.size != picture.actual_size) return element("failure", "size", "");
    return element("failure", "differs",
                   fmt::format(" (differing pixels {}, by more than 3/255 {}, largest difference {}/255, worst tile "
                               "{:.3f}/255, mean of red {:+.4f}, green {:+.4f}, blue {:+.4f}, opacity {:+.4f})",
                               verdict.differing, verdict.strong, verdict.largest, verdict.worst_tile, verdict.mean[0],
                               verdict.mean[1], verdict.mean[2], verdict.mean[3]));
}

}  // namespace

std::string markup(std::string_view text) {
    const std::string line = on_one_line(text);
    std::string result;
    for (std::string_view rest = line; !rest.empty();) {
        const auto before = rest;
        switch (const char32_t character = next_character(rest)) {
            case '&':
                result += "&amp;";
                break;
            case '<':
                result += "&lt;";
                break;
            case '>':
                result += "&gt;";
                break;
            case '"':
                result += "&quot;";
                break;
            case '\'':
                result += "&#39;";
                break;
            default:
                // XML 1.0, 2.2: neither U+FFFE nor U+FFFF
                if ((character & 0xfffe) == 0xfffe)
                    result += "\xef\xbf\xbd";
                else
                    result += before.substr(0, before.size() - rest.size());
        }
    }
    return result;
}

void write_junit(const FilePlace& place, const Comparison& comparison) {
    double seconds = 0;
    for (const auto& picture : comparison.pictures) seconds += picture.seconds;
    const auto suite = markup(comparison.expected);
    const auto counts =
        fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\" time=\"{:.3f}\"", comparison.pictures.size(),
                    comparison.count(Match::differs) + comparison.count(Match::missing),
                    comparison.count(Match::unreadable), seconds);
    OutputFile file(place);
    file.write("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- Doppel compare -->\n");
    file.write(fmt::format("<testsuites name=\"doppel compare\" {0}>\n  <testsuite name=\"{1}\" {0} skipped=\"0\">\n",
                           counts, suite));
    file.write(fmt::format(
        "    <properties>\n      <property name=\"expected\" value=\"{}\"/>\n"
        "      <property name=\"actual\" value=\"{}\"/>\n      <property name=\"doppel\" value=\"{} ({})\"/>\n"
        "    </properties>\n",
        suite, markup(comparison.actual), version(), revision()));
    for (const auto& picture : comparison.pictures) {
        file.write(fmt::format("    <testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\"", suite,
                               markup(picture.name), picture.seconds));
        file.write(picture.match == Match::passes ? "/>\n" : ">\n" + fault(picture) + "    </testcase>\n");
    }
    file.write("  </testsuite>\n</testsuites>\n");
    file.close();
}

}  // namespace doppel
