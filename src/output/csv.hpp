#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace doppel {

/// A table as RFC 4180 has it: a header, commas, CRLF. Numbers are written with the fewest digits that give the same double back.
class Csv {
public:
    /// Opens the file and writes the header. Throws Error (exit 4), as do all that write.
    Csv(const std::filesystem::path& path, const std::vector<std::string>& columns);

    void add(long value);
    void add(double value);
    void add_empty();
    /// Ends the row. The number of cells must be that of the columns.
    void end_row();
    /// Writes what is buffered and closes the file.
    void finish();

private:
    void separate();
    void flush();

    std::filesystem::path path_;
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
    std::string buffer_;
    std::size_t columns_, cell_ = 0;
};

}  // namespace doppel
