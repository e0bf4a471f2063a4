#pragma once

#include "base/error.hpp"
#include "output/files.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace doppel {

/// A kind of file with blocks of numbers: the start of its header, and what errors say of another file, and of a
/// damaged one.
struct BlockKind {
    std::string_view start, other, damaged;
};

/// Parts of films: a block contains a packet of the encoder, or the file of one picture.
inline constexpr BlockKind film_part{R"({"file":"doppel film shard")",
                                     "is no part of a film; remove it, and render this part again",
                                     "is damaged or incomplete; remove it, and render this part again"};

/// A file that is damaged or incomplete (exit 4).
struct DamagedFile : Error {
    using Error::Error;
};

/// Such a file, written or read: the header, a line of JSON; then blocks with checksums; then an empty block, the end.
/// All functions throw Error (exit 4): if the file cannot be written or read, or is something else; DamagedFile if it
/// is damaged.
class BlockFile {
public:
    /// Begins a file.
    BlockFile(const std::filesystem::path& path, const std::string& header);
    /// Opens a file.
    BlockFile(std::filesystem::path path, const BlockKind& kind);

    /// Without the end of the line.
    const std::string& header() const { return header_; }
    /// Appends numbers, and vectors and strings of them, to the block, or takes them from the block in the same order.
    template <class... T>
    void operator()(T&... values) {
        (pass(values), ...);
    }
    void end_block();
    /// Makes all blocks up to now readable for others.
    void flush() { written_->flush(); }
    void finish();
    /// Reads the next block. False at the end.
    bool next();
    /// Whether no bytes are left: after a block, its writer has not finished.
    bool is_read() const { return left_ == 0; }
    /// "PATH is damaged …", "PATH is no …"
    DamagedFile damaged() const { return {ExitCode::io_failed, fmt::format("{} {}", path_.string(), kind_.damaged)}; }
    Error other() const { return io_failed("{} {}", path_.string(), kind_.other); }

private:
    template <class T>
    void pass(T& value) {
        static_assert(std::is_trivially_destructible_v<T>);
        pass_bytes(&value, sizeof(T));
    }
    template <class T>
    void pass(std::vector<T>& values) {
        values.resize(pass_size(values.size()));
        for (auto& value : values) pass(value);
    }
    void pass(std::string& bytes) {
        bytes.resize(pass_size(bytes.size()));
        pass_bytes(bytes.data(), bytes.size());
    }
    std::size_t pass_size(std::size_t size);
    void pass_bytes(void* bytes, std::size_t size);
    void read_block(std::uint64_t bytes);

    std::filesystem::path path_;
    BlockKind kind_ = {};
    std::optional<OutputFile> written_;
    Stream read_;
    std::string header_, block_;
    std::size_t at_ = 0;       // in the block
    std::uintmax_t left_ = 0;  // bytes to read
};

}  // namespace doppel
