// Mistakes in the input of the twin: each is refused before anything is simulated, with file, line and
// remedy.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <regex>

#include "apps/small_twin.hpp"
#include "fleetmap/config/world_file.hpp"
#include "support/command_line.hpp"
#include "support/file_content.hpp"
#include "support/process.hpp"

namespace fleetmap {
namespace {

using ::testing::HasSubstr;

constexpr int kBadConfiguration = 78;

class TwinSetup : public ::testing::Test {
 protected:
  /// `fleetmap run` and `fleetmap check-config` both refuse it.
  void refused(const std::vector<std::string>& says) {
    const auto run = twin_.run("out", {"--threads", "1"});
    testing::Process check({testing::kProgram, "check-config", twin_.path("fleet.yaml").string()});
    EXPECT_EQ(run.exit_code, kBadConfiguration) << run.output;
    EXPECT_EQ(check.wait(), kBadConfiguration) << check.output();
    for (const std::string& text : says) {
      EXPECT_THAT(run.output, HasSubstr(text));
      EXPECT_THAT(check.output(), HasSubstr(text));
    }
    EXPECT_FALSE(std::filesystem::exists(twin_.path("out"))) << "nothing was begun";
  }
  void mesh_world(const std::string& name, const std::string& content) const {
    twin_.write(name, content);
    twin_.write("world.yaml", "kind: mesh\npath: " + name + "\naisles: [[[0, 1], [20, 1]]]\n");
  }
  std::string text_of(const std::string& name) const { return testing::file_text(twin_.path(name)); }
  void mission(const std::string& geojson) const {
    twin_.write("rows.geojson", geojson);
    replace("fleet.yaml", "mission: \\{every", "mission: {file: rows.geojson, every");
  }
  void replace(const std::string& name, const std::string& what, const std::string& with) const {
    twin_.write(name, std::regex_replace(text_of(name), std::regex(what), with));
  }

  testing::SmallTwin twin_;
};

TEST_F(TwinSetup, RowsTooNearForARobot) {
  replace("world.yaml", "row_pitch: 7", "row_pitch: 3");
  refused({"world.yaml:6: row_pitch", "raise row_pitch or lower table_width"});
}

TEST_F(TwinSetup, AWallIsNoGround) {
  mesh_world("wall.obj", "v 0 0 0\nv 20 0 0\nv 20 0 5\nv 0 0 5\nf 1 2 3\nf 1 3 4\n");
  refused(
      {"world.yaml:2: path: ", "wall.obj: this world cannot be driven", "give the mesh in metres with z up"});
}

TEST_F(TwinSetup, AMeshThatIsCutOff) {
  mesh_world("cut.obj", "v 0 0 0\nv 20 0 0\nv 2");
  refused({"cut.obj:3: expected three numbers", "repair the line or export the mesh again"});
  mesh_world("cut.ply",
             "ply\nformat binary_little_endian 1.0\nelement vertex 100\nproperty float x\nproperty float y\n"
             "property float z\nelement face 3\nproperty list uchar int vertex_indices\nend_header\nabc");
  refused({"cut.ply:3: ", "it is cut off or damaged, copy or export it again"});
  mesh_world("noise.ply", "this is no mesh");
  refused({"noise.ply"});
  std::filesystem::remove(twin_.path("noise.ply"));
  refused({"noise.ply: no such file; give a .obj or .ply mesh"});
}

TEST_F(TwinSetup, AMeshWithoutLanesNeedsWaypoints) {
  mesh_world("flat.obj", "v -20 -20 0\nv 20 -20 0\nv 20 20 0\nv -20 20 0\nf 1 2 3\nf 1 3 4\n");
  twin_.write("world.yaml", "kind: mesh\npath: flat.obj\n");
  refused({"world.yaml: the world has no aisles",
           "give the mission a drawing with rows (mission.file: SITE.geojson)"});
}

TEST_F(TwinSetup, ThingsThatHaveNoRoom) {
  twin_.write_fleet("", {}, ", unknown_obstacles: 500");
  refused({"fleet.yaml:4: mission.unknown_obstacles: there is no room for 500 parked things"});
}

TEST_F(TwinSetup, TheKeyThatNamedWaypoints) {
  twin_.write_fleet("", {}, ", waypoints: aisles");
  refused(
      {"fleet.yaml:4: mission.waypoints: is not a key any more; name the site's drawing with file: "
       "SITE.geojson"});
}

TEST_F(TwinSetup, WaypointsOutsideTheWorld) {
  mission(
      R"({"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {}, "geometry":
          {"type": "LineString", "coordinates": [[-3.0, 39.0], [-3.0, 39.01]]}}]})");
  refused({"rows.geojson: row 0, waypoint 1 at (0.0, 1110.3) m is 1080 m outside the site",
           "correct the waypoint"});
  mission(R"({"type": "FeatureColl)");
  refused({"rows.geojson:1: not valid JSON"});
}

