#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace doppel {

/// An HTML page in one file, with the style that all pages share.
struct HtmlPage {
    std::string_view kind;                  // "film", "figure", "tiles", "compare": in the comment in its second line
    std::string title;                      // plain text
    std::string body;                       // markup; the policy blocks style attributes and inline handlers
    std::vector<std::string_view> styles;   // CSS of this kind of page
    std::vector<std::string_view> scripts;  // JavaScript, run in this order; empty ones are omitted
    nlohmann::ordered_json data = nullptr;  // pageData of the scripts, with the helpers that pages share; null: none.
                                            // with data, both are compressed, and the browser unpacks them
    bool has_pictures_beside = false;       // reads files in folders beside it; otherwise all pictures are data URLs
};

/// The text of the page. Its Content-Security-Policy allows these styles and scripts (by SHA-256), workers from blob:
/// URLs, and no network. Title and data may contain any characters.
std::string page_text(const HtmlPage& page);

std::string base64(std::string_view bytes);
/// "data:TYPE;base64,…" of a file's bytes: the URL of a picture inside the page.
std::string data_url(std::string_view type, std::string_view bytes);
/// The bytes compressed for DecompressionStream("deflate"), as base64.
std::string deflated(std::string_view bytes);

/// The start of a page of that kind, by which Doppel recognises its files.
std::string page_start(std::string_view kind);

}  // namespace doppel
