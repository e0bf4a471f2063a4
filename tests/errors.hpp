#pragma once

#include "base/error.hpp"

#include <string>
#include <utility>

namespace doppel::test {

using Thrown = std::pair<ExitCode, std::string>;

/// The exit code and message of the error that `action` throws; {done, "no error"} if it throws none.
template <class Action>
Thrown thrown_by(Action&& action) {
    try {
        action();
    } catch (const Error& error) {
        return {error.code(), error.what()};
    }
    return {ExitCode::done, "no error"};
}

}  // namespace doppel::test
