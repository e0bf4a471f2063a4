#pragma once

#include "base/error.hpp"

#include <filesystem>
#include <string>

namespace doppel {

/// Reads a file line by line. Only a regular file: no link is followed, and nothing that others feed (a pipe, a device)
/// is waited for.
class LineReader {
public:
    /// Throws Error (exit 4), with `remedy` for what to do about it, where it is something else or cannot be opened.
    LineReader(std::filesystem::path path, std::string remedy);
    ~LineReader();
    LineReader(const LineReader&) = delete;
    LineReader& operator=(const LineReader&) = delete;

    /// The next line, without its end. False after the last; what has no end, because its writer was killed, or is
    /// longer than `most` bytes, is none. Throws Error (exit 4).
    bool next(std::string& line, std::size_t most);
    /// After the last line: the beginning, at least, of what is none.
    std::string rest() const { return unread_.substr(at_); }

    /// This file is not as it should be: "PATH: WHY; REMEDY" (exit 4).
    Error fault(const std::string& why) const;

private:
    bool read_more();

    std::filesystem::path path_;
    std::string remedy_;
    int file_ = -1;
    std::string unread_;
    std::size_t at_ = 0;  // of `unread_`
};

}  // namespace doppel
