#include "fleetmap/planning/geojson.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "planning/sites.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::planning {
namespace {

using ::testing::HasSubstr;

LocalFrame site_frame() { return LocalFrame(geo_point_from_degrees(48.1, 11.6, 520.0)); }

std::string collection(const std::string& features, const std::string& more = "") {
  return "{\"type\": \"FeatureCollection\"," + more + "\"features\": [" + features + "]}";
}
std::string line(const std::string& coordinates, const std::string& properties = "{}") {
  return "{\"type\": \"Feature\", \"properties\": " + properties +
         ", \"geometry\": {\"type\": \"LineString\", \"coordinates\": " + coordinates + "}}";
}
std::string error_of(const std::string& text) {
  const auto mission = parse_geojson(text, "m.geojson", site_frame());
  return mission ? "no error" : mission.error().message;
}

TEST(GeoJson, WhatIsWrittenIsReadAgain) {
  std::mt19937_64 random(1);
  Mission mission;
  for (RowId id = 0; id < 20; ++id) {
    Row row{id * 3 + 1, {}};
    for (int k = 0; k < 5; ++k) {
      row.waypoints.push_back(
          {4000.0 * testing::uniform(random) - 2000.0, 4000.0 * testing::uniform(random) - 2000.0});
    }
    mission.rows.push_back(row);
    mission.keep_out.push_back({{id * 10.0, 0.0}, {id * 10.0 + 5.0, 0.0}, {id * 10.0, 5.0}});
  }
  for (const auto& [frame, error] : {std::pair{FileFrame::kEnu, 1e-5}, {FileFrame::kWgs84, 1e-3}}) {
    const auto again = parse_geojson(to_geojson(mission, site_frame(), frame), "m", site_frame());
    ASSERT_TRUE(again) << again.error().message;
    ASSERT_EQ(again->rows.size(), mission.rows.size());
    ASSERT_EQ(again->keep_out.size(), mission.keep_out.size());
    for (std::size_t k = 0; k < mission.rows.size(); ++k) {
      EXPECT_EQ(again->rows[k].id, mission.rows[k].id);
      for (std::size_t p = 0; p < 5; ++p) {
        EXPECT_LT((again->rows[k].waypoints[p] - mission.rows[k].waypoints[p]).norm(), error);
      }
      for (std::size_t p = 0; p < 3; ++p) {
        EXPECT_LT((again->keep_out[k][p] - mission.keep_out[k][p]).norm(), error);
      }
    }
  }
}

TEST(GeoJson, RowsAreNumberedByPropertyOrInOrder) {
  const auto mission =
      parse_geojson(collection(line("[[0,0],[10,0]]") + "," + line("[[0,5],[10,5]]", "{\"row\": 0}") + "," +
                                   line("[[0,9],[10,9]]", "{\"id\": 7}"),
                               "\"frame\": \"enu\","),
                    "m", site_frame());
  ASSERT_TRUE(mission) << mission.error().message;
  EXPECT_EQ(mission->rows[0].id, 1u);
  EXPECT_EQ(mission->rows[1].id, 0u);
  EXPECT_EQ(mission->rows[2].id, 7u);
  EXPECT_EQ(mission->rows[2].waypoints[1], Eigen::Vector2d(10.0, 9.0));
}

TEST(GeoJson, SwappedCoordinatesAreRecognised) {
  EXPECT_THAT(error_of(collection(line("[[11.6, 48.1], [48.1, 11.6]]"))),
              AllOf(HasSubstr("m.geojson: feature 0: waypoint 1 is"),
                    HasSubstr("km away from the site origin"), HasSubstr("latitude and longitude swapped")));
  EXPECT_THAT(error_of(collection(line("[[11.6, 48.1], [11.6, 148.1]]"))), HasSubstr("swapped"));
}

TEST(GeoJson, ErrorsNameThePlaceAndTheRemedy) {
  EXPECT_THAT(error_of("{\n\n\"type\": oops"), HasSubstr("m.geojson:3: not valid JSON"));
  EXPECT_THAT(error_of("[]"), HasSubstr("FeatureCollection"));
  EXPECT_THAT(error_of("{\"type\": 3}"), HasSubstr("FeatureCollection"));
  EXPECT_THAT(error_of(collection("")), HasSubstr("no rows"));
  EXPECT_THAT(error_of(collection(line("[[11.6, 48.1]]"))), HasSubstr("two waypoints"));
  EXPECT_THAT(error_of(collection(line("[[11.6, \"x\"], [1, 2]]"))), HasSubstr("waypoint 0 must be"));
  EXPECT_THAT(error_of(collection(line("[[0,0],[1,1]]"), "\"frame\": \"utm\",")), HasSubstr("frame"));
  EXPECT_THAT(error_of(collection(line("[[11.6,48.1],[11.6,48.101]]", "{\"row\": -1}"))),
              HasSubstr("whole number"));
  EXPECT_THAT(error_of(collection(line("[[11.6,48.1],[11.6,48.101]]", "{\"row\": 1}") + "," +
                                  line("[[11.6,48.1],[11.6,48.101]]", "{\"row\": 1}"))),
              HasSubstr("feature 1: row 1 is there twice"));
  EXPECT_THAT(error_of("{\"type\":\"FeatureCollection\",\"features\":" + std::string(100'000, '[')),
              HasSubstr("too deeply"));
}

TEST(GeoJson, AnyCutOfAFileIsRefusedOrRead) {
  const std::string text = to_geojson(testing::site({}), site_frame());
  for (std::size_t length = 0; length < text.size(); length += 97) {
    EXPECT_FALSE(parse_geojson(text.substr(0, length), "m", site_frame())) << length;
  }
}

TEST(GeoJson, AMissionIsMadeOfLanesOrOfAFile) {
  fleetmap::testing::TemporaryFolder folder;
  SitePlan plan;
  plan.lanes = {{{0, 0}, {100, 0}}, {{0, 8}, {100, 8}}, {{0, 16}, {100, 16}}};
  plan.bounds = SiteBounds{{-20, -20}, {120, 40}};
  MissionConfig config;
  config.lanes = {2, 40.0};
  const auto lanes = make_mission(config, plan, site_frame());
  ASSERT_TRUE(lanes) << lanes.error().message;
  EXPECT_EQ(lanes->rows.size(), 6u);  // lanes 0 and 2 in three pieces each
  EXPECT_EQ(lanes->rows[5].waypoints.back(), Eigen::Vector2d(100.0, 16.0));

  config.waypoints = (folder.path() / "rows.geojson").string();
  EXPECT_FALSE(make_mission(config, plan, site_frame()));
  ASSERT_TRUE(write_geojson(config.waypoints, *lanes, site_frame()));
  const auto file = make_mission(config, plan, site_frame());
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_EQ(file->rows.size(), 6u);
  plan.bounds->high.x() = 90.0;
  const auto outside = make_mission(config, plan, site_frame());
  ASSERT_FALSE(outside);
  EXPECT_THAT(outside.error().message, AllOf(HasSubstr("rows.geojson"), HasSubstr("row 2, waypoint 1"),
                                             HasSubstr("outside the site")));
}

}  // namespace
}  // namespace fleetmap::planning
