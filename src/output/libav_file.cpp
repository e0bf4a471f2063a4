#include "output/libav_file.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <new>

namespace doppel {
namespace {

/// One place in the file, to write or to read at.
struct Stream {
    int file;
    std::int64_t at = 0;  // bytes from the start
};

/// Byte is uint8_t, const from libavformat 61 on. All of it is written, or libav's code of what failed is returned.
template <class Byte>
int write_stream(void* opaque, Byte* bytes, int count) {
    auto& [file, at] = *static_cast<Stream*>(opaque);
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
    auto& [file, at] = *static_cast<Stream*>(opaque);
    const auto got = pread(file, bytes, static_cast<std::size_t>(count), at);
    if (got < 0) return AVERROR(errno);
    at += got;
    return got == 0 ? AVERROR_EOF : static_cast<int>(got);
}

std::int64_t seek_stream(void* opaque, std::int64_t offset, int whence) {
    auto& [file, at] = *static_cast<Stream*>(opaque);
    struct stat status {};
    if (fstat(file, &status) != 0) return AVERROR(errno);
    whence &= ~AVSEEK_FORCE;
    if (whence == AVSEEK_SIZE) return status.st_size;
    return at = offset + (whence == SEEK_CUR ? at : whence == SEEK_END ? status.st_size : 0);
}

AVIOContext* open_stream(int file, bool writes) {
    constexpr int buffer_bytes = 1 << 16;
    auto stream = std::make_unique<Stream>(Stream{file});
    auto* buffer = static_cast<unsigned char*>(av_malloc(buffer_bytes));
    auto* context =
        buffer ? avio_alloc_context(buffer, buffer_bytes, writes, stream.get(), read_stream, write_stream, seek_stream)
               : nullptr;
    if (!context) {
        av_free(buffer);
        throw std::bad_alloc();
    }
    stream.release();
    return context;
}

void close_stream(AVIOContext* context) {
    if (!context) return;
    delete static_cast<Stream*>(context->opaque);
    av_freep(&context->buffer);
    avio_context_free(&context);
}

}  // namespace

LibavFile::~LibavFile() {
    close_stream(writer_);
}

void LibavFile::attach(AVFormatContext& format) {
    writer_ = format.pb = open_stream(file_.number(), true);
    format.flags |= AVFMT_FLAG_CUSTOM_IO;
    format.opaque = writer_->opaque;
    format.io_open = [](AVFormatContext* muxer, AVIOContext** context, const char*, int flags, AVDictionary**) {
        if (flags & AVIO_FLAG_WRITE) return AVERROR(EPERM);  // it has the one it writes to
        try {
            *context = open_stream(static_cast<Stream*>(muxer->opaque)->file, false);
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
    return ::close(file_.release()) == 0 ? 0 : AVERROR(errno);
}

}  // namespace doppel
