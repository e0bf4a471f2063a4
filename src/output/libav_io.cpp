#include "output/libav_encoder.hpp"

#include <sys/stat.h>
#include <unistd.h>

extern "C" {
#include <libavutil/log.h>
}

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <new>
#include <utility>

namespace doppel {
namespace {

/// A position in the file.
struct StreamPosition {
    int file;
    std::int64_t at = 0;  // bytes from the start
};

/// Byte is uint8_t, const from libavformat 61 on. Writes all, or returns libav's error code.
template <class Byte>
int write_stream(void* opaque, Byte* bytes, int count) {
    auto& [file, at] = *static_cast<StreamPosition*>(opaque);
    for (int done = 0; done < count;) {
        const auto written = pwrite(file, bytes + done, static_cast<std::size_t>(count - done), at);
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return AVERROR(written < 0 ? errno : ENOSPC);
        done += static_cast<int>(written);
        at += written;
    }
    return count;
}

int read_stream(void* opaque, std::uint8_t* bytes, int count) {
    auto& [file, at] = *static_cast<StreamPosition*>(opaque);
    const auto got = pread(file, bytes, static_cast<std::size_t>(count), at);
    if (got < 0) return AVERROR(errno);
    at += got;
    return got == 0 ? AVERROR_EOF : static_cast<int>(got);
}

std::int64_t seek_stream(void* opaque, std::int64_t offset, int whence) {
    auto& [file, at] = *static_cast<StreamPosition*>(opaque);
    struct stat status {};
    if (fstat(file, &status) != 0) return AVERROR(errno);
    whence &= ~AVSEEK_FORCE;
    if (whence == AVSEEK_SIZE) return status.st_size;
    return at = offset + (whence == SEEK_CUR ? at : whence == SEEK_END ? status.st_size : 0);
}

AVIOContext* avio_of(int file, bool writes) {
    constexpr int buffer_bytes = 1 << 16;
    auto stream = std::make_unique<StreamPosition>(StreamPosition{file});
    auto* buffer = static_cast<unsigned char*>(av_malloc(buffer_bytes));
    auto* context =
        buffer ? avio_alloc_context(buffer, buffer_bytes, writes, stream.get(), read_stream, write_stream, seek_stream)
               : nullptr;
    if (!context) {
        av_free(buffer);
        throw std::bad_alloc();
    }
    static_cast<void>(stream.release());  // the context has it
    return context;
}

void close_stream(AVIOContext* context) {
    if (!context) return;
    delete static_cast<StreamPosition*>(context->opaque);
    av_freep(&context->buffer);
    avio_context_free(&context);
}

}  // namespace

LibavFile::~LibavFile() {
    close_stream(writer_);
}

void LibavFile::attach(AVFormatContext& format) {
    writer_ = format.pb = avio_of(fileno(file_.get()), true);
    format.flags |= AVFMT_FLAG_CUSTOM_IO;
    format.opaque = writer_->opaque;
    format.io_open = [](AVFormatContext* muxer, AVIOContext** context, const char*, int flags, AVDictionary**) {
        if (flags & AVIO_FLAG_WRITE) return AVERROR(EPERM);  // only reopened for reading
        try {
            *context = avio_of(static_cast<StreamPosition*>(muxer->opaque)->file, false);
        } catch (const std::bad_alloc&) {
            return AVERROR(ENOMEM);
        }
        return 0;
    };
    format.io_close2 = [](AVFormatContext*, AVIOContext* context) {
        close_stream(context);
        return 0;
    };
}

int LibavFile::close() {
    avio_flush(writer_);
    if (writer_->error < 0) return writer_->error;
    return std::fclose(file_.release()) == 0 ? 0 : AVERROR(errno);
}

namespace {

// the log callback cannot tell one encoder from another, but each has its thread
thread_local std::string line, last_line;

bool is_blank(char c) {
    return static_cast<unsigned char>(c) <= ' ' || c == 127;
}

/// Without control characters and final full stops.
std::string cleaned(std::string text) {
    std::replace_if(text.begin(), text.end(), is_blank, ' ');
    const auto last = text.find_last_not_of(" .");
    text.resize(last == std::string::npos ? 0 : last + 1);
    return text.substr(std::min(text.find_first_not_of(' '), text.size()));
}

/// A line may come in pieces.
void keep(void* /*source*/, int level, const char* format, va_list arguments) {
    if (level > AV_LOG_ERROR) return;
    std::array<char, 512> piece{};
    if (std::vsnprintf(piece.data(), piece.size(), format, arguments) < 0) return;
    try {
        line += piece.data();
        if (!line.ends_with('\n')) return;
        if (auto whole = cleaned(std::move(line)); !whole.empty()) last_line = std::move(whole);
        line.clear();
    } catch (...) {  // out of memory; no exception may pass through C
    }
}

}  // namespace

void capture_libav_log() {
    av_log_set_callback(keep);
    // SVT-AV1 has its own log, set by the environment alone
    setenv("SVT_LOG", "0", 0);
}

std::string take_libav_error() {
    if (auto rest = cleaned(std::move(line)); !rest.empty()) last_line = std::move(rest);
    line.clear();
    return std::exchange(last_line, {});
}

}  // namespace doppel
