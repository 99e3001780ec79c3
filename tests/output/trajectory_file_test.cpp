#include "fleetmap/output/trajectory_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "support/temporary_folder.hpp"

namespace fleetmap::output {
namespace {

Trajectory made_up_trajectory(std::size_t count) {
  Trajectory poses;
  for (std::size_t k = 0; k < count; ++k) {
    const double a = 0.1 * static_cast<double>(k);
    // A Unix time whose nanoseconds a double could not hold.
    poses.push_back({stamp_from_ns(1'750'000'000'123'456'789 + static_cast<std::int64_t>(k) * 100'000'001),
                     make_pose(rotation_from_rpy(0.1, -a, 3.0 * a), Eigen::Vector3d(a, -1e3, 0.001))});
  }
  return poses;
}

TEST(TrajectoryFile, ReadsBackWhatItWroteToTheNanosecond) {
  const testing::TemporaryFolder folder;
  const auto poses = made_up_trajectory(50);
  ASSERT_TRUE(write_tum(folder.path() / "t.tum", poses));
  const auto read = read_tum(folder.path() / "t.tum");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->size(), poses.size());
  for (std::size_t k = 0; k < poses.size(); ++k) {
    EXPECT_EQ((*read)[k].stamp, poses[k].stamp);
    EXPECT_LT(((*read)[k].T_w_base.matrix() - poses[k].T_w_base.matrix()).norm(), 1e-5);
  }
}

TEST(TrajectoryFile, GrowingFileHoldsEveryLineAtOnce) {
  const testing::TemporaryFolder folder;
  auto file = TrajectoryFile::create(folder.path() / "t.tum");
  ASSERT_TRUE(file);
  for (const StampedPose& pose : made_up_trajectory(3)) ASSERT_TRUE(file->add(pose));
  EXPECT_EQ(read_growing_tum(folder.path() / "t.tum")->size(), 3u)
      << "the writer is still open, as when it is killed";
}

TEST(TrajectoryFile, LineThatAKillCutOffEndsTheFile) {
  const testing::TemporaryFolder folder;
  const std::string lines = tum_line(made_up_trajectory(1)[0]) + "\n" + tum_line(made_up_trajectory(2)[1]);
  const auto file = folder.write("t.tum", lines.substr(0, lines.size() - 40));
  const auto read = read_growing_tum(file);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->size(), 1u);
}

TEST(TrajectoryFile, NonsenseIsAnErrorWithFileAndLine) {
  const testing::TemporaryFolder folder;
  const auto file = folder.write("t.tum", "# a comment\n" + tum_line(made_up_trajectory(1)[0]) + "\nhello\n" +
                                              tum_line(made_up_trajectory(1)[0]) + "\n");
  const auto read = read_growing_tum(file);
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().message, ::testing::HasSubstr("t.tum:3: expected"));
  EXPECT_FALSE(read_growing_tum(folder.path() / "none.tum"));
}

TEST(TrajectoryFile, WhatIsNoPoseIsRefusedWithItsLine) {
  const testing::TemporaryFolder folder;
  const std::string good = "# stamp x y z qx qy qz qw\n1.5 0 0 0 0 0 0 1\n\n";
  const auto problem = [&](const std::string& line) {
    const auto read = read_tum(folder.write("bad.tum", good + line));
    return read ? std::string() : read.error().message;
  };
  EXPECT_EQ(problem("2 1 2 3 0 0 0 1"), "");
  EXPECT_EQ(problem("1.6e0 1 2 3 0 0 0 1\r"), "");
  for (const char* line : {"2 1 2 3 0 0 0", "2 1 2 3 0 0 0 1 9", "2 1 nan 3 0 0 0 1", "2 1 inf 3 0 0 0 1",
                           "2 1 2 3 0 0 0 0", "2 1 2 3 0 0 0 5", "x 1 2 3 0 0 0 1", "1e30 1 2 3 0 0 0 1",
                           "2 1 2,5 3 0 0 0 1", "nan 0 0 0 0 0 0 1"}) {
    EXPECT_NE(problem(line).find("bad.tum:4: expected"), std::string::npos) << line << ": " << problem(line);
  }
  EXPECT_NE(problem("1.4 0 0 0 0 0 0 1").find("bad.tum:4: the stamp is before"), std::string::npos);
  EXPECT_FALSE(read_tum(folder.path() / "none.tum"));
}

TEST(TrajectoryFile, OnlyOneThatStillGrowsMayEndWithinALine) {
  const testing::TemporaryFolder folder;
  const auto file = folder.write("t.tum", "1.5 0 0 0 0 0 0 1\n1.25 0 0 0 0 0 0 1\n2.5 0 0");
  const auto growing = read_growing_tum(file);
  ASSERT_TRUE(growing) << growing.error().message;
  EXPECT_EQ(growing->size(), 2u) << "stamps are taken as they are";
  EXPECT_FALSE(read_tum(file));
  EXPECT_FALSE(read_tum(folder.write("u.tum", "1.5 0 0 0 0 0 0 1\n2.5 0 0")));
}

TEST(TrajectoryFile, ThePartBeforeIsReadFirst) {
  const testing::TemporaryFolder folder;
  folder.write("t.tum.before", "1.5 0 0 0 0 0 0 1\n2.5 0 0 0 0 0 0 1\n");
  const auto read = read_growing_tum(folder.write("t.tum", "3.5 0 0 0 0 0 0 1\n"));
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->size(), 3u);
  EXPECT_EQ(read->front().stamp, stamp_from_ns(1'500'000'000));
  EXPECT_EQ(read->back().stamp, stamp_from_ns(3'500'000'000));
  EXPECT_EQ(read_tum(folder.path() / "t.tum")->size(), 3u);
  folder.write("t.tum", "2.25 0 0 0 0 0 0 1\n");
  EXPECT_FALSE(read_tum(folder.path() / "t.tum")) << "stamps go back";
}

TEST(TrajectoryFile, OdometryOfALostStoreIsMovedAside) {
  const testing::TemporaryFolder folder;
  folder.write("odometry.tum.before", "zeroth\n");
  folder.write("odometry.tum", "first\n");
  ASSERT_TRUE(TrajectoryFile::begin_session(folder.path(), 0));
  folder.write("odometry.tum", "second\n");
  ASSERT_TRUE(TrajectoryFile::begin_session(folder.path(), 0));
  const auto line_of = [&](const char* name) {
    std::ifstream in(folder.path() / name);
    std::string line;
    std::getline(in, line);
    return line;
  };
  EXPECT_EQ(line_of("odometry.tum.before-1.before"), "zeroth");
  EXPECT_EQ(line_of("odometry.tum.before-1"), "first");
  EXPECT_EQ(line_of("odometry.tum.before-2"), "second");
  EXPECT_TRUE(read_tum(folder.path() / "odometry.tum")->empty());
}

TEST(OdometryFile, EachSessionHasItsOwn) {
  EXPECT_EQ(odometry_file("out/r1", 0), "out/r1/odometry.tum");
  EXPECT_EQ(odometry_file("out/r1", 2), "out/r1/odometry-2.tum");
}

}  // namespace
}  // namespace fleetmap::output
