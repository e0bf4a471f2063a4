#include "output/page.hpp"

#include "output/fixtures.hpp"
#include "output/packed.hpp"
#include "output/png.hpp"
#include "output/written.hpp"

namespace doppel::page_test {

using namespace test;

/// Every text between `start` and `end`.
std::vector<std::string> all_between(const std::string& text, const std::string& start, const std::string& end) {
    std::vector<std::string> found;
    for (auto at = text.find(start); at != std::string::npos; at = text.find(start, at)) {
        at += start.size();
        found.push_back(text.substr(at, text.find(end, at) - at));
    }
    return found;
}

const HtmlPage small{.kind = "film", .title = "x", .body = "<main></main>"};

TEST(Base64, KnownVectors) {  // RFC 4648, 10
    for (const auto& [bytes, text] : {std::pair("", ""), {"f", "Zg=="}, {"fo", "Zm8="}, {"foobar", "Zm9vYmFy"}})
        EXPECT_EQ(base64(bytes), text);
    EXPECT_EQ(base64(sha256_digest("abc")), "ungWv48Bz+pBQUDeXa4iI7ADYaOWF3qctBD/YfIAFa0=");
}

TEST(HtmlPage, ItsPolicyAllowsItsVeryScriptsAndStylesAndNoNetwork) {
    auto page = small;
    page.styles = {"main { color: red }\n"};
    page.scripts = {"\"use strict\";\n", "", "const x = 1;\n"};
    const auto text = page_text(page);
    const auto policies = all_between(text, "<meta http-equiv=\"Content-Security-Policy\" content=\"", "\"/>");
    ASSERT_EQ(policies.size(), 1u);
    EXPECT_TRUE(policies[0].starts_with("default-src 'none'; script-src '"));
    EXPECT_TRUE(policies[0].ends_with("; img-src data:; worker-src blob:; base-uri 'none'; form-action 'none'"));
    EXPECT_FALSE(has(policies[0], "unsafe"));
    for (const auto& [tag, directive] : {std::pair("script", "script-src"), {"style", "style-src"}}) {
        std::string sources = directive;
        const auto contents = all_between(text, fmt::format("<{}>", tag), fmt::format("</{}>", tag));
        EXPECT_EQ(contents.size(), 2u);  // without the empty script; in addition to the shared style
        for (const auto& content : contents) sources += fmt::format(" 'sha256-{}'", base64(sha256_digest(content)));
        EXPECT_TRUE(has(policies[0], "; " + sources + ";"));
    }
    page.has_pictures_beside = true;
    EXPECT_TRUE(has(page_text(page), "; img-src data: 'self' file:; "));
}

TEST(HtmlPage, LettersOfTitlesAndDataStayText) {
    const std::string hostile = "</script><!--<script>\"'&\n\u2028\u202e שלום \\`${1}{}";
    auto page = small;
    page.title = hostile;
    page.scripts = {"f();\n"};
    page.data = {{hostile, hostile}, {"bad", "\xff"}};
    const auto text = page_text(page);
    EXPECT_TRUE(has(text, "<title>&lt;/script&gt;&lt;!--&lt;script&gt;&quot;&#39;&amp;    שלום \\`${1}{}</title>"));
    const auto read = data_of(text);
    EXPECT_EQ(read[hostile], hostile);
    EXPECT_EQ(read["bad"], "\ufffd");
    // that unpacks, of the data, of the shared helpers, of the page's own script
    for (const char* tag : {"<script", "</script>"}) EXPECT_EQ(all_between(text, tag, "\n").size(), 4u) << tag;
    for (const char* once : {"<!--", "</title>", "</body>"}) EXPECT_EQ(all_between(text, once, "\n").size(), 1u);
    EXPECT_FALSE(has(page_text(small), "<script"));  // none without data and scripts
}

TEST(HtmlPage, IsKnownAsDoppelsByItsSecondLine) {
    const auto path = fresh_folder() / "x.html";
    for (const auto kind : {"film", "figure", "tiles", "compare"}) {
        auto page = small;
        page.kind = kind;
        const auto text = page_text(page);
        EXPECT_TRUE(text.starts_with(page_start(kind)));
        EXPECT_EQ(page_start(kind), fmt::format("<!DOCTYPE html>\n<!-- Doppel {} -->", kind));
        write_bytes(path, text);
        EXPECT_TRUE(made_by(path));
    }
}

}  // namespace doppel::page_test
