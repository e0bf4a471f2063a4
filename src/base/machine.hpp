#pragma once

#include <cstddef>
#include <cstdint>
#include <ctime>
#include <filesystem>

namespace doppel {

/// The part of the machine that this process may use.
struct Machine {
    int cores = 1;              // that may run at the same time
    std::uintmax_t memory = 0;  // bytes
};

/// From the affinity mask, the memory size, the limits of control groups (version 2) and of the address space; read
/// once.
const Machine& this_machine();

/// `machine`, reduced to the limits of this process's control groups. `root` contains proc/self/cgroup and
/// sys/fs/cgroup. A fraction of a core counts as one core.
Machine within_control_groups(Machine machine, const std::filesystem::path& root);

/// What a run takes from a machine, estimated.
struct Needs {
    double seconds = 0;         // on this machine
    double cpu_s = 0;           // of all threads
    double repeated_cpu_s = 0;  // of it: what each shard of the run does again
    double memory_bytes = 0, disk_bytes = 0;
    double film_bytes = 0;  // of the disk: the video, the pictures or the page; 0 if unknown, or of a figure
    long most_shards = 0;   // 0: it cannot be split
    bool at_least = false;  // the trial was too short for an estimate: a lower bound
};

/// The time of a system clock, s: CLOCK_MONOTONIC, CLOCK_PROCESS_CPUTIME_ID or CLOCK_THREAD_CPUTIME_ID.
inline double seconds_of(clockid_t clock) {
    timespec now{};
    clock_gettime(clock, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// The largest memory that this process has had since reset_peak_memory(), bytes; 0 if /proc does not tell.
double peak_memory();
void reset_peak_memory();

/// How many objects of `bytes` bytes may exist at the same time, from 1 to `maximum`. Together they take at most a
/// quarter of the memory, and at most 2 GiB.
std::size_t affordable(std::size_t bytes, std::size_t maximum, const Machine& machine = this_machine());

/// The number of threads to use: the cores that this process may use, at least 1.
inline int cores() {
    return this_machine().cores;
}

}  // namespace doppel
