#include "fleetmap/run_evaluation/map_pictures.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "support/file_content.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::run_evaluation {
namespace {

/// Flat ground of 10 m x 10 m, a point every half metre.
cloud::PointCloud ground() {
  cloud::PointCloud cloud;
  for (int x = 0; x <= 20; ++x) {
    for (int y = 0; y <= 20; ++y)
      cloud.points.emplace_back(0.5f * static_cast<float>(x), 0.5f * static_cast<float>(y), 0.0f);
  }
  return cloud;
}

bool is_png(const std::vector<std::uint8_t>& bytes) {
  return bytes.size() > 8 && bytes[0] == 0x89 && bytes[1] == 'P' && bytes[2] == 'N' && bytes[3] == 'G';
}

TEST(MapPictures, RobotsHaveDifferentColours) {
  store::MergedMap map;
  map.cloud = ground();
  map.agents = {AgentId::parse("r1").value(), AgentId::parse("r2").value()};
  map.observed_by.assign(map.cloud.size(), 0);
  const auto one = pictures_by_robot(map);
  ASSERT_TRUE(one) << one.error().message;
  ASSERT_EQ(one->size(), 2u);
  EXPECT_EQ((*one)[0].file, "map_top.png");
  EXPECT_EQ((*one)[1].file, "map_perspective.png");
  EXPECT_TRUE(is_png((*one)[0].png));
  std::fill(map.observed_by.begin() + 200, map.observed_by.end(), std::uint8_t{1});
  const auto both = pictures_by_robot(map);
  ASSERT_TRUE(both);
  EXPECT_NE((*one)[0].png, (*both)[0].png);
}

TEST(MapPictures, PathsLieAboveTheMap) {
  const cloud::PointCloud map = ground();
  const std::vector<std::string> robots{"r1"};
  const auto without = picture_with_paths(map, robots, {{}});
  ASSERT_TRUE(without) << without.error().message;
  EXPECT_TRUE(is_png(without->png));
  // Below the ground, where it would be hidden if it were drawn at its height.
  const auto with = picture_with_paths(map, robots, {{{2.0, 2.0, -1.0}, {8.0, 8.0, -1.0}}});
  ASSERT_TRUE(with);
  EXPECT_NE(without->png, with->png);
  const auto as_high = picture_with_paths(map, robots, {{{2.0, 2.0, 1.0}, {8.0, 8.0, 1.0}}});
  ASSERT_TRUE(as_high);
  EXPECT_EQ(with->png, as_high->png);
}

TEST(MapPictures, DensityByTilesIsThatOfTheWholeMap) {
  const cloud::PointCloud map = ground();
  const auto whole = picture_of_density(map, 2.0);
  ASSERT_TRUE(whole) << whole.error().message;
  std::vector<std::uint32_t> counts(map.size(), 0);
  for (const bool west : {true, false}) {
    cloud::PointCloud tile;
    for (const Eigen::Vector3f& p : map.points) {
      if ((p.x() < 5.0f) == west) tile.points.push_back(p);
    }
    add_density(map, tile, 2.0, counts);
  }
  const auto tiled = picture_of_density(map, counts, 2.0);
  ASSERT_TRUE(tiled);
  EXPECT_EQ(tiled->png, whole->png);
  EXPECT_FALSE(picture_of_density(cloud::PointCloud{}, std::vector<std::uint32_t>{}, 2.0));
}

TEST(MapPictures, ErrorsChangeThePicture) {
  const cloud::PointCloud map = ground();
  const auto small = picture_of_errors(map, std::vector<float>(map.size(), 0.01f));
  const auto large = picture_of_errors(map, std::vector<float>(map.size(), 0.25f));
  ASSERT_TRUE(small && large);
  EXPECT_NE(small->png, large->png);
}

TEST(MapPictures, APictureIsWrittenUnderItsName) {
  testing::TemporaryFolder folder;
  const MapPicture picture{"map_top.png", "", {1, 2, 3}};
  ASSERT_TRUE(write_picture(folder.path(), picture));
  EXPECT_EQ(testing::file_text(folder.path() / "map_top.png"), "\x01\x02\x03");
  EXPECT_FALSE(write_picture(folder.path() / "none", picture));
}

}  // namespace
}  // namespace fleetmap::run_evaluation
