#pragma once

#include "output/files.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace doppel {

/// Writes CSV (RFC 4180): header, commas, CRLF. Numbers have the fewest digits that give the same double back.
class Csv {
public:
    /// Opens the file and writes the header. All functions that write throw Error (exit 4) on failure.
    Csv(const std::filesystem::path& place, const std::vector<std::string>& columns) : Csv(place, columns, columns) {}
    /// Rows are added with all columns; only the columns in `written` are written to the file.
    Csv(const std::filesystem::path& place, std::vector<std::string> columns, const std::vector<std::string>& written);

    void add(long value);
    /// Throws Error (exit 3) if the value is not finite.
    void add(double value);
    /// Quoted if it contains a comma, a quote or a line break.
    void add(std::string_view text);
    /// Writes an empty cell if there is no value.
    void add(std::optional<double> value);
    /// Writes an empty cell if the value is NaN.
    void add_or_empty(double value);
    /// Throws std::logic_error if the number of cells is not the number of columns.
    void end_row();
    /// Writes what is buffered and closes the file.
    void finish();

private:
    /// Moves to the next cell; returns whether its column is written.
    bool separate();

    OutputFile file_;
    std::string buffer_;
    std::vector<std::string> columns_;
    std::vector<bool> is_written_;  // for each column
    bool begins_row_ = true;
    std::size_t cell_ = 0;
    long row_ = 0;
};

}  // namespace doppel
