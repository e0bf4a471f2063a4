#pragma once

#include "output/files.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace doppel {

/// Writes CSV (RFC 4180): a header, commas, CRLF. Numbers have the fewest digits that give the same double back.
class Csv {
public:
    /// Opens the file and writes the header. Throws Error (exit 4), as do all that write.
    Csv(const std::filesystem::path& place, const std::vector<std::string>& columns) : Csv(place, columns, columns) {}
    /// Rows are added with all columns; the file has only those that are `written`.
    Csv(const std::filesystem::path& place, std::vector<std::string> columns, const std::vector<std::string>& written);

    void add(long value);
    /// Throws Error (exit 3) where the value is not finite.
    void add(double value);
    /// Quoted where it holds a comma, a quote or a line break.
    void add(std::string_view text);
    /// An empty cell where there is no value.
    void add(std::optional<double> value);
    /// The same for a value that is NaN.
    void add_or_empty(double value);
    /// Throws std::logic_error where the row has not as many cells as there are columns.
    void end_row();
    /// Writes what is buffered and closes the file.
    void finish();

private:
    /// Goes on to the next cell; whether it is written.
    bool separate();

    OutputFile file_;
    std::string buffer_;
    std::vector<std::string> columns_;
    std::vector<bool> is_written_;  // by column
    bool begins_row_ = true;
    std::size_t cell_ = 0;
    long row_ = 0;
};

}  // namespace doppel
