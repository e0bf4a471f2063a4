#include "base/machine.hpp"

#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace doppel {
namespace {

namespace fs = std::filesystem;

/// The numbers at the start of a file; none if it contains "max".
std::vector<double> numbers_in(const fs::path& file) {
    std::ifstream stream(file);
    std::vector<double> numbers;
    for (double number = 0; stream >> number;) numbers.push_back(number);
    return numbers;
}

int cores_by_mask() {
    // the kernel refuses masks that are too small, so the size is found by trying
    for (std::size_t sets = 1; sets <= 1024; sets *= 2)
        if (std::vector<cpu_set_t> mask(sets); sched_getaffinity(0, sets * sizeof(cpu_set_t), mask.data()) == 0)
            return CPU_COUNT_S(sets * sizeof(cpu_set_t), mask.data());
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

// Linux, Documentation/admin-guide/cgroup-v2.rst
Machine within_control_groups(Machine machine, const fs::path& root) {
    const auto top = root / "sys/fs/cgroup";
    std::ifstream file(root / "proc/self/cgroup");
    std::string line;  // for example "0::/a/b"
    while (std::getline(file, line) && !line.starts_with("0::/")) {
    }
    // the limits of a group and of all its parents apply; of a group outside this view ("/..") only the root is visible
    const bool is_seen = line.starts_with("0::/") && line.find("/..") == std::string::npos;
    for (auto folder = is_seen ? top / line.substr(4) : top;; folder = folder.parent_path()) {
        const auto quota = numbers_in(folder / "cpu.max"), limit = numbers_in(folder / "memory.max");
        if (quota.size() == 2 && quota[0] > 0 && quota[1] > 0)
            machine.cores =
                static_cast<int>(std::clamp(std::ceil(quota[0] / quota[1]), 1.0, static_cast<double>(machine.cores)));
        if (!limit.empty() && limit[0] < static_cast<double>(machine.memory))
            machine.memory = static_cast<std::uintmax_t>(limit[0]);
        if (folder == top || folder == folder.parent_path()) return machine;
    }
}

// proc(5). getrusage() would also count the process that started this one.
double peak_memory() {
    std::ifstream status("/proc/self/status");
    constexpr std::string_view key = "VmHWM:";  // kB
    for (std::string line; std::getline(status, line);)
        if (line.starts_with(key)) return 1024 * std::strtod(line.c_str() + key.size(), nullptr);
    return 0;
}

void reset_peak_memory() {
    std::ofstream("/proc/self/clear_refs") << "5";
}

std::size_t affordable(std::size_t bytes, std::size_t maximum, const Machine& machine) {
    constexpr std::uintmax_t limit = std::uintmax_t{2} << 30;
    const auto fit = std::min(machine.memory / 4, limit) / std::max<std::uintmax_t>(bytes, 1);
    return static_cast<std::size_t>(std::clamp<std::uintmax_t>(fit, 1, std::max<std::size_t>(maximum, 1)));
}

const Machine& this_machine() {
    static const Machine machine = read_machine();
    return machine;
}

}  // namespace doppel
