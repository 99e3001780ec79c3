#include "report/report_facts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fleetmap/cloud/file_io.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

output::StampedPose pose_at_x(double seconds, double x) {
  return {stamp_from_ns(static_cast<std::int64_t>(seconds * 1e9)),
          make_pose(Eigen::Matrix3d::Identity(), Eigen::Vector3d(x, 0.0, 0.0))};
}

TEST(DrivenDistance, IsNotMadeOfTheNoiseOfARobotThatStands) {
  output::Trajectory poses;
  for (int k = 0; k < 1000; ++k) poses.push_back(pose_at_x(0.1 * k, k % 2 == 0 ? 0.0 : 0.05));
  EXPECT_EQ(driven_distance(poses), 0.0);
  for (int k = 0; k <= 100; ++k) poses.push_back(pose_at_x(100.0 + 0.1 * k, 0.1 * k));
  EXPECT_NEAR(driven_distance(poses), 10.0, 0.2);
  EXPECT_EQ(driven_distance({}), 0.0);
}

TEST(DrivenDistance, IsWithoutTheWayBetweenTwoSessions) {
  output::Trajectory poses;
  for (int k = 0; k <= 10; ++k) poses.push_back(pose_at_x(k, k));
  for (int k = 0; k <= 10; ++k) poses.push_back(pose_at_x(86'400.0 + k, 500.0 + k));
  EXPECT_NEAR(driven_distance(poses), 20.0, 1e-9);
}

TEST(ReportFacts, HoldWhatIsInTheRobotsFolder) {
  const testing::TemporaryFolder folder;
  ReportFacts facts;
  const AgentId r1 = AgentId::parse("r1").value();
  add_robot(r1, folder.path(), facts);
  EXPECT_THAT(facts.tracks, IsEmpty());
  EXPECT_THAT(facts.store_bytes, IsEmpty());
  folder.write("store.db", std::string(1000, 'x'));
  folder.write("store.db-wal", std::string(234, 'x'));
  ASSERT_TRUE(
      output::write_tum(folder.path() / "trajectory.tum", {pose_at_x(1.0, 0.0), pose_at_x(2.0, 3.0)}));
  add_robot(r1, folder.path(), facts);
  ASSERT_THAT(facts.tracks, SizeIs(1));
  EXPECT_EQ(facts.tracks[0].robot, "r1");
  EXPECT_THAT(facts.tracks[0].poses, SizeIs(2));
  EXPECT_EQ(facts.store_bytes.at("r1"), 1234u);
}

TEST(ReportFacts, AreaAndPictureAreThoseOfTheMapFile) {
  const testing::TemporaryFolder folder;
  ReportFacts facts;
  add_map(folder.path() / "map.ply", facts);
  EXPECT_FALSE(facts.plan);
  EXPECT_EQ(facts.why_no_plan, "");
  cloud::PointCloud map;
  for (int x = 0; x < 20; ++x) {
    for (int y = 0; y < 10; ++y) {
      for (const float z : {0.0f, 2.0f})
        map.points.emplace_back(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, z);
    }
  }
  ASSERT_TRUE(cloud::write_cloud(folder.path() / "map.ply", map));
  add_map(folder.path() / "map.ply", facts);
  EXPECT_EQ(facts.mapped_area, 200.0);
  ASSERT_TRUE(facts.plan);
  EXPECT_EQ(facts.plan->png[1], 'P');
  folder.write("map.ply", "no ply");
  ReportFacts damaged;
  add_map(folder.path() / "map.ply", damaged);
  EXPECT_FALSE(damaged.plan);
  EXPECT_THAT(damaged.why_no_plan, HasSubstr("map.ply"));
}

}  // namespace
}  // namespace fleetmap::apps
