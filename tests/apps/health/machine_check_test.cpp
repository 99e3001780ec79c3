#include "health/machine_check.hpp"

#include <gmock/gmock.h>

#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(MachineCheck, NamesASmallReceiveBufferAndAFullDisk) {
  EXPECT_THAT(
      machine_findings({212'992, 100'000'000, "/data/r1"}),
      ElementsAre(HasSubstr("net.core.rmem_max is 212992 bytes"), HasSubstr("/data/r1: 100 MB are free")));
  EXPECT_THAT(machine_findings({8'388'608, 50'000'000'000, "/data/r1"}), IsEmpty());
  EXPECT_THAT(machine_findings({std::nullopt, std::nullopt, ""}), IsEmpty())
      << "what is unknown is no finding";
}

TEST(MachineCheck, ReadsTheStateOfAFolderThatIsYetToBeMade) {
  const fleetmap::testing::TemporaryFolder folder;
  const MachineState state = machine_state(folder.path() / "not/yet/there");
  ASSERT_TRUE(state.free_bytes);
  EXPECT_GT(*state.free_bytes, 0u);
}

}  // namespace
}  // namespace fleetmap::apps
