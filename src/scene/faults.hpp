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

/// Where a fault stands among others: by line and column of the file, then those of no line, then those of the command
/// line by their number.
struct FaultPlace {
    static constexpr std::size_t no_line = std::numeric_limits<std::size_t>::max() / 2;
    std::size_t line = no_line, column = 0;
    auto operator<=>(const FaultPlace&) const = default;  // NOLINT(modernize-use-nullptr): clang-tidy 14 takes it for 0
};

/// What is wrong with a key (exit 2). One that is right or wrong by what others say may be wrong because they are: it is a
/// fault `beside` the one other key, which is in the same table; beside "", any of the group.
class TomlFault : public Error {
public:
    TomlFault(const std::string& message, FaultPlace place, std::optional<std::string> beside = {})
        : Error(ExitCode::bad_input, message), place_(place), beside_(std::move(beside)) {}

    FaultPlace place() const { return place_; }
    const std::optional<std::string>& beside() const { return beside_; }
    /// The same fault as one of several keys.
    TomlFault with(std::string keys) const { return {what(), place_, std::move(keys)}; }

private:
    FaultPlace place_;
    std::optional<std::string> beside_;
};

/// The faults of a preset, to be reported together. Each belongs to a group of tables that is read as one; that of the
/// keys outside of tables, "", is part of all groups. A fault of several keys counts only where the other keys have no
/// fault of their own, and of those that do not go with the same key the first that was found: that key may be wrong.
class Faults {
public:
    explicit Faults(const std::vector<Override>& overrides);

    /// The place of what this option of the command line gave.
    FaultPlace of_option(const std::string& origin) const;
    struct Entry {
        std::string message;
        FaultPlace place;
        std::string group, key;
        std::optional<std::string> beside;
    };
    void add(Entry fault) { faults_.push_back(std::move(fault)); }
    bool concern(std::string_view group) const;
    /// Throws an Error (exit 2) of all that count, each once, in the order of their places; nothing where there is none.
    void throw_if_any() const;

private:
    bool may_follow(const Entry& fault) const;
    static bool may_be_one(const Entry& fault, const Entry& other);

    std::vector<std::string> options_;
    std::vector<Entry> faults_;
};

}  // namespace doppel
