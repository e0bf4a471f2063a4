#pragma once

#include "base/error.hpp"
#include "scene/preset.hpp"

#include <compare>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace doppel {

/// Sort key of an error: line and column in the file, then errors without a line, then command line options by number.
struct ErrorPlace {
    static constexpr std::size_t no_line = std::numeric_limits<std::size_t>::max() / 2;
    std::size_t line = no_line, column = 0;
    auto operator<=>(const ErrorPlace&) const = default;  // NOLINT(modernize-use-nullptr): clang-tidy 14 takes it for 0
};

/// An error in a key (exit 2). If the key is only wrong together with another key of the same table, that key is
/// `beside`; it may be the wrong one. An empty `beside` stands for any key of the group.
struct KeyError : Error {
    KeyError(const std::string& message, ErrorPlace at, std::string of_group, std::string_view of_key)
        : Error(ExitCode::bad_input, message), place(at), group(std::move(of_group)), key(of_key) {}

    /// The same error, caused together with other keys.
    KeyError with(std::string keys) const {
        auto error = *this;
        error.beside = std::move(keys);
        return error;
    }

    ErrorPlace place;
    std::string group, key;  // the tables that are checked together with its table
    std::optional<std::string> beside;
};

/// Collects the errors of a preset to report them together. Keys outside of tables, group "", belong to all groups. An
/// error of several keys is dropped if one of the other keys has an error itself. Of errors with the same other key,
/// only the first is kept, because that key may be wrong.
class KeyErrors {
public:
    explicit KeyErrors(const std::vector<Override>& overrides) : overrides_(overrides) {}

    /// The place of a value that this command line option gave.
    ErrorPlace of_option(const std::string& origin) const;
    void add(const KeyError& error) { errors_.push_back(error); }
    bool concern(std::string_view group) const;
    /// Throws one Error (exit 2) with all remaining errors, without duplicates, sorted by place. Returns if there is
    /// none.
    void throw_if_any() const;

private:
    std::vector<Override> overrides_;
    std::vector<KeyError> errors_;
};

}  // namespace doppel
