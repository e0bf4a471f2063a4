#pragma once

#include "base/read_file.hpp"
#include "image/picture.hpp"
#include "output/sink.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

namespace doppel {

struct PngOptions {
    bool with_alpha = false;  // RGBA, not premultiplied; otherwise RGB without alpha
    /// Text chunks "Title", "Comment", …. The encoder is stored as "Software", by which Doppel recognises its files.
    Metadata metadata = {{"encoder", "Doppel"}};
    double dpi = 0;  // pixels per inch; 0 = not stored
};

/// Throws Error: exit 4, or 130 if `stop` was set before the picture was compressed.
void write_png(const std::filesystem::path& place, const Picture& picture, const PngOptions& options = {},
               const std::atomic<bool>& stop = false);

/// The bytes of the same file. Throws Error (exit 4).
std::string png_bytes(const Picture& picture, const PngOptions& options = {});

inline constexpr WantedFile png_file{"a picture is a PNG", std::size_t{1} << 30};
/// Reads an 8-bit PNG of any colour type as RGBA. Throws Error: as read_whole_file(); exit 4 if a checksum is wrong, it
/// cannot be decoded, or its colours are not sRGB.
Picture read_png(const std::filesystem::path& place);

/// A numbered sequence: picture k = 0, 1, … is written to place_of(k), which take() calls. Compression runs on
/// `threads` threads behind a bounded queue. take() and finish() throw as write_png(), and exit 130 soon after `stop`
/// is set.
std::unique_ptr<Sink> make_png_sink(std::function<std::filesystem::path(long)> place_of, int threads,
                                    PngOptions options = {}, const std::atomic<bool>& stop = never_stopped);

/// The metadata as PNG text chunks: tEXt for ASCII, otherwise iTXt. Keywords are the registered ones: "Title",
/// "Comment", …, and "Software" for the encoder.
std::string png_text_chunks(const Metadata& metadata);

/// `jobs` threads, or one for each core if it is 0; fewer if pictures of this size would take too much memory.
int png_threads(int jobs, Size size);

}  // namespace doppel
