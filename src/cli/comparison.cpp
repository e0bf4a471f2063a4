#include "cli/comparison.hpp"

#include "base/embedded.hpp"
#include "base/error.hpp"
#include "base/text.hpp"
#include "embedded/cli.hpp"
#include "output/png.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

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

void write_junit(const std::filesystem::path& place, const Comparison& comparison) {
    double seconds = 0;
    for (const auto& picture : comparison.pictures) seconds += picture.seconds;
    const auto suite = markup(comparison.expected);
    const auto counts =
        fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\" time=\"{:.3f}\"", comparison.pictures.size(),
                    comparison.count(Match::differs) + comparison.count(Match::missing),
                    comparison.count(Match::unreadable), seconds);
    OutputFile file(place);
    file.write(junit_start);
    file.write("\n");
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

namespace {

constexpr std::size_t max_bytes = 100'000'000;  // that a browser opens with ease

std::string heading(const Comparison& comparison) {
    const auto all = comparison.pictures.size();
    const long unreadable = comparison.count(Match::unreadable);
    if (comparison.count(Match::passes) == std::ssize(comparison.pictures))
        return all == 1 ? "The picture passes" : fmt::format("All {} pictures pass", all);
    if (all == 1 && comparison.count(Match::differs) == 1) return "The picture differs";
    return comparison.summary() + (unreadable > 0 ? fmt::format(", {} could not be compared", unreadable) : "");
}

/// What is told of all pictures together.
std::string header(const Comparison& comparison) {
    std::string counts;
    const auto count = [&](Match match, std::string_view kind, std::string_view words) {
        const long number = comparison.count(match);
        if (number > 0) counts += fmt::format("<li class=\"{}\"><b>{}</b> {}</li>\n", kind, number, words);
    };
    count(Match::passes, "good", "pass");
    count(Match::differs, "bad", "differ");
    count(Match::missing, "bad", "missing");
    count(Match::unreadable, "bad", "not readable");
    return fmt::format(
        "<header>\n<p class=\"kind\">Golden comparison</p>\n<h1>{}</h1>\n<ul class=\"counts\">\n{}</ul>\n"
        "<dl><dt>Expected</dt><dd><code>{}</code></dd><dt>Actual</dt><dd><code>{}</code></dd></dl>\n</header>\n",
        markup(heading(comparison)), counts, markup(comparison.expected), markup(comparison.actual));
}

/// Links to the pictures that differ, where there are several.
std::string contents(const Comparison& comparison) {
    if (comparison.count(Match::differs) < 2) return {};
    std::string links;
    for (std::size_t i = 0; i < comparison.pictures.size(); ++i)
        if (const auto& picture = comparison.pictures[i]; picture.match == Match::differs)
            links += fmt::format("<li><a href=\"#picture-{}\">{}</a></li>\n", i + 1, markup(picture.name));
    return "<nav aria-label=\"Pictures that differ\"><ul>\n" + links + "</ul></nav>\n";
}

/// The numbers, and the rules that are broken.
std::string reasons(const ComparedPicture& picture) {
    const auto& [size, actual] = std::pair(picture.size, picture.actual_size);
    if (size != actual)
        return fmt::format("<li>{}×{} px, expected {}×{}</li>", actual.width, actual.height, size.width, size.height);
    const double pixels = static_cast<double>(size.width) * size.height;
    auto items = fmt::format("<li>{} of {:.0f} pixels differ ({:.3g} %)</li>", picture.verdict.differing, pixels,
                             100 * static_cast<double>(picture.verdict.differing) / pixels);
    for (std::string_view rest = picture.verdict.why; !rest.empty();) {
        const auto end = std::min(rest.find("; "), rest.size());
        items += "\n<li>" + markup(rest.substr(0, end)) + "</li>";
        rest.remove_prefix(std::min(end + 2, rest.size()));
    }
    return items;
}

/// All of a section at one scale.
std::string figure(std::string_view kind, std::string_view caption, const ComparedPicture& picture, Size size,
                   const std::string& url) {
    return fmt::format(
        "<figure><figcaption>{1}</figcaption><button type=\"button\" aria-expanded=\"false\" title=\"Enlarge\">"
        "<img class=\"{0}\" alt=\"{1}: {2}\" width=\"{3}\" height=\"{4}\" style=\"--part:{6:.4g}\" src=\"{5}\"/>"
        "</button></figure>\n",
        kind, caption, markup(picture.name), size.width, size.height, url,
        1.0 * size.width / std::max(picture.size.width, picture.actual_size.width));
}

/// A picture that differs; `shown` with its pixels.
std::string section(const ComparedPicture& picture, std::size_t number, bool shown) {
    const auto [width, height] = picture.size;
    const bool same_size = picture.size == picture.actual_size;
    std::string html =
        fmt::format("<section class=\"differs{}{}\" id=\"picture-{}\">\n<h2>{}</h2>\n<ul class=\"why\">\n{}\n</ul>\n",
                    width <= 240   ? " small half"
                    : width <= 480 ? " half"
                                   : "",
                    height > width ? " upright" : "", number, markup(picture.name), reasons(picture));
    if (!shown) return html + "<p class=\"quiet\">Not shown: the page would be too large.</p>\n</section>\n";
    html += fmt::format("<div class=\"three{}\">\n", same_size ? "" : " two");
    html += figure("expected", "Expected", picture, picture.size, data_url(picture.expected));
    html += figure("actual", "Actual", picture, picture.actual_size, data_url(picture.actual));
    if (!same_size) return html + "</div>\n</section>\n";
    const auto difference = amplified_difference(read_png(picture.expected), read_png(picture.actual));
    html += figure("difference", "Difference ×16", picture, picture.size, data_url(difference));
    const auto shape = fmt::format("style=\"--width:{};--height:{}\" hidden=\"\"", width, height);
    return html + fmt::format(
                      "</div>\n<div class=\"names\" {0}><span>Expected</span><span>Actual</span></div>\n"
                      "<div class=\"slider\" {0}><input type=\"range\" min=\"0\" max=\"100\" step=\"0.25\" "
                      "value=\"50\" aria-label=\"Expected over actual: {1}\"/><i></i></div>\n</section>\n",
                      shape, markup(picture.name));
}

/// Pictures without pixels to show: those that cannot be compared, with the reason, or those that pass.
std::string list(const Comparison& comparison, bool passing) {
    std::string items;
    for (const auto& picture : comparison.pictures) {
        const bool passes = picture.match == Match::passes;
        if (passes != passing || picture.match == Match::differs) continue;
        const auto note =
            picture.verdict.differing > 0
                ? fmt::format(" <span class=\"quiet\">{} px differ a little</span>", picture.verdict.differing)
                : "";
        items += passes ? "<li>" + markup(picture.name) + note + "</li>\n"
                        : "<li><code>" + markup(picture.message) + "</code></li>\n";
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
    const auto files = cli_files();
    const auto file = std::ranges::find(files, "cli/compare.html", &EmbeddedFile::name);
    if (file == files.end()) throw io_failed("the page of compare was not built in");
    const auto title = file->contents.find("{title}"), body = file->contents.find("{body}");
    OutputFile page(place);
    std::size_t written = 0;
    const auto write = [&](std::string_view text) {
        page.write(text);
        written += text.size();
    };
    write(file->contents.substr(0, title));
    write(markup(heading(comparison)));
    write(file->contents.substr(title + 7, body - title - 7));
    write(header(comparison) + contents(comparison) + "<main>\n" + list(comparison, false));
    for (std::size_t i = 0; i < comparison.pictures.size(); ++i)
        if (comparison.pictures[i].match == Match::differs)
            write(section(comparison.pictures[i], i + 1, written < max_bytes));
    write(list(comparison, true));
    write(
        fmt::format("</main>\n<footer><p>A picture passes where it differs no more than graphics drivers do: in few "
                    "pixels, by little. Doppel {} ({})</p></footer>",
                    version(), revision()));
    write(file->contents.substr(body + 6));
    page.close();
}

}  // namespace doppel
