#pragma once

#include <functional>
#include <string>

namespace doppel::test {

/// What happens to the calls by which this process changes files, where a test arms it: each is announced before it is
/// made, and the test may end the process, or have the call fail with the errno that it returns (0: it is made). To
/// sync then does nothing: only who is killed, not a disk without power, is tested.
using CallWatch = std::function<int(const std::string& call)>;
void watch_calls(CallWatch watch);

/// Does `action` in a process of its own, which is killed before its n-th call, from 1; false where it had fewer and did
/// not kill itself.
/// `other` decides on the calls before.
bool killed_before(int n, const std::function<void()>& action, const CallWatch& other = {});

}  // namespace doppel::test
