#pragma once

#include "output/folder.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace doppel {

/// A table as RFC 4180 has it: a header, commas, CRLF. Numbers are written with the fewest digits that give the same
/// double back.
class Csv {
public:
    /// Opens the file and writes the header. Throws Error (exit 4), as do all that write.
    Csv(const FilePlace& place, std::vector<std::string> columns);

    void add(long value);
    /// Throws Error (exit 3) where the value is not finite: a method that broke down has no place in a table.
    void add(double value);
    /// In quotes where it holds a comma, a quote or the end of a line.
    void add(std::string_view text);
    /// An empty cell where there is no value.
    void add(std::optional<double> value);
    /// The same for a value that is NaN.
    void add_or_empty(double value);
    /// Ends the row. The number of cells must be that of the columns; std::logic_error where it is not.
    void end_row();
    /// Writes what is buffered and closes the file.
    void finish();

private:
    void separate();

    OutputFile file_;
    std::string buffer_;
    std::vector<std::string> columns_;
    std::size_t cell_ = 0;
    long row_ = 0;
};

}  // namespace doppel
