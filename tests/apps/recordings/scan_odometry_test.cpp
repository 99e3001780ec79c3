#include "recordings/scan_odometry.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/made_robot.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct Outcome {
  OdometryRun run;
  std::vector<std::string> findings;
};

/// 4 s of a drive whose points have their y axis multiplied by `mirror`.
Outcome outcome(float mirror) {
  ScanOdometry odometry(made_robot_perception());
  SweepInputs inputs;
  for (SentSample& sent : samples_of_a_robot(1.5, 4.0, kStart)) {
    if (auto* scan = std::get_if<sensor::Scan>(&sent.sample)) {
      for (sensor::ScanPoint& point : scan->points) point.position.y() *= mirror;
    }
    inputs.add(std::move(sent.sample));
    while (const auto input = inputs.take_due()) odometry.add(*input);
  }
  return {odometry.run(), odometry.take_findings()};
}

TEST(ScanOdometry, FollowsADriveWithoutFindings) {
  const auto [run, findings] = outcome(1.0f);
  EXPECT_THAT(findings, IsEmpty());
  EXPECT_EQ(run.refused, 0u);
  EXPECT_GE(run.poses.size(), 37u);
  EXPECT_EQ(run.wall_ms.size(), run.poses.size());
  EXPECT_GT(run.way.length(), 4.0);
  EXPECT_TRUE(run.kept_its_way());
  EXPECT_THAT(run.failures(40), IsEmpty());
}

TEST(ScanOdometry, NamesAMirroredLidarOnce) {
  EXPECT_THAT(outcome(-1.0f).findings, ElementsAre(HasSubstr("its points are mirrored")));
}

TEST(ScanOdometry, ScansThatCannotBeUsedAreNamedWithTheReason) {
  ScanOdometry odometry(made_robot_perception());
  EXPECT_THAT(odometry.run().failures(0), IsEmpty());
  sensor::Scan scan;
  scan.stamp = kStart;
  scan.points.resize(3);
  EXPECT_FALSE(odometry.add({scan, {}, {}}));
  EXPECT_FALSE(odometry.add({scan, {}, {}}));
  EXPECT_EQ(odometry.run().refused, 2u);
  EXPECT_NE(odometry.run().first_refusal, "");
  EXPECT_THAT(odometry.run().failures(2),
              Contains("odometry: no scan could be used: " + odometry.run().first_refusal));
}

}  // namespace
}  // namespace fleetmap::apps
