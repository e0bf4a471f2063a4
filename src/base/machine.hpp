#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace doppel {

/// What of the machine this process may use.
struct Machine {
    int cores = 1;              // at once
    std::uintmax_t memory = 0;  // bytes
};

/// By the affinity mask and the size of the memory, and by the limits of control groups (version 2) and of the
/// address space; read once.
const Machine& this_machine();

/// `machine` with what the control groups of this process leave of it. Below `root` are proc/self/cgroup and
/// sys/fs/cgroup. A share of a core counts as a whole one.
Machine within_control_groups(Machine machine, const std::filesystem::path& root);

/// How many things of so many bytes may exist at once: `most`, or as many of them as take no more than a quarter
/// of the memory, and no more than 2 GiB; at least one.
std::size_t affordable(std::size_t bytes, std::size_t most, const Machine& machine = this_machine());

/// As many threads as this process may use cores at once, at least one.
inline int cores() {
    return this_machine().cores;
}

}  // namespace doppel
