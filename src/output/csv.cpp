#include "output/csv.hpp"

#include "base/error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <set>
#include <stdexcept>
#include <utility>

namespace doppel {

Csv::Csv(const std::filesystem::path& place, std::vector<std::string> columns, const std::vector<std::string>& written)
    : file_(place), columns_(std::move(columns)) {
    const std::set<std::string_view> names(written.begin(), written.end());
    for (const auto& name : columns_) is_written_.push_back(names.contains(name));
    for (const std::string& name : columns_) add(name);
    end_row();
    row_ = 0;
}

void Csv::add(long value) {
    if (separate()) fmt::format_to(std::back_inserter(buffer_), "{}", value);
}

void Csv::add(double value) {
    const bool is_written = separate();
    if (!std::isfinite(value))
        throw method_failed("{}: {} of row {} would be {}; a table contains only finite numbers", file_.path().string(),
                            columns_[cell_ - 1], row_, value);
    if (is_written) fmt::format_to(std::back_inserter(buffer_), "{}", value);
}

void Csv::add(std::string_view text) {
    if (!separate()) return;
    const std::string_view quote = text.find_first_of(",\"\r\n") == std::string_view::npos ? "" : "\"";
    buffer_ += quote;
    for (const char c : text) buffer_.append(c == '"' ? 2 : 1, c);
    buffer_ += quote;
}

void Csv::add(std::optional<double> value) {
    if (value)
        add(*value);
    else
        separate();
}

void Csv::add_or_empty(double value) {
    add(std::isnan(value) ? std::nullopt : std::optional(value));
}

void Csv::end_row() {
    if (cell_ != columns_.size())
        throw std::logic_error(
            fmt::format("{}: a row of {} cells under {} columns", file_.path().string(), cell_, columns_.size()));
    buffer_ += "\r\n";
    cell_ = 0;
    begins_row_ = true;
    ++row_;
    if (buffer_.size() >= std::size_t{1} << 16) {
        file_.write(buffer_);
        buffer_.clear();
    }
}

void Csv::finish() {
    file_.write(buffer_);
    file_.close();
}

bool Csv::separate() {
    if (cell_ == columns_.size())
        throw std::logic_error(fmt::format("{}: more than {} cells in a row", file_.path().string(), columns_.size()));
    if (!is_written_[cell_++]) return false;
    if (!std::exchange(begins_row_, false)) buffer_ += ',';
    return true;
}

}  // namespace doppel
