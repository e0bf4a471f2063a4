#include "cli/comparison.hpp"

#include "base/embedded.hpp"
#include "base/read_file.hpp"
#include "base/text.hpp"
#include "embedded/cli.hpp"
#include "output/files.hpp"
#include "output/page.hpp"
#include "output/png.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <string_view>

namespace doppel {

long Comparison::count(Match match) const {
    return std::ranges::count(pictures, match, &ComparedPicture::match);
}

std::string Comparison::summary() const {
    return fmt::format("{} of {} pictures differ", count(Match::differs) + count(Match::missing), pictures.size());
}

namespace {

/// The element of a picture that does not pass, inside its test case.
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

void write_junit(const std::filesystem::path& place, const Comparison& comparison) {
    double seconds = 0;
    for (const auto& picture : comparison.pictures) seconds += picture.seconds;
    const auto suite = markup(comparison.expected);
    const auto counts =
        fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\" time=\"{:.3f}\"", comparison.pictures.size(),
                    comparison.count(Match::differs) + comparison.count(Match::missing),
                    comparison.count(Match::unreadable), seconds);
    auto xml = fmt::format(
        "{0}\n<testsuites name=\"doppel compare\" {1}>\n  <testsuite name=\"{2}\" {1} skipped=\"0\">\n"
        "    <properties>\n      <property name=\"expected\" value=\"{2}\"/>\n"
        "      <property name=\"actual\" value=\"{3}\"/>\n      <property name=\"doppel\" value=\"{4} ({5})\"/>\n"
        "    </properties>\n",
        junit_start, counts, suite, markup(comparison.actual), version(), revision());
    for (const auto& picture : comparison.pictures) {
        xml += fmt::format("    <testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\"", suite, markup(picture.name),
                           picture.seconds);
        const auto inside = picture.match != Match::passes ? fault(picture)
                            : picture.message.empty()
                                ? ""
                                : "      <system-out>" + markup(picture.message) + "</system-out>\n";
        xml += inside.empty() ? "/>\n" : ">\n" + inside + "    </testcase>\n";
    }
    write_file(place, xml + "  </testsuite>\n</testsuites>\n");
}

namespace {

constexpr std::size_t max_bytes = 100'000'000;  // a size that browsers open easily

std::string heading(const Comparison& comparison) {
    const auto all = comparison.pictures.size();
    const long unreadable = comparison.count(Match::unreadable);
    if (comparison.count(Match::passes) == std::ssize(comparison.pictures))
        return all == 1 ? "The picture passes" : fmt::format("All {} pictures pass", all);
    if (all == 1 && comparison.count(Match::differs) == 1) return "The picture differs";
    if (all == 1 && unreadable == 1) return "The picture could not be compared";
    return comparison.summary() + (unreadable > 0 ? fmt::format(", {} could not be compared", unreadable) : "");
}

std::string header(const Comparison& comparison) {
    return fmt::format(
        "<header>\n<p class=\"kind quiet\">Golden comparison</p>\n<h1>{}</h1>\n"
        "<dl><dt>Expected</dt><dd><code>{}</code></dd><dt>Actual</dt><dd><code>{}</code></dd></dl>\n</header>\n",
        markup(heading(comparison)), markup(comparison.expected), markup(comparison.actual));
}

/// The values, and the rules that they violate.
std::string reasons(const ComparedPicture& picture) {
    const auto& [size, actual] = std::pair(picture.size, picture.actual_size);
    if (size != actual)
        return fmt::format("{}×{} px, expected {}×{}", actual.width, actual.height, size.width, size.height);
    const double pixels = static_cast<double>(size.width) * size.height;
    return fmt::format("{} of {:.0f} pixels differ ({:.3g} %); {}", picture.verdict.differing, pixels,
                       100 * static_cast<double>(picture.verdict.differing) / pixels, markup(picture.verdict.why));
}

std::string figure(std::string_view kind, std::string_view caption, const ComparedPicture& picture, Size size,
                   const std::string& url) {
    return fmt::format(
        "<figure><figcaption>{1}</figcaption><button type=\"button\" aria-expanded=\"false\" title=\"Enlarge\">"
        "<img class=\"{0}\" alt=\"{1}: {2}\" width=\"{3}\" height=\"{4}\" src=\"{5}\"/></button></figure>\n",
        kind, caption, markup(picture.name), size.width, size.height, url);
}

/// A data URL with the unchanged bytes of a file.
std::string url_of(const std::filesystem::path& png) {
    return data_url("image/png", read_whole_file(png, png_file));
}

/// A picture that differs; its pixels are included if `shown`.
std::string section(const ComparedPicture& picture, bool shown) {
    const auto [width, height] = picture.size;
    const bool same_size = picture.size == picture.actual_size;
    std::string html = fmt::format("<section class=\"differs{}{}\">\n<h2>{}</h2>\n<p class=\"why\">{}</p>\n",
                                   width <= 240   ? " small half"
                                   : width <= 480 ? " half"
                                                  : "",
                                   height > width ? " upright" : "", markup(picture.name), reasons(picture));
    if (!shown) return html + "<p class=\"quiet\">Not shown: the page would be too large.</p>\n</section>\n";
    html += fmt::format("<div class=\"three{}\">\n", same_size ? "" : " two");
    html += figure("expected", "Expected", picture, picture.size, url_of(picture.expected));
    html += figure("actual", "Actual", picture, picture.actual_size, url_of(picture.actual));
    if (!same_size) return html + "</div>\n</section>\n";
    const auto difference = amplified_difference(read_png(picture.expected), read_png(picture.actual));
    html += figure("difference", "Difference ×16", picture, picture.size, data_url("image/png", png_bytes(difference)));
    return html + fmt::format(
                      "</div>\n<div class=\"names\" hidden=\"\"><span>Expected</span><span>Actual</span></div>\n"
                      "<div class=\"slider\" hidden=\"\"><input type=\"range\" min=\"0\" max=\"100\" step=\"0.25\" "
                      "value=\"50\" aria-label=\"Expected over actual: {}\"/><i></i></div>\n</section>\n",
                      markup(picture.name));
}

/// Pictures without pixels: those that cannot be compared, with the reason, or those that pass.
std::string list(const Comparison& comparison, bool passing) {
    std::string items;
    for (const auto& picture : comparison.pictures) {
        const bool passes = picture.match == Match::passes;
        if (passes != passing || picture.match == Match::differs) continue;
        const auto& told = passes && !picture.message.empty() ? picture.message : picture.name;
        items += passes ? "<li>" + markup(told) + "</li>\n" : "<li><code>" + markup(picture.message) + "</code></li>\n";
    }
    if (items.empty()) return {};
    if (!passing) return "<section>\n<h2>Missing or not readable</h2>\n<ul>\n" + items + "</ul>\n</section>\n";
    const long count = comparison.count(Match::passes);
    const bool all = count == std::ssize(comparison.pictures);
    return fmt::format("<details{}><summary>{} pass</summary>\n<ul class=\"list\">\n{}</ul>\n</details>\n",
                       all ? " open=\"\"" : "", count, items);
}

}  // namespace

void write_compare_page(const std::filesystem::path& place, const Comparison& comparison) {
    auto body = header(comparison) + "<main>\n" + list(comparison, false);
    for (const auto& picture : comparison.pictures)
        if (picture.match == Match::differs) body += section(picture, body.size() < max_bytes);
    body += list(comparison, true);
    body += fmt::format(
        "</main>\n<footer><p>A picture passes where it differs no more than graphics drivers do: in few "
        "pixels, by little. Doppel {} ({})</p></footer>",
        version(), revision());
    write_file(place, page_text({.kind = "compare",
                                 .title = heading(comparison),
                                 .body = std::move(body),
                                 .styles = {embedded_file(cli_files(), "cli/compare.css")},
                                 .scripts = {embedded_file(cli_files(), "cli/compare.js")}}));
}

}  // namespace doppel