TEST_F(TwinSetup, ARobotInsideAPanel) {
  const auto world = config::make_world(twin_.path("world.yaml"));
  ASSERT_TRUE(world);
  std::string start;
  for (const sim::Footprint& thing : (*world)->drawing().keep_out) {
    for (const Eigen::Vector2d& corner : thing) {
      if ((*world)->blocked(corner, 0.2))
        start = std::to_string(corner.x()) + ", " + std::to_string(corner.y());
    }
  }
  ASSERT_FALSE(start.empty());
  twin_.write_fleet("", {"", "robot: {start: [" + start + ", 0]}"});
  refused(
      {"fleet.yaml:14: agents[1].robot.start: [", "is inside something or too near to it", "set start to ["});
}

TEST_F(TwinSetup, TwoRobotsInOnePlace) {
  const auto world = config::make_world(twin_.path("world.yaml"));
  ASSERT_TRUE(world);
  const Eigen::Vector2d p = (*world)->aisles().front().from;
  const std::string x = std::to_string(p.x()), y = std::to_string(p.y()), near = std::to_string(p.x() + 0.2);
  twin_.write_fleet(
      "", {"robot: {start: [" + x + ", " + y + ", 0]}", "", "robot: {start: [" + near + ", " + y + ", 90]}"});
  refused({"agents[2].robot.start: is 0.20 m from that of r1", "move it, or leave start out"});
}

TEST_F(TwinSetup, ALidarTooSlowToDriveBy) {
  replace("lidar.yaml", "rate: 5", "rate: 3");
  refused({"lidar_rate: a robot that drives a mission", "set at least 5 Hz"});
}

TEST_F(TwinSetup, MoreRobotsThanRows) {
  replace("fleet.yaml", "every: 1", "every: 3");
  refused({"fleet.yaml:4: mission: ", "3 robots for 1 rows; take fewer robots"});
}

TEST_F(TwinSetup, ASensorThatIsNotThere) {
  replace("fleet.yaml", "lidar: lidar.yaml", "lidar: none.yaml");
  refused({"fleet.yaml:10: defaults.robot.lidar: ", "none.yaml: no such file"});
}

TEST_F(TwinSetup, AClearanceThatNoAisleHas) {
  twin_.write_fleet("", {}, ", clearance: 5");
  refused({"fleet.yaml:", "can't be driven", "m off every keep-out; lower `clearance`"});
}

TEST_F(TwinSetup, ASensorThatIsNone) {
  replace("lidar.yaml", "columns: 900", "colums: 900");
  refused({"lidar.yaml:4: colums: unknown key; did you mean 'columns'?"});
}

TEST_F(TwinSetup, BrokenYaml) {
  twin_.write("fleet.yaml", text_of("fleet.yaml") + "  - {id: r4\n");
  refused({"fleet.yaml:", "not valid YAML"});
}

TEST_F(TwinSetup, AMissionWithoutAWorld) {
  replace("fleet.yaml", "world: \\{file: world.yaml\\}\n", "");
  refused({"fleet.yaml:3: mission: of a fleet is for the twin, which needs world: {file: WORLD.yaml}"});
}

TEST_F(TwinSetup, AWorldThatIsNotThere) {
  std::filesystem::remove(twin_.path("world.yaml"));
  refused({"world.yaml: no such file"});
}

TEST_F(TwinSetup, ARadioThatIsSilentForAStranger) {
  twin_.write_fleet("network: {blackouts: [{link: short_range, from: 1, until: 2, agent: r9}]}\n");
  refused({"network.blackouts: agent 'r9' is not in agents"});
  twin_.write_fleet("network: {blackouts: [{link: onboard, from: 3, until: 2}]}\n");
  refused({"network.blackouts[0].link: expected short_range or long_range, found 'onboard'",
           "network.blackouts[0].until: expected 0 <= from < until"});
}

}  // namespace
}  // namespace fleetmap
