#pragma once

#include "image/picture.hpp"
#include "render/display_list.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace doppel {

/// The coverage of each pixel by a glyph, 0…255. Rows from the top down.
struct Coverage {
    int left = 0, top = 0;  // of the first pixel, px from the whole pixel of the pen on the baseline
    Size size;
    std::vector<std::uint8_t> values;
};

/// A TrueType or OpenType font with outlines. It is immutable, so threads may share it. FreeType reads it: a damaged
/// font only gives wrong or missing letters.
class Font {
public:
    static const Font& built_in(Weight weight = Weight::regular);
    /// Font `index` of a file. Throws Error: exit 2 if it is no such font, exit 4 if it cannot be read.
    static std::shared_ptr<const Font> from_file(const std::filesystem::path& path, int index = 0);
    ~Font();
    Font(const Font&) = delete;
    Font& operator=(const Font&) = delete;

    /// The path of the file; empty for a built-in font.
    const std::filesystem::path& file() const { return file_; }
    /// The contents of the file, and the index of this font in it.
    std::string_view bytes() const { return bytes_; }
    int index() const { return index_; }
    /// The glyph number of a character; 0 if it has none or no outline, as in fonts of coloured letters.
    int number_of(char32_t character) const;
    /// The advance of the pen after a glyph, px.
    float advance(int glyph, float size) const;
    /// A glyph drawn with the pen `shift` px, 0…1, right of a pixel's left edge; empty for number 0.
    Coverage rasterised(int glyph, float size, float shift) const;

private:
    struct Tables;  // of FreeType
    Font(std::filesystem::path file, std::string owned, std::string_view bytes, int index);

    std::filesystem::path file_;
    std::string owned_;       // contents of a file
    std::string_view bytes_;  // these, or the built-in font
    int index_;
    std::unique_ptr<Tables> tables_;
};

}  // namespace doppel
