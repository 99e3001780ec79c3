#include "plan/drawn_site.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fleetmap/geometry/degree.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::HasSubstr;

std::string row(const std::string& coordinates) {
  return R"({"type": "FeatureCollection", )"
         R"("features": [{"type": "Feature", "properties": {"row": 0}, "geometry": {"type": "LineString", )"
         R"("coordinates": [)" +
         coordinates + "]}}]}";
}

TEST(DrawnSite, ADrawingOnEarthIsPlannedAboutItsFirstPosition) {
  const testing::TemporaryFolder folder;
  folder.write("site.geojson", row("[8.4, 49.0], [8.401, 49.0]"));
  const std::string file = (folder.path() / "site.geojson").string();
  const auto first = first_position_of(file);
  ASSERT_TRUE(first);
  EXPECT_NEAR(first->latitude, 49.0 * kDegree, 1e-12);
  EXPECT_NEAR(first->longitude, 8.4 * kDegree, 1e-12);
  const auto site = read_site(file, std::nullopt);
  ASSERT_TRUE(site) << site.error().message;
  ASSERT_EQ(site->mission.rows.size(), 1u);
  EXPECT_LT(site->mission.rows[0].waypoints.front().norm(), 0.01);
  EXPECT_NEAR(site->mission.rows[0].waypoints.back().x(), 73.1, 0.5) << "a thousandth of a degree at 49 deg";
  EXPECT_EQ(place_text({0.0, 0.0}, *site), "49.000000, 8.400000 deg (latitude, longitude)");
}

TEST(DrawnSite, AGivenOriginIsThatOfEnu) {
  const testing::TemporaryFolder folder;
  folder.write("site.geojson", row("[8.4, 49.0], [8.401, 49.0]"));
  const auto site =
      read_site((folder.path() / "site.geojson").string(), GeoPoint{49.0 * kDegree, 8.401 * kDegree, 100.0});
  ASSERT_TRUE(site) << site.error().message;
  EXPECT_LT(site->mission.rows[0].waypoints.back().norm(), 0.01);
  EXPECT_LT(site->mission.rows[0].waypoints.front().x(), -70.0);
}

TEST(DrawnSite, AMissingFileIsNamed) {
  const testing::TemporaryFolder folder;
  const std::string file = (folder.path() / "none.geojson").string();
  EXPECT_FALSE(first_position_of(file));
  const auto site = read_site(file, std::nullopt);
  ASSERT_FALSE(site);
  EXPECT_THAT(site.error().message, HasSubstr(file));
}

}  // namespace
}  // namespace fleetmap::apps
