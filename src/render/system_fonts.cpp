#include "base/error.hpp"
#include "render/typeface.hpp"

#include <fontconfig/fontconfig.h>

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

namespace doppel {
namespace {

template <class T, void (*give_back)(T*)>
struct GiveBack {
    void operator()(T* object) const { give_back(object); }
};
using Config = std::unique_ptr<FcConfig, GiveBack<FcConfig, FcConfigDestroy>>;
using Pattern = std::unique_ptr<FcPattern, GiveBack<FcPattern, FcPatternDestroy>>;
using Letters = std::unique_ptr<FcCharSet, GiveBack<FcCharSet, FcCharSetDestroy>>;
using Fonts = std::unique_ptr<FcFontSet, GiveBack<FcFontSet, FcFontSetDestroy>>;

/// Fonts of the system with outlines, sorted by suitability for the letter.
Fonts fonts_for(FcConfig* config, char32_t letter) {
    const Pattern wanted(FcPatternCreate());
    const Letters letters(FcCharSetCreate());
    FcCharSetAddChar(letters.get(), letter);
    FcPatternAddCharSet(wanted.get(), FC_CHARSET, letters.get());
    FcPatternAddString(wanted.get(), FC_FAMILY, reinterpret_cast<const FcChar8*>("sans-serif"));
    FcPatternAddBool(wanted.get(), FC_OUTLINE, FcTrue);
    FcPatternAddBool(wanted.get(), FC_COLOR, FcFalse);
    FcConfigSubstitute(config, wanted.get(), FcMatchPattern);
    FcDefaultSubstitute(wanted.get());
    FcResult result = FcResultNoMatch;
    return Fonts(FcFontSort(config, wanted.get(), FcFalse, nullptr, &result));
}

// What was found is kept for the rest of the process.

/// Null if it is no font with outlines. One thread at a time: system_font_for() has locked.
const Font* opened(const std::string& file, int index) {
    static std::map<std::pair<std::string, int>, std::shared_ptr<const Font>> fonts;
    const auto [place, is_new] = fonts.try_emplace({file, index});
    if (is_new) {
        try {
            place->second = Font::from_file(file, index);
        } catch (const Error&) {  // a type of font that Doppel does not read; the next may be readable
        }
    }
    return place->second.get();
}

const Font* find_font(char32_t letter) {
    static const Config config(FcInitLoadConfigAndFonts());
    if (!config) return nullptr;
    const auto fonts = fonts_for(config.get(), letter);
    for (int i = 0; fonts && i < fonts->nfont; ++i) {
        FcPattern* const found = fonts->fonts[i];
        FcCharSet* letters = nullptr;
        FcChar8* file = nullptr;
        int index = 0;
        if (FcPatternGetCharSet(found, FC_CHARSET, 0, &letters) != FcResultMatch ||
            FcCharSetHasChar(letters, letter) == FcFalse ||
            FcPatternGetString(found, FC_FILE, 0, &file) != FcResultMatch)
            continue;
        FcPatternGetInteger(found, FC_INDEX, 0, &index);
        // the upper 16 bits number an instance of a variable font; the default instance is used
        const auto* font = opened(reinterpret_cast<const char*>(file), index & 0xffff);
        if (font && font->number_of(letter) != 0) return font;
    }
    return nullptr;
}

}  // namespace

const Font* system_font_for(char32_t character) {
    static std::mutex mutex;
    static std::map<char32_t, const Font*> fonts;
    const std::lock_guard lock(mutex);
    const auto [place, is_new] = fonts.try_emplace(character, nullptr);
    if (is_new) place->second = find_font(character);
    return place->second;
}

}  // namespace doppel
