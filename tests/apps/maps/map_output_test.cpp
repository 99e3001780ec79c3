#include <gmock/gmock.h>

#include "support/command_line.hpp"

namespace fleetmap {
namespace {

using ::testing::HasSubstr;

using MapOutput = testing::CommandLineTest;

TEST_F(MapOutput, StoreThatIsNoneIsRefused) {
  folder_.write("store.db", "this is no database, only text that is long enough to look at");
  run({"map", "info", path("store.db")});
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_, HasSubstr("store.db: is no store; give the store.db of a robot\n"));
  run({"map", "info", path(".")});
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_, HasSubstr("is a folder; give the store.db of a robot in it"));
  run({"map", "export", path("none.db"), "--out", path("map.ply")});
  EXPECT_EQ(exit_code_, 1);
}

TEST_F(MapOutput, OptionsThatDoNotFitTogetherExitWith2) {
  expect_usage_error({"map", "info", "s.db", "--json", "--without", "r1"},
                     "--json lists by robot, so it takes no --without");
  expect_usage_error(
      {"map", "export", "s.db", "--out", path("m.ply"), "--crs", "enu"},
      "m.ply: --crs and --geoid are of LAS and GeoTIFF: end it with .las, or add --format geotiff");
  expect_usage_error({"map", "export", "s.db", "--out", path("m.laz")}, "end it with .ply, .pcd or .las");
  expect_usage_error({"map", "export", "s.db", "--out", path("m.ply"), "--tile", "20"}, "--tile is of LAS");
  expect_usage_error({"map", "export", "s.db", "--out", path("m.tif"), "--format", "geotiff"},
                     "name a folder for them");
  expect_usage_error({"map", "picture", "s.db", "--out", path("m.png")}, "name a folder for them");
  for (const std::vector<std::string>& action : {std::vector<std::string>{"info"},
                                                 {"export", "--out", path("m.ply")},
                                                 {"picture", "--out", path("m")},
                                                 {"tracks", "--out", path("t.gpx")},
                                                 {"graph", "--out", path("g.g2o")}}) {
    std::vector<std::string> arguments{"map"};
    arguments.insert(arguments.end(), action.begin(), action.end());
    arguments.insert(arguments.end(), {"s.db", "--origin", "200,300,0"});
    expect_usage_error(arguments, "--origin is not on Earth");
    arguments.erase(arguments.end() - 2, arguments.end());
    arguments.insert(arguments.end(), {"--without", "r1,rX"});
    expect_usage_error(arguments, "--without: agent id 'rX' must be");
  }
}

}  // namespace
}  // namespace fleetmap
