#include "output/spool.hpp"

#include "base/error.hpp"

#include <libdeflate.h>

#include <array>
#include <cerrno>
#include <new>
#include <system_error>

namespace doppel {
namespace {

// A frame is a head, its areas, and their bytes compressed as one. Only this process reads it: as memory has it.
struct Head {
    std::size_t areas, packed;
};

}  // namespace

void Spool::Free::operator()(libdeflate_compressor* compressor) const {
    libdeflate_free_compressor(compressor);
}
void Spool::Free::operator()(libdeflate_decompressor* decompressor) const {
    libdeflate_free_decompressor(decompressor);
}

Spool::Spool(const FilePlace& film, Samples samples)
    : path_(film.path),
      samples_(samples),
      compressor_(libdeflate_alloc_compressor(1)),
      decompressor_(libdeflate_alloc_decompressor()) {
    if (!compressor_ || !decompressor_) throw std::bad_alloc();
    Descriptor file = create_unnamed_file(film);
    file_.reset(fdopen(file.number(), "w+b"));
    if (!file_) fail("cannot be opened");
    file.release();  // closed with the stream
}

void Spool::write(const SampledAreas& frame) {
    const std::size_t size = bytes_of(frame), bound = libdeflate_deflate_compress_bound(compressor_.get(), size);
    std::uint8_t* packed = packed_.make_room(bound);
    const Head head{frame.areas.size(),
                    libdeflate_deflate_compress(compressor_.get(), frame.bytes.data(), size, packed, bound)};
    const auto put = [&](const void* bytes, std::size_t count) {
        if (count > 0 && std::fwrite(bytes, 1, count, file_.get()) != count) fail("cannot be written");
    };
    put(&head, sizeof head);
    put(frame.areas.data(), frame.areas.size() * sizeof(Rect));
    put(packed, head.packed);
    ++frames_;
}

void Spool::rewind() {
    if (std::fflush(file_.get()) != 0) fail("cannot be written");
    if (std::fseek(file_.get(), 0, SEEK_SET) != 0) fail("cannot be read");
}

void Spool::read(SampledAreas& frame) {
    const auto get = [&](void* bytes, std::size_t count) {
        if (count > 0 && std::fread(bytes, 1, count, file_.get()) != count) fail("cannot be read");
    };
    Head head{};
    get(&head, sizeof head);
    frame.areas.resize(head.areas);
    get(frame.areas.data(), head.areas * sizeof(Rect));
    std::uint8_t* packed = packed_.make_room(head.packed);
    get(packed, head.packed);
    const std::size_t size = bytes_of(frame);
    if (libdeflate_deflate_decompress(decompressor_.get(), packed, head.packed, frame.bytes.make_room(size), size,
                                      nullptr) != LIBDEFLATE_SUCCESS)
        fail("is damaged");
}

std::size_t Spool::bytes_of(const SampledAreas& frame) const {
    std::size_t count = 0;
    for (const Rect& area : frame.areas) count += byte_count(samples_, area);
    return count;
}

void Spool::fail(const char* what) const {
    throw io_failed("{}: its frames on the disk: {}: {}", path_.string(), what, std::generic_category().message(errno));
}

}  // namespace doppel
