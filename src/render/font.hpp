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

/// How much of each pixel a glyph covers, 0…255. Rows from the top down.
struct Coverage {
    int left = 0, top = 0;  // of the first pixel, px from the pen's whole pixel on the baseline
    Size size;
    std::vector<std::uint8_t> values;
};

/// One font, of a TrueType or OpenType file with outlines. It never changes: threads may share it. FreeType reads it: a
/// damaged font has wrong letters, boxes for letters, or none, and nothing worse.
class Font {
public:
    /// The built-in one of that weight.
    static const Font& built_in(Weight weight = Weight::regular);
    /// Font `index` of a file. Throws Error: exit 2 where it is no such font, exit 4 where it cannot be read.
    static std::shared_ptr<const Font> from_file(const std::filesystem::path& path, int index = 0);
    ~Font();
    Font(const Font&) = delete;
    Font& operator=(const Font&) = delete;

    /// The file's path; empty of the built-in one.
    const std::filesystem::path& file() const { return file_; }
    /// The file's contents, and which of its fonts this is.
    std::string_view bytes() const { return bytes_; }
    int index() const { return index_; }
    /// Whether it has to be made bolder to be as bold as that.
    bool lacks(Weight weight) const { return weight == Weight::bold && weight_ != Weight::bold; }
    /// The number of a character's glyph; 0 where there is none, or one without an outline, as of coloured letters.
    int number_of(char32_t character) const;
    /// How far the pen moves past a glyph, px.
    float advance(int glyph, float size, Weight weight) const;
    /// A glyph drawn with the pen `shift` px, 0…1, right of a pixel's left edge; a hollow box for number 0. Where the
    /// font lacks the weight, its outline is moved outward.
    Coverage rasterised(int glyph, float size, Weight weight, float shift) const;

private:
    struct Tables;  // as FreeType has them
    Font(std::filesystem::path file, std::string owned, std::string_view bytes, int index,
         Weight weight = Weight::regular);

    std::filesystem::path file_;
    std::string owned_;       // a file's bytes
    std::string_view bytes_;  // those, or the built-in ones
    int index_;
    Weight weight_;
    std::unique_ptr<Tables> tables_;
};

}  // namespace doppel
