#include "base/machine.hpp"

#include <gtest/gtest.h>
#include <sched.h>

#include <fstream>
#include <utility>
#include <vector>

namespace doppel::machine_test {

namespace fs = std::filesystem;

constexpr Machine bare{64, std::uintmax_t{256} << 30};

struct System {
    const char* name;
    std::vector<std::pair<const char*, const char*>> files;  // paths below /, and their contents
    int cores;
    std::uintmax_t memory;
};

TEST(Machine, KeepsWithinItsControlGroups) {
    constexpr const char *self = "proc/self/cgroup", *job = "0::/user.slice/job";
    const auto folder = fs::path(DOPPEL_TEST_OUTPUT) / "ControlGroups";
    for (const auto& [name, files, cores, memory] : std::vector<System>{
             {"none", {}, bare.cores, bare.memory},
             {"two and a half cores, 1 GiB",
              {{self, job},
               {"sys/fs/cgroup/user.slice/job/cpu.max", "250000 100000"},
               {"sys/fs/cgroup/user.slice/job/memory.max", "1073741824"}},
              3,
              std::uintmax_t{1} << 30},
             {"no limit",
              {{self, job},
               {"sys/fs/cgroup/user.slice/job/cpu.max", "max 100000"},
               {"sys/fs/cgroup/user.slice/job/memory.max", "max"}},
              bare.cores,
              bare.memory},
             {"the group around it is narrower",
              {{self, job},
               {"sys/fs/cgroup/user.slice/job/cpu.max", "800000 100000"},
               {"sys/fs/cgroup/user.slice/cpu.max", "50000 100000"},
               {"sys/fs/cgroup/user.slice/memory.max", "4096"}},
              1,
              4096},
             {"out of sight", {{self, "0::/../elsewhere"}, {"sys/fs/cgroup/cpu.max", "400000 100000"}}, 4, bare.memory},
             {"nonsense",
              {{self, "nonsense\n0:\n0::"}, {"sys/fs/cgroup/cpu.max", "0 0"}, {"sys/fs/cgroup/memory.max", "x"}},
              bare.cores,
              bare.memory}}) {
        fs::remove_all(folder);
        fs::create_directories(folder);
        for (const auto& [file, text] : files) {
            fs::create_directories((folder / file).parent_path());
            std::ofstream(folder / file) << text << "\n";
        }
        const auto found = within_control_groups(bare, folder);
        EXPECT_EQ(found.cores, cores) << name;
        EXPECT_EQ(found.memory, memory) << name;
    }
}

TEST(Machine, HasWhatTheAffinityMaskLeaves) {
    // in a separate process, as the value is read only once
    EXPECT_EXIT(
        {
            cpu_set_t one;
            CPU_ZERO(&one);
            CPU_SET(sched_getcpu(), &one);
            sched_setaffinity(0, sizeof one, &one);
            std::_Exit(cores() == 1 ? 0 : 1);
        },
        testing::ExitedWithCode(0), "");
    EXPECT_GE(cores(), 1);
    EXPECT_GT(this_machine().memory, std::uintmax_t{64} << 20);
}

TEST(Machine, LimitsObjectsByItsMemory) {
    constexpr std::size_t megabyte = 1 << 20;
    EXPECT_EQ(affordable(5 * 33 * megabyte, 64, bare), 12u);                    // 4K in five copies: 2 GiB
    EXPECT_EQ(affordable(5 * 33 * megabyte, 4, bare), 4u);                      // at most the number requested
    EXPECT_EQ(affordable(5 * 33 * megabyte, 64, {64, 2048 * megabyte}), 3u);    // a quarter of 2 GiB
    EXPECT_EQ(affordable(5 * 1024 * megabyte, 64, {64, 1024 * megabyte}), 1u);  // at least one
    EXPECT_EQ(affordable(0, 8, bare), 8u);
}

}  // namespace doppel::machine_test
