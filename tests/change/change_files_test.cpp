#include "fleetmap/change/change_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "fleetmap/cloud/file_io.hpp"
#include "support/file_content.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::change {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const GeoPoint kOrigin = geo_point_from_degrees(39.0, -3.0, 600.0);

Changes one_table_gone() {
  Changes changes;
  Change& gone = changes.changes.emplace_back();
  gone.kind = Kind::disappeared;
  gone.centre = {100.0, 200.0, 1.5};
  gone.size = {9.0, 4.0, 2.0};
  gone.heading_rad = std::numbers::pi / 2.0;  // north
  gone.cells = 400;
  gone.traversed = 100;
  gone.confidence = 0.75;
  gone.points = {{100.0f, 200.0f, 1.0f}, {101.0f, 200.0f, 1.0f}};
  changes.same = {{0.0f, 0.0f, 0.0f}};
  return changes;
}

TEST(ChangeFiles, GeoJsonHasThePlaceInWgs84AndUtm) {
  const auto json = nlohmann::json::parse(to_geojson(one_table_gone(), kOrigin));
  ASSERT_EQ(json["features"].size(), 1u);
  const auto& feature = json["features"][0];
  const double longitude = feature["geometry"]["coordinates"][0],
               latitude = feature["geometry"]["coordinates"][1];
  const GeoPoint place = geo_point_from_degrees(latitude, longitude, 600.0);
  EXPECT_NEAR((LocalFrame(kOrigin).to_enu(place).head<2>() - Eigen::Vector2d(100.0, 200.0)).norm(), 0.0,
              0.01);
  const auto& properties = feature["properties"];
  EXPECT_EQ(properties["kind"], "disappeared");
  EXPECT_EQ(properties["length_m"], 9.0);
  EXPECT_EQ(properties["azimuth_deg"], 0.0);
  EXPECT_EQ(properties["confidence"], 0.75);
  EXPECT_EQ(properties["traversed_share"], 0.25);
  EXPECT_EQ(properties["utm"]["epsg"], 32630);
  EXPECT_NEAR(properties["utm"]["easting"].get<double>(), 500'100.0, 0.2) << "the origin is on the meridian";
}

TEST(ChangeFiles, TheTableHasThePlaceOnEarthWhereItIsKnown) {
  EXPECT_THAT(to_table(one_table_gone(), kOrigin), HasSubstr("EPSG:32630 5001"));
  const std::string local = to_table(one_table_gone(), std::nullopt);
  EXPECT_THAT(local, HasSubstr("disappeared"));
  EXPECT_THAT(local, HasSubstr("100.00"));
  EXPECT_THAT(local, Not(HasSubstr("EPSG")));
}

TEST(ChangeFiles, ThePlyHoldsAllCells) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "changes.ply";
  ASSERT_TRUE(write_coloured(file, one_table_gone(), {"east, north, up"}));
  const auto cloud = cloud::read_cloud(file);
  ASSERT_TRUE(cloud) << cloud.error().message;
  ASSERT_EQ(cloud->size(), 3u);
  EXPECT_EQ(cloud->points[2], Eigen::Vector3f(101.0f, 200.0f, 1.0f));
  EXPECT_THAT(testing::file_text(file), HasSubstr("\ncomment east, north, up\n"));
}

}  // namespace
}  // namespace fleetmap::change
