#include "output/blocks.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <cstring>

namespace doppel {
namespace {

struct BlockHead {
    std::uint64_t bytes, checksum;
};

std::uint64_t checksum(std::string_view bytes) {
    return libdeflate_crc32(0, bytes.data(), bytes.size());
}

}  // namespace

BlockFile::BlockFile(const std::filesystem::path& path, const std::string& header) : path_(path), written_(path) {
    written_->write(header + "\n");
}

BlockFile::BlockFile(std::filesystem::path path, const BlockKind& kind)
    : path_(std::move(path)), kind_(kind), read_(open_file(path_)), left_(std::filesystem::file_size(path_)) {
    constexpr std::size_t longest_header = 1 << 16;
    for (int c = 0; header_.size() < longest_header && (c = getc_unlocked(read_.get())) != EOF && c != '\n';)
        header_ += static_cast<char>(c);
    if (!header_.starts_with(kind_.start)) throw other();
    left_ -= std::min<std::uintmax_t>(left_, header_.size() + 1);
}

void BlockFile::end_block() {
    const BlockHead head{block_.size(), checksum(block_)};
    written_->write({reinterpret_cast<const char*>(&head), sizeof(head)});
    written_->write(block_);
    block_.clear();
}

void BlockFile::finish() {
    end_block();
    written_->close();
}

bool BlockFile::next() {
    BlockHead head{};
    read_block(sizeof(head));
    pass(head);
    read_block(head.bytes);
    if (checksum(block_) != head.checksum || (block_.empty() && !is_read())) throw damaged();
    return !block_.empty();
}

/// Reads the next bytes of the file as a block.
void BlockFile::read_block(std::uint64_t bytes) {
    if (bytes > left_) throw damaged();
    block_.resize(bytes);
    at_ = 0;
    left_ -= bytes;
    if (std::fread(block_.data(), 1, bytes, read_.get()) == bytes) return;
    if (std::ferror(read_.get())) throw cannot(path_, "read");
    throw damaged();
}

/// The number of elements of a vector, each of at least a byte.
std::size_t BlockFile::pass_size(std::size_t size) {
    pass(size);
    if (!written_ && size > block_.size()) throw damaged();
    return size;
}

void BlockFile::pass_bytes(void* bytes, std::size_t size) {
    if (written_) return void(block_.append(static_cast<const char*>(bytes), size));
    if (size > block_.size() - at_) throw damaged();
    std::memcpy(bytes, block_.data() + at_, size);
    at_ += size;
}

}  // namespace doppel
