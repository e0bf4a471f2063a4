#include "base/machine.hpp"

#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace doppel {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
    return parts;
}

/// The numbers that a file begins with: none where it says "max".
std::vector<double> numbers_in(const fs::path& file) {
    std::ifstream stream(file);
    std::vector<double> numbers;
    for (double number = 0; stream >> number;) numbers.push_back(number);
    return numbers;
}

/// The group of this process that holds each controller; of version 2, which has one for all, under "".
std::map<std::string, std::string> groups_of(const fs::path& root) {
    // "4:cpu,cpuacct:/a/b"; version 2: "0::/a/b"
    std::map<std::string, std::string> groups;
    std::ifstream file(root / "proc/self/cgroup");
    for (std::string line; std::getline(file, line);) {
        const auto first = line.find(':'), second = line.find(':', first + 1);
        if (second == std::string::npos) continue;
        const auto path = line.substr(second + 1);
        const auto names = split(line.substr(first + 1, second - first - 1), ',');
        if (names.empty()) groups[""] = path;
        for (const auto& name : names) groups[name] = path;
    }
    return groups;
}

/// Calls visit(folder) for the group's folder below a place where a controller is mounted, and those of all groups
/// around it: each has limits of its own. `top` = the group that the mount shows at its place.
void for_each_around(const fs::path& place, const fs::path& top, const fs::path& group,
                     const std::function<void(const fs::path&)>& visit) {
    const auto below = group.lexically_relative(top);
    // of a group out of sight ("/..") only what is around it can be seen
    const bool is_below = !below.empty() && *below.begin() != ".." && below != ".";
    for (auto folder = is_below ? place / below : place;; folder = folder.parent_path()) {
        visit(folder);
        if (folder == place || folder == folder.parent_path()) return;
    }
}

int cores_of(double quota, double period, int cores) {
    if (!(quota > 0 && period > 0)) return cores;
    return static_cast<int>(std::clamp(std::ceil(quota / period), 1.0, static_cast<double>(cores)));
}

std::uintmax_t least(std::uintmax_t memory, double limit) {
    return limit < static_cast<double>(memory) ? static_cast<std::uintmax_t>(limit) : memory;
}

int cores_by_mask() {
    // the kernel tells how large its masks are only by refusing smaller ones
    for (int most = 1024; most <= 1 << 20; most *= 2) {
        cpu_set_t* const mask = CPU_ALLOC(most);
        if (!mask) break;
        const std::size_t size = CPU_ALLOC_SIZE(most);
        const int count = sched_getaffinity(0, size, mask) == 0 ? CPU_COUNT_S(size, mask) : 0;
        CPU_FREE(mask);
        if (count > 0) return count;
    }
    return static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

Machine read_machine() {
    const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGE_SIZE);
    Machine machine{cores_by_mask(), std::numeric_limits<std::uintmax_t>::max()};
    if (pages > 0 && page > 0) machine.memory = static_cast<std::uintmax_t>(pages) * static_cast<std::uintmax_t>(page);
    rlimit limit{};
    if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
        machine.memory = std::min<std::uintmax_t>(machine.memory, limit.rlim_cur);
    return within_control_groups(machine, "/");
}

}  // namespace

// Linux, Documentation/admin-guide/cgroup-v2.rst and cgroup-v1/; man 5 proc: mountinfo.
Machine within_control_groups(Machine machine, const fs::path& root) {
    const auto groups = groups_of(root);
    std::ifstream mounts(root / "proc/self/mountinfo");
    for (std::string line; std::getline(mounts, line);) {
        // 36 35 98:0 TOP PLACE options … - TYPE source options
        const auto words = split(line, ' ');
        const auto dash = std::find(words.begin(), words.end(), "-");
        if (words.size() < 5 || words.end() - dash < 4) continue;
        const auto place = root / fs::path(words[4]).relative_path();
        const auto visit = [&](const std::string& controller, const std::function<void(const fs::path&)>& read) {
            if (const auto group = groups.find(controller); group != groups.end())
                for_each_around(place, words[3], group->second, read);
        };
        if (dash[1] == "cgroup2")
            visit("", [&](const fs::path& folder) {
                if (const auto quota = numbers_in(folder / "cpu.max"); quota.size() == 2)
                    machine.cores = cores_of(quota[0], quota[1], machine.cores);
                if (const auto limit = numbers_in(folder / "memory.max"); !limit.empty())
                    machine.memory = least(machine.memory, limit[0]);
            });
        if (dash[1] != "cgroup") continue;
        for (const auto& controller : split(dash[3], ',')) {
            if (controller == "cpu")
                visit(controller, [&](const fs::path& folder) {
                    const auto quota = numbers_in(folder / "cpu.cfs_quota_us"),
                               period = numbers_in(folder / "cpu.cfs_period_us");
                    if (!quota.empty() && !period.empty()) machine.cores = cores_of(quota[0], period[0], machine.cores);
                });
            if (controller == "memory")
                visit(controller, [&](const fs::path& folder) {
                    if (const auto limit = numbers_in(folder / "memory.limit_in_bytes"); !limit.empty())
                        machine.memory = least(machine.memory, limit[0]);
                });
        }
    }
    return machine;
}

std::size_t affordable(std::size_t bytes, std::size_t most, const Machine& machine) {
    constexpr std::uintmax_t enough = std::uintmax_t{2} << 30;
    const auto fit = std::min(machine.memory / 4, enough) / std::max<std::uintmax_t>(bytes, 1);
    return static_cast<std::size_t>(std::clamp<std::uintmax_t>(fit, 1, std::max<std::size_t>(most, 1)));
}

const Machine& this_machine() {
    static const Machine machine = read_machine();
    return machine;
}

}  // namespace doppel
