#include "fleetmap/output/global_track.hpp"

#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace fleetmap::output {
namespace {

GlobalPose made_up(int k) {
  GlobalPose G;
  G.stamp = stamp_from_ns(1'750'000'000'000'000'001 + k * 1'000'000);
  G.position = geo_point_from_degrees(-33.5 + 1e-6 * k, 18.25, 120.5);
  G.q_enu_base = Eigen::Quaterniond(rotation_from_rpy(0.01, 0.02, 0.3 * k));
  G.covariance = Vector6d(1.0, 4.0, 9.0, 1e-4, 1e-4, 0.04).asDiagonal();
  return G;
}

TEST(GlobalTrack, ReadsBackWhatItWrote) {
  const testing::TemporaryFolder folder;
  {
    auto file = GlobalTrackFile::append_to(folder.path() / "g.csv");
    ASSERT_TRUE(file);
    for (int k = 0; k < 5; ++k) ASSERT_TRUE(file->add(made_up(k)));
  }
  const auto track = read_global_track(folder.path() / "g.csv");
  ASSERT_TRUE(track) << track.error().message;
  ASSERT_EQ(track->size(), 5u);
  for (int k = 0; k < 5; ++k) {
    const GlobalPose& G = (*track)[static_cast<std::size_t>(k)];
    EXPECT_EQ(G.stamp, made_up(k).stamp);
    EXPECT_LT(haversine_distance(G.position, made_up(k).position), 1e-3);
    EXPECT_LT(G.q_enu_base.angularDistance(made_up(k).q_enu_base), 1e-6);
    EXPECT_NEAR(G.covariance(1, 1), 4.0, 1e-2);
    EXPECT_NEAR(G.covariance(5, 5), 0.04, 1e-4);
  }
}

TEST(GlobalTrack, NextStartGoesOnBehindALineThatAKillCutOff) {
  const testing::TemporaryFolder folder;
  const auto path = folder.path() / "g.csv";
  {
    auto file = GlobalTrackFile::append_to(path);
    ASSERT_TRUE(file && file->add(made_up(0)) && file->add(made_up(1)));
  }
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 30);
  {
    auto file = GlobalTrackFile::append_to(path);
    ASSERT_TRUE(file && file->add(made_up(2)));
  }
  const auto track = read_global_track(path);
  ASSERT_TRUE(track) << track.error().message;
  ASSERT_EQ(track->size(), 2u);
  EXPECT_EQ(track->back().stamp, made_up(2).stamp);
}

TEST(GlobalTrack, ThePartBeforeIsReadFirst) {
  const testing::TemporaryFolder folder;
  const auto path = folder.path() / "g.csv";
  for (const int k : {0, 1}) {
    {
      auto file = GlobalTrackFile::append_to(path);
      ASSERT_TRUE(file && file->add(made_up(k)));
    }
    if (k == 0) std::filesystem::rename(path, part_before(path));
  }
  const auto track = read_global_track(path);
  ASSERT_TRUE(track) << track.error().message;
  ASSERT_EQ(track->size(), 2u);
  EXPECT_EQ(track->front().stamp, made_up(0).stamp);
  EXPECT_EQ(track->back().stamp, made_up(1).stamp);
}

TEST(GlobalTrack, NonsenseInTheMiddleIsAnError) {
  const testing::TemporaryFolder folder;
  const auto file = folder.write("g.csv", "hello\nworld\n");
  EXPECT_FALSE(read_global_track(file));
}

}  // namespace
}  // namespace fleetmap::output
