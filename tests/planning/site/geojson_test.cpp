#include "fleetmap/planning/site/geojson.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "fleetmap/planning/site/geojson_writer.hpp"
#include "planning/sites.hpp"

namespace fleetmap::planning {
namespace {

using ::testing::HasSubstr;
using testing::site_frame;

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

TEST(GeoJson, WrittenContentIsReadAgain) {
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
  // Brackets in a text close nothing.
  EXPECT_THAT(error_of("{\"name\":\"\\\"" + std::string(200'000, ']') +
                       "\",\"features\":" + std::string(200'000, '[') + std::string(200'000, ']') + "}"),
              HasSubstr("too deeply"));
}

TEST(GeoJson, AnyCutOfAFileIsRefusedOrRead) {
  const std::string text = to_geojson(testing::site({}), site_frame());
  for (std::size_t length = 0; length < text.size(); length += 97) {
    EXPECT_FALSE(parse_geojson(text.substr(0, length), "m", site_frame())) << length;
  }
}

TEST(GeoJson, ADrawingHasABoundaryAndPlacesToSetOutFrom) {
  const std::string ring = "[[[-20,-20],[120,-20],[120,40],[-20,40],[-20,-20]]]";
  const auto feature = [](const std::string& type, const std::string& coordinates,
                          const std::string& properties) {
    return R"({"type": "Feature", "properties": )" + properties + R"(, "geometry": {"type": ")" + type +
           R"(", "coordinates": )" + coordinates + "}}";
  };
  const std::string row = line("[[0,0],[100,0]]");
  const std::string boundary = feature("Polygon", ring, R"({"boundary": true})");
  const auto read = [&](const std::string& features) {
    return parse_geojson(collection(features, "\"frame\": \"enu\","), "m", site_frame());
  };
  const auto site = read(row + "," + boundary + "," + feature("Point", "[1, 2]", R"({"start": true})") + "," +
                         feature("Point", "[5, 6]", R"({"start": "r2"})") + "," +
                         feature("Point", "[7, 8]", R"({"name": "hydrant"})") + "," +
                         line("[[0,0],[9,9]]", R"({"route": "r1"})"));
  ASSERT_TRUE(site) << site.error().message;
  EXPECT_EQ(site->rows.size(), 1u) << "the route of a plan is no row";
  EXPECT_TRUE(site->keep_out.empty());
  ASSERT_TRUE(site->boundary);
  EXPECT_EQ(site->boundary->size(), 4u);
  EXPECT_EQ(site->starts.size(), 2u);
  EXPECT_EQ(site->start_of(testing::name(0)), Eigen::Vector2d(1.0, 2.0));
  EXPECT_EQ(site->start_of(testing::name(1)), Eigen::Vector2d(5.0, 6.0));
  EXPECT_EQ(read(row)->start_of(testing::name(0)), Eigen::Vector2d(0.0, 0.0)) << "the first waypoint";

  const auto again = parse_geojson(to_geojson(*site, site_frame()), "m", site_frame());
  ASSERT_TRUE(again) << again.error().message;
  ASSERT_TRUE(again->boundary);
  EXPECT_LT((again->boundary->at(2) - Eigen::Vector2d(120.0, 40.0)).norm(), 1e-3);
  EXPECT_LT((again->start_of(testing::name(1)) - Eigen::Vector2d(5.0, 6.0)).norm(), 1e-3);

  const auto error = [&](const std::string& features) {
    const auto wrong = read(row + "," + features);
    return wrong ? "no error" : wrong.error().message;
  };
  EXPECT_THAT(error(boundary + "," + boundary), HasSubstr("a second boundary"));
  EXPECT_THAT(error(feature("MultiPolygon", "[" + ring + "]", R"({"boundary": true})")),
              HasSubstr("one Polygon"));
  EXPECT_THAT(error(feature("Point", "[1, 2]", R"({"start": 3})")), HasSubstr("name of a robot"));
  EXPECT_THAT(error(feature("Point", "[1, 2]", R"({"start": "R 2"})")), HasSubstr("\"start\""));
  EXPECT_THAT(error(feature("Point", "[1, 2]", R"({"start": true})") + "," +
                    feature("Point", "[1, 3]", R"({"start": true})")),
              HasSubstr("two points for the common start"));
}

}  // namespace
}  // namespace fleetmap::planning
