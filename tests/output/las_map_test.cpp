#include "fleetmap/output/las_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <set>

#include "cloud/las_reader.hpp"
#include "fleetmap/output/map_files.hpp"
#include "support/scene_store.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::output {
namespace {

namespace fs = std::filesystem;
using fleetmap::testing::LasFile;
using fleetmap::testing::read_las;
using ::testing::AllOf;
using ::testing::HasSubstr;

const store::MergeConfig kMerge{.voxel_m = 0.2};

class LasMap : public ::testing::Test {
 protected:
  LasMap() : T_enu_node_(fleetmap::testing::add_scene(store_)) {}
  Result<WrittenLas> write(const std::string& name, std::optional<std::uint32_t> tile = std::nullopt) {
    return write_las(store_, T_enu_node_, kMerge, crs_, {folder_.path() / name, tile, "fleetmap 1.2"});
  }

  fleetmap::testing::TemporaryFolder folder_;
  store::Store store_ =
      std::move(store::Store::open(folder_.path() / "store.db", AgentId::parse("r1").value()).value());
  std::map<NodeId, Pose> T_enu_node_;
  MapCrs crs_ = MapCrs::of({}, {fleetmap::testing::kSceneOrigin, true}, std::nullopt).value();
};

/// A point with all that is stored of it, in steps.
using Known = std::array<std::int64_t, 5>;
Known known(const LasFile::Point& point) {
  const auto steps = [&](int axis) { return std::llround(point.position[axis] * 1000.0); };
  return {steps(0), steps(1), steps(2), point.intensity, point.source};
}

TEST_F(LasMap, IsTheMergedMapInTheReferenceSystem) {
  const auto written = write("map.las");
  ASSERT_TRUE(written) << written.error().message;
  const store::MergedMap map = merged_map(store_, T_enu_node_, kMerge);
  const LasFile file = read_las(folder_.path() / "map.las");
  EXPECT_EQ(written->points, map.cloud.size());
  EXPECT_EQ(written->outline.submaps, 6u);
  EXPECT_EQ(written->files, 1u);
  EXPECT_EQ(written->left_out, 0u);
  ASSERT_EQ(file.points.size(), map.cloud.size());
  const auto coordinates = crs_.from_map(map.cloud.points);
  ASSERT_TRUE(coordinates);
  for (std::size_t k = 0; k < file.points.size(); ++k) {
    EXPECT_LT((file.points[k].position - (*coordinates)[k]).cwiseAbs().maxCoeff(), 0.000501);
    EXPECT_NEAR(file.points[k].intensity, 257.0f * map.cloud.intensities[k], 0.51f);
    EXPECT_EQ(file.points[k].source, map.observed_by[k] + 1);
  }
}

TEST_F(LasMap, TheHeaderIsMadeOfTheMapAlone) {
  ASSERT_TRUE(write("map.las") && write("again.las"));
  const LasFile file = read_las(folder_.path() / "map.las");
  EXPECT_TRUE(read_las(folder_.path() / "again.las").bytes == file.bytes);
  EXPECT_EQ(file.year, 2026);
  EXPECT_EQ(file.day_of_year, 329) << "25 November";
  EXPECT_EQ(file.software, "fleetmap 1.2");
  EXPECT_EQ(file.offset, crs_.offset().cast<double>());
  EXPECT_EQ(file.wkt(), crs_.wkt());
  EXPECT_THAT(file.text(), AllOf(HasSubstr(crs_.text()), HasSubstr("1 r1, 2 r2"), HasSubstr("times 257")));
  EXPECT_EQ(file.project[7] >> 4, 8) << "a GUID of version 8, the third group little-endian";
  EXPECT_EQ(file.project[8] >> 6, 2);
  T_enu_node_.begin()->second.translation().x() += 0.01;
  ASSERT_TRUE(write("moved.las"));
  EXPECT_NE(read_las(folder_.path() / "moved.las").project, file.project);
}

TEST_F(LasMap, TilesAddUpToTheWhole) {
  ASSERT_TRUE(write("map.las"));
  std::vector<Known> whole, tiled;
  for (const auto& point : read_las(folder_.path() / "map.las").points) whole.push_back(known(point));
  const auto written = write("tiles", 50);
  ASSERT_TRUE(written) << written.error().message;
  std::set<std::array<std::uint8_t, 16>> projects;
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(folder_.path() / "tiles")) {
    const LasFile file = read_las(entry.path());
    projects.insert(file.project);
    ++files;
    const std::int64_t east = std::stoll(entry.path().filename());
    for (const auto& point : file.points) {
      tiled.push_back(known(point));
      EXPECT_GE(tiled.back()[0], east * 1000);
      EXPECT_LT(tiled.back()[0], (east + 50) * 1000);
    }
  }
  EXPECT_GT(files, 3u);
  EXPECT_EQ(files, written->files);
  EXPECT_EQ(projects.size(), 1u) << "files of one map";
  std::ranges::sort(whole);
  std::ranges::sort(tiled);
  EXPECT_TRUE(whole == tiled);
  EXPECT_EQ(written->points, whole.size());
}

TEST_F(LasMap, WithoutAPointItIsRefusedAndNotWritten) {
  const auto poses = std::exchange(T_enu_node_, {});
  const auto none = write("map.las");
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("no submap of its nodes is held"));
  T_enu_node_ = poses;
  for (auto& [id, T] : T_enu_node_) T.translation().x() = 3e7;
  const auto far = write("map.las");
  ASSERT_FALSE(far);
  EXPECT_THAT(far.error().message, HasSubstr("all are too far from the origin for LAS"));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "map.las"));
}

TEST_F(LasMap, APoseFarAwayOrDamagedLosesItsPointsAndNothingElse) {
  const auto whole = write("map.las");
  T_enu_node_.begin()->second.translation().x() = 3e7;  // beyond the Earth
  T_enu_node_.rbegin()->second.translation().y() = std::numeric_limits<double>::quiet_NaN();
  const auto written = write("damaged.las");
  ASSERT_TRUE(whole && written);
  EXPECT_EQ(written->outline.unreadable.size(), 1u);
  EXPECT_GT(written->left_out, 0u);
  EXPECT_GT(written->points, whole->points / 2);
  EXPECT_LT(written->points, whole->points);
  EXPECT_EQ(read_las(folder_.path() / "damaged.las").points.size(), written->points);
}

TEST(LasIntensity, FillsSixteenBitsWhateverTheDeviceSends) {
  EXPECT_EQ(las_intensity_gain(0.0f), 65535.0);
  EXPECT_EQ(las_intensity_gain(1.0f), 65535.0) << "fractions";
  EXPECT_EQ(las_intensity_gain(1.5f), 257.0) << "8 bits";
  EXPECT_EQ(las_intensity_gain(255.0f), 257.0);
  EXPECT_EQ(las_intensity_gain(256.0f), 1.0) << "16 bits";
}

}  // namespace
}  // namespace fleetmap::output
