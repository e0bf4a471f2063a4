// What most files include of other people's headers, parsed once for all of them (modules.cmake).
#include <Eigen/Core>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#ifndef __aarch64__
#include <boost/multiprecision/float128.hpp>
#endif
