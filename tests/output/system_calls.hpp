#pragma once

#include <functional>
#include <string>

namespace doppel::test {

/// Intercepts the calls by which this process changes files, if a test enables it. Each call is reported before it is
/// made; the test may end the process, or let the call fail with the errno that it returns (0: the call is made). Syncs
/// then do nothing: this tests killed processes, not disks that lose power.
using CallWatch = std::function<int(const std::string& call)>;
void watch_calls(CallWatch watch);

/// Runs `action` in a child process, which is killed before its n-th call (from 1). Returns false if it made fewer
/// calls and so was not killed.
/// `other` decides on the calls before.
bool killed_before(int n, const std::function<void()>& action, const CallWatch& other = {});

}  // namespace doppel::test
