#include "fleetmap/bus/fleet_settings.hpp"

#include <gmock/gmock.h>

namespace fleetmap::bus {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

constexpr FleetSettings kOurs{
    .wire_schema = 3, .fleet = 7, .submap_voxel = 1000, .map_voxel = 500, .placement = 9};

TEST(Differences, EqualSettingsHaveNoDifferences) { EXPECT_THAT(differences("r2", kOurs, kOurs), IsEmpty()); }

TEST(Differences, OneSettingIsOneSentenceAboutThatRobot) {
  FleetSettings theirs = kOurs;
  theirs.wire_schema = 4;
  EXPECT_THAT(differences("r2", theirs, kOurs),
              ElementsAre(AllOf(StartsWith("r2 sends messages of version 4"), HasSubstr("ours are 3"))));
  theirs = kOurs;
  theirs.fleet = 8;
  EXPECT_THAT(differences("r2", theirs, kOurs), ElementsAre(StartsWith("r2's fleet list is another")));
  theirs = kOurs;
  theirs.placement = 8;
  EXPECT_THAT(differences("r2", theirs, kOurs),
              ElementsAre(AllOf(StartsWith("r2 places nodes by other settings"), HasSubstr("site.origin"))));
}

TEST(Differences, VoxelsAreInMetresWithTheDigitsThatTheyNeed) {
  FleetSettings theirs = kOurs;
  theirs.submap_voxel = 1250;
  EXPECT_THAT(differences("r2", theirs, kOurs),
              ElementsAre(AllOf(HasSubstr("submaps have voxels of 0.1250 m, ours 0.10 m"),
                                HasSubstr("set submap.voxel alike"))));
  theirs = kOurs;
  theirs.map_voxel = 65535;
  EXPECT_THAT(differences("r2", theirs, kOurs),
              ElementsAre(AllOf(HasSubstr("map has voxels of 6.5535 m, ours 0.05 m"),
                                HasSubstr("set map.voxel alike"))));
}

TEST(Differences, AreAllNamed) {
  EXPECT_THAT(differences("r2", FleetSettings{}, kOurs),
              ElementsAre(HasSubstr("version 0"), HasSubstr("fleet list"), HasSubstr("submap.voxel"),
                          HasSubstr("map.voxel"), HasSubstr("placement")));
}

}  // namespace
}  // namespace fleetmap::bus
