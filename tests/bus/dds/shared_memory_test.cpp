// Files that a killed process leaves in the folder of shared memory.
#include "bus/dds/shared_memory.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/file.h>
#include <unistd.h>

#include "support/temporary_folder.hpp"

namespace fleetmap::bus::testing {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

/// The folder as Fast DDS leaves it: a segment, and beside it an empty file that its process holds locked.
class SharedMemory : public ::testing::Test {
 protected:
  fs::path add(const std::string& name) {
    folder_.write(name, "content");
    return folder_.write(name + "_el", "");
  }
  bool exists(const std::string& name) const { return fs::exists(folder_.path() / name); }
  ::fleetmap::testing::TemporaryFolder folder_;
};

TEST_F(SharedMemory, OnlySegmentsOfDeadProcessesAreRemoved) {
  const fs::path alive = add("fastrtps_alive");
  add("fastrtps_dead");
  add("fastrtps_port7413");  // Fast DDS mends ports itself
  add("another");
  const int file = open(alive.c_str(), O_RDONLY);
  ASSERT_EQ(flock(file, LOCK_EX | LOCK_NB), 0);
  EXPECT_EQ(remove_dead_segments(folder_.path()), 0u) << "it may just be being made";
  EXPECT_EQ(remove_dead_segments(folder_.path(), std::chrono::seconds(-2)), 1u);
  close(file);
  EXPECT_FALSE(exists("fastrtps_dead"));
  for (const char* name : {"fastrtps_alive", "fastrtps_alive_el", "fastrtps_port7413", "another"})
    EXPECT_TRUE(exists(name)) << name;
}

TEST_F(SharedMemory, AFolderThatIsNotThereHoldsNothingToRemove) {
  EXPECT_EQ(remove_dead_segments(folder_.path() / "none"), 0u);
}

TEST_F(SharedMemory, TooLittleRoomIsNamedWithTheRemedy) {
  EXPECT_TRUE(check_room(1, folder_.path()));
  const Status none = check_room(std::size_t{1} << 60, folder_.path());
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("dds.onboard.shared_memory"));
  EXPECT_FALSE(check_room(1, folder_.path() / "none"));
}

}  // namespace
}  // namespace fleetmap::bus::testing
