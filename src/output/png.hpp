#pragma once

#include "image/picture.hpp"
#include "output/files.hpp"
#include "output/sink.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

namespace doppel {

struct PngOptions {
    bool with_alpha = false;  // RGBA, not premultiplied; else RGB, and alpha is left out
    /// Text chunks "Title", "Comment", …; the encoder as "Software", by which Doppel recognises its files.
    Metadata metadata = {{"encoder", "Doppel"}};
    double dpi = 0;  // pixels an inch on paper; 0 = not said
};

/// Compressed by libdeflate. Throws Error: exit 4, or 130 where `stop` was set before the picture was compressed.
void write_png(const std::filesystem::path& place, const Picture& picture, const PngOptions& options = {},
               const std::atomic<bool>& stop = false);

/// The bytes of the same file. Throws Error (exit 4).
std::string png_bytes(const Picture& picture, const PngOptions& options = {});

/// An 8-bit PNG of any kind, as RGBA. Throws Error: exit 2 where there is no such file, exit 4 where it is no regular
/// file, a checksum is wrong, it cannot be decoded, or its colours are not sRGB.
Picture read_png(const std::filesystem::path& place);

/// A numbered sequence: picture k = 0, 1, … is written to place_of(k), called by take(). `threads` compress, fed
/// through a bounded queue. take() and finish() throw as write_png(), and exit 130 soon after `stop` is set.
std::unique_ptr<Sink> make_png_sink(std::function<std::filesystem::path(long)> place_of, int threads,
                                    PngOptions options = {}, const std::atomic<bool>& stop = never_stopped);

/// PNG's text chunks of metadata: tEXt where Latin-1 has all characters of a text, iTXt elsewhere. Keywords are the
/// registered ones: "Title", "Comment", …, "Software" for the encoder.
std::string png_text_chunks(const Metadata& metadata);

/// `jobs` threads, or one a core where it is 0; fewer where pictures of this size would take too much memory.
int png_threads(int jobs, Size size);

/// "data:image/png;base64,…" of a PNG file as it is: what a page needs to show it without the file. Throws Error
/// (exit 4) where it cannot be read.
std::string data_url(const std::filesystem::path& png);

/// The same of a picture.
std::string data_url(const Picture& picture, const PngOptions& options = {});

/// "data:TYPE;base64,…" of a file's bytes.
std::string data_url(std::string_view type, std::string_view bytes);

}  // namespace doppel
