#pragma once

#include "output/folder.hpp"
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

/// One picture, compressed by libdeflate. Throws Error: exit 4, or 130 where `stop` was set before the
/// picture was compressed.
void write_png(const FilePlace& place, const Picture& picture, const PngOptions& options = {},
               const std::atomic<bool>& stop = false);

/// An 8-bit PNG of any kind, as RGBA. Throws Error: exit 2 where there is no such file, exit 4 where it cannot be
/// decoded.
Picture read_png(const std::filesystem::path& path);

/// A numbered sequence: picture k of the run, k = 0, 1, …, is written to place_of(k), which the thread that gives the
/// pictures is asked. `threads` compress, fed through a bounded queue. Errors as write_png's, and exit 130 soon after
/// `stop` is set, thrown by take() or finish().
std::unique_ptr<Sink> make_png_sink(std::function<FilePlace(long)> place_of, int threads, PngOptions options = {},
                                    const std::atomic<bool>& stop = never_stopped);

/// PNG's text chunks of metadata: tEXt where Latin-1 has all characters of a text, iTXt elsewhere. Keywords are the
/// registered ones: "Title", "Comment", …, "Software" for the encoder.
std::string png_text_chunks(const Metadata& metadata);

/// The threads for pictures of this size where `jobs` were asked for: that many, or one a core where it is 0; fewer
/// where their pictures would take too much of the memory.
int png_threads(int jobs, Size size);

}  // namespace doppel
