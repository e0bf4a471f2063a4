#include "output/blocks.hpp"

#include "base/error.hpp"

#include <libdeflate.h>

namespace doppel {
namespace {

constexpr std::size_t longest_header = 1 << 16;

struct BlockHead {
    std::uint64_t bytes, checksum;
};

std::uint64_t checksum(std::string_view bytes) {
    return libdeflate_crc32(0, bytes.data(), bytes.size());
}

}  // namespace

void BlockWriter::end_block() {
    const BlockHead head{block_.size(), checksum(block_)};
    file_.write({reinterpret_cast<const char*>(&head), sizeof(head)});
    file_.write(block_);
    block_.clear();
}

void BlockWriter::finish() {
    end_block();
    file_.close();
}

BlockReader::BlockReader(std::filesystem::path path, const BlockKind& kind)
    : path_(std::move(path)), kind_(kind), file_(open_file(path_)), left_(std::filesystem::file_size(path_)) {
    for (int c = 0; header_.size() < longest_header && (c = getc_unlocked(file_.get())) != EOF && c != '\n';)
        header_ += static_cast<char>(c);
    if (!header_.starts_with(kind_.start)) throw io_failed("{} {}", path_.string(), kind_.other);
    left_ -= std::min<std::uintmax_t>(left_, header_.size() + 1);
}

bool BlockReader::next() {
    BlockHead head{};
    read_block(sizeof(head));
    read(head);
    read_block(head.bytes);
    if (checksum(block_) != head.checksum) throw damaged();
    return !block_.empty();
}

/// Reads the next bytes of the file as a block.
void BlockReader::read_block(std::uint64_t bytes) {
    if (bytes > left_) throw damaged();
    block_.resize(bytes);
    at_ = 0;
    left_ -= bytes;
    if (std::fread(block_.data(), 1, bytes, file_.get()) != bytes)
        throw std::ferror(file_.get()) ? cannot(path_, "read") : damaged();
}

/// The number of elements of a vector, each of at least a byte.
std::size_t BlockReader::size() {
    std::size_t size = 0;
    read(size);
    if (size > block_.size()) throw damaged();
    return size;
}

const char* BlockReader::take(std::size_t bytes) {
    if (bytes > block_.size() - at_) throw damaged();
    at_ += bytes;
    return block_.data() + at_ - bytes;
}

Error BlockReader::damaged() const {
    return io_failed("{} {}", path_.string(), kind_.damaged);
}

}  // namespace doppel
