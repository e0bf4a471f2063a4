#pragma once

#include <functional>
#include <string>

namespace doppel::test {

/// What happens to the calls by which this process changes files, where a test arms it: each is announced before it is
/// made, and the test may end the process, or have the call fail with the errno that it returns (0: it is made). To
/// sync then does nothing: only who is killed, not a disk without power, is tested.
using CallWatch = std::function<int(const std::string& call)>;
void watch_calls(CallWatch watch);

}  // namespace doppel::test
