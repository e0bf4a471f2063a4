#pragma once

#include "output/files.hpp"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
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

/// Writes such a file: the header, a line of JSON; then blocks with checksums; then an empty block, the end. Throws
/// Error (exit 4).
class BlockWriter {
public:
    BlockWriter(const std::filesystem::path& path, const std::string& header) : file_(path) {
        file_.write(header + "\n");
    }
    /// Appends numbers, and vectors and strings of them, to the block.
    template <class... T>
    void operator()(const T&... values) {
        (write(values), ...);
    }
    void end_block();
    void finish();

private:
    template <class T>
    void write(const T& value) {
        static_assert(std::is_trivially_destructible_v<T>);
        block_.append(reinterpret_cast<const char*>(&value), sizeof(T));
    }
    template <class T>
    void write(const std::vector<T>& values) {
        write(values.size());
        for (const auto& value : values) write(value);
    }
    void write(std::string_view bytes) {
        write(bytes.size());
        block_.append(bytes);
    }
    void write(const std::string& bytes) { write(std::string_view(bytes)); }

    OutputFile file_;
    std::string block_;
};

/// Reads such a file. Throws Error (exit 4) if it cannot be read, is damaged, or is something else.
class BlockReader {
public:
    BlockReader(std::filesystem::path path, const BlockKind& kind);
    /// Without the end of the line.
    const std::string& header() const { return header_; }
    /// Reads the next block. False at the end.
    bool next();
    /// Takes from the block what was written to it.
    template <class... T>
    void operator()(T&... values) {
        (read(values), ...);
    }
    /// "PATH is damaged …"
    Error damaged() const;

private:
    template <class T>
    void read(T& value) {
        static_assert(std::is_trivially_destructible_v<T>);
        std::memcpy(static_cast<void*>(&value), take(sizeof(T)), sizeof(T));
    }
    template <class T>
    void read(std::vector<T>& values) {
        values.resize(size());
        for (auto& value : values) read(value);
    }
    void read(std::string& bytes) {
        const auto length = size();
        bytes.assign(take(length), length);
    }
    std::size_t size();
    const char* take(std::size_t bytes);
    void read_block(std::uint64_t bytes);

    std::filesystem::path path_;
    BlockKind kind_;
    Stream file_;
    std::string header_, block_;
    std::size_t at_ = 0;       // in the block
    std::uintmax_t left_ = 0;  // bytes of the file
};

}  // namespace doppel
