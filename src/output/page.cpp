#include "output/page.hpp"

#include "base/embedded.hpp"
#include "base/text.hpp"
#include "embedded/output.hpp"
#include "output/written.hpp"

extern "C" {
#include <libavutil/base64.h>
}

#include <fmt/format.h>
#include <libdeflate.h>

namespace doppel {
namespace {

/// A style or script element; appends the hash of its contents to the policy's `sources`.
std::string element(std::string_view tag, std::string_view contents, std::string& sources) {
    if (contents.empty()) return {};
    const auto lines = fmt::format("\n{}", contents);
    sources += fmt::format(" 'sha256-{}'", base64(sha256_digest(lines)));
    return fmt::format("<{0}>{1}</{0}>\n", tag, lines);
}

}  // namespace

std::string base64(std::string_view bytes) {
    std::string text(AV_BASE64_SIZE(bytes.size()), '\0');
    av_base64_encode(text.data(), static_cast<int>(text.size()), reinterpret_cast<const std::uint8_t*>(bytes.data()),
                     static_cast<int>(bytes.size()));
    text.pop_back();  // the terminating zero
    return text;
}

std::string data_url(std::string_view type, std::string_view bytes) {
    return fmt::format("data:{};base64,{}", type, base64(bytes));
}

std::string deflated(std::string_view bytes) {
    constexpr int level = 9;
    const Owned<libdeflate_compressor, libdeflate_free_compressor> compressor(
        checked(libdeflate_alloc_compressor(level)));
    std::string packed(libdeflate_zlib_compress_bound(compressor.get(), bytes.size()), '\0');
    packed.resize(libdeflate_zlib_compress(compressor.get(), bytes.data(), bytes.size(), packed.data(), packed.size()));
    return base64(packed);
}

std::string page_start(std::string_view kind) {
    return fmt::format("<!DOCTYPE html>\n<!-- Doppel {} -->", kind);
}

std::string page_text(const HtmlPage& page) {
    const auto file = [](std::string_view name) { return embedded_file(output_files(), name); };
    std::string style_sources, script_sources, scripts;
    auto styles = element("style", file("output/page.css"), style_sources);
    for (const auto style : page.styles) styles += element("style", style, style_sources);
    const bool has_data = !page.data.is_null();
    const auto add_packed = [&](std::string_view attributes, std::string_view contents) {
        scripts += fmt::format("<script type=\"text/packed\"{}>{}</script>\n", attributes, deflated(contents));
    };
    const auto add = [&](std::string_view script) {
        const auto plain = element("script", script, script_sources);
        if (has_data)
            add_packed("", fmt::format("\n{}", script));
        else
            scripts += plain;
    };
    if (has_data) {
        scripts = element("script", file("output/unpack.js"), script_sources);
        add_packed(" id=\"data\"", page.data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
        add(file("output/helpers.js"));
    }
    for (const auto script : page.scripts) add(script);
    return fmt::format(R"({}
<html lang="en">
<head>
<meta charset="utf-8"/>
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src{}; style-src{}; img-src data:{}; worker-src blob:; base-uri 'none'; form-action 'none'"/>
<meta name="viewport" content="width=device-width, initial-scale=1"/>
<meta name="generator" content="Doppel"/>
<link rel="icon" href="data:,"/>
<title>{}</title>
{}</head>
<body>
{}
{}</body>
</html>
)",
                       page_start(page.kind), script_sources, style_sources,
                       page.has_pictures_beside ? " 'self' file:" : "", markup(page.title), styles, page.body, scripts);
}

}  // namespace doppel
