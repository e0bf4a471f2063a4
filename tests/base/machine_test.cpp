#include "base/machine.hpp"

#include <gtest/gtest.h>
#include <sched.h>

#include <fstream>

namespace doppel {
namespace machine_test {

namespace fs = std::filesystem;

constexpr Machine bare{64, std::uintmax_t{256} << 30};

/// A system's files in a folder of the test's own.
class ControlGroups : public testing::Test {
protected:
    void SetUp() override {
        fs::remove_all(root_);
        fs::create_directories(root_);
    }
    void put(const fs::path& file, const std::string& text) {
        fs::create_directories((root_ / file).parent_path());
        std::ofstream(root_ / file) << text << "\n";
    }
    void expect(int cores, std::uintmax_t memory) {
        const auto found = within_control_groups(bare, root_);
        EXPECT_EQ(found.cores, cores);
        EXPECT_EQ(found.memory, memory);
    }
    const fs::path root_ =
        fs::path(DOPPEL_TEST_OUTPUT) / "ControlGroups" / testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(ControlGroups, WithoutAnyThereIsAllOfTheMachine) {
    expect(bare.cores, bare.memory);
}

TEST_F(ControlGroups, OfVersion2LimitCoresAndMemory) {
    put("proc/self/cgroup", "0::/user.slice/job");
    put("sys/fs/cgroup/user.slice/job/cpu.max", "250000 100000");
    put("sys/fs/cgroup/user.slice/job/memory.max", "1073741824");
    expect(3, std::uintmax_t{1} << 30);  // two and a half cores
    put("sys/fs/cgroup/user.slice/job/cpu.max", "max 100000");
    put("sys/fs/cgroup/user.slice/job/memory.max", "max");
    expect(bare.cores, bare.memory);
}

TEST_F(ControlGroups, OutsideLimitToo) {
    put("proc/self/cgroup", "0::/user.slice/job");
    put("sys/fs/cgroup/user.slice/job/cpu.max", "800000 100000");
    put("sys/fs/cgroup/user.slice/cpu.max", "50000 100000");
    put("sys/fs/cgroup/user.slice/memory.max", "4096");
    expect(1, 4096);
}

TEST_F(ControlGroups, OutOfSightLeaveWhatIsAroundThem) {
    put("proc/self/cgroup", "0::/../elsewhere");
    put("sys/fs/cgroup/cpu.max", "400000 100000");
    expect(4, bare.memory);
}

TEST_F(ControlGroups, ThatMakeNoSenseLimitNothing) {
    put("proc/self/cgroup", "nonsense\n0:\n0::");
    put("sys/fs/cgroup/cpu.max", "0 0");
    put("sys/fs/cgroup/memory.max", "x");
    expect(bare.cores, bare.memory);
}

TEST(Machine, HasWhatTheAffinityMaskLeaves) {
    // in a process of its own: it is read once
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

TEST(Machine, HoldsNoMoreThanItsMemory) {
    constexpr std::size_t megabyte = 1 << 20;
    EXPECT_EQ(affordable(5 * 33 * megabyte, 64, bare), 12u);                    // 4K in five copies: 2 GiB
    EXPECT_EQ(affordable(5 * 33 * megabyte, 4, bare), 4u);                      // no more than wanted
    EXPECT_EQ(affordable(5 * 33 * megabyte, 64, {64, 2048 * megabyte}), 3u);    // a quarter of 2 GiB
    EXPECT_EQ(affordable(5 * 1024 * megabyte, 64, {64, 1024 * megabyte}), 1u);  // at least one
    EXPECT_EQ(affordable(0, 8, bare), 8u);
}

}  // namespace machine_test
}  // namespace doppel
