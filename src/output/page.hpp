#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace doppel {

/// A page of HTML in one file, beside the style that all pages share.
struct HtmlPage {
    std::string_view kind;                  // "film", "figure", "tiles", "compare": of the comment in its second line
    std::string title;                      // plain text
    std::string body;                       // markup, without style attributes and inline handlers: they do not work
    std::vector<std::string_view> styles;   // CSS of this kind of page
    std::vector<std::string_view> scripts;  // JavaScript, run in this order; what is empty is left out
    nlohmann::ordered_json data = nullptr;  // what scripts read, of #data; null: none
    bool is_packed = false;                 // scripts and data stand compressed in the page, which the browser unpacks
    bool has_pictures_beside = false;       // files in folders beside it; else all pictures are data: addresses
};

/// The page. Its Content-Security-Policy allows these styles and scripts (by their SHA-256), workers from blob: addresses,
/// and no network. Texts of any letters are safe in title and data.
std::string page_text(const HtmlPage& page);

std::string base64(std::string_view bytes);
/// "data:TYPE;base64,…" of a file's bytes: the address of a picture that is in the page.
std::string data_url(std::string_view type, std::string_view bytes);
/// The bytes as its data can hold them: in base64, compressed as DecompressionStream("deflate") takes them.
std::string deflated(std::string_view bytes);

/// What a page of that kind begins with, by which Doppel recognises its files.
std::string page_start(std::string_view kind);

}  // namespace doppel
