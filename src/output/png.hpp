#pragma once

#include "output/folder.hpp"
#include "output/metadata.hpp"
#include "output/sink.hpp"

#include <filesystem>
#include <functional>
#include <memory>

namespace doppel {

struct PngOptions {
    bool with_alpha = false;  // RGBA, not premultiplied; else RGB, and alpha is left out
    /// As text chunks "Title", "Comment", …; the encoder as "Software", by which Doppel knows what it made.
    Metadata metadata = {{"encoder", "Doppel"}};
};

/// One picture, through stb_image_write with libdeflate. Throws Error (exit 4).
void write_png(const FilePlace& place, const Picture& picture, const PngOptions& options = {});

/// An 8-bit PNG of any kind, as RGBA. Throws Error: exit 2 where there is no such file, exit 4 where it cannot be
/// decoded.
Picture read_png(const std::filesystem::path& path);

/// A numbered sequence: picture k of the run, k = 0, 1, …, is written to place_of(k), which any thread may ask.
/// `jobs` threads compress, fed through a bounded queue. Errors as write_png's, thrown by take() or finish().
std::unique_ptr<Sink> make_png_sink(std::function<FilePlace(long)> place_of, int jobs, PngOptions options = {});

}  // namespace doppel
