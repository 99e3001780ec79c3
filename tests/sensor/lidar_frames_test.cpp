#include "fleetmap/sensor/lidar_frames.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace fleetmap::sensor {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<std::string> findings_of(const std::vector<std::string>& frame_ids) {
  LidarFrames frames;
  std::vector<std::string> findings;
  for (const std::string& id : frame_ids) {
    if (auto finding = frames.add(id)) findings.push_back(std::move(*finding));
  }
  return findings;
}

TEST(LidarFrames, OneFrameIsNoFinding) {
  EXPECT_THAT(findings_of({"velodyne", "/velodyne", "velodyne", "/velodyne", "", "velodyne"}), IsEmpty());
}

TEST(LidarFrames, ADriverThatChangesItsNameIsNoFinding) {
  EXPECT_THAT(findings_of({"a", "a", "b", "b", "b", "a", "a"}), IsEmpty());
}

TEST(LidarFrames, TwoByTurnsAreNamedOnce) {
  EXPECT_THAT(findings_of({"left", "right", "left", "right", "left", "right", "left"}),
              ElementsAre(AllOf(HasSubstr("'left' and 'right'"), HasSubstr("topics.points"))));
  EXPECT_THAT(findings_of({"left", "left", "right", "right", "left", "middle", "left"}),
              ElementsAre(HasSubstr("'left' and 'middle'")));
}

}  // namespace
}  // namespace fleetmap::sensor
