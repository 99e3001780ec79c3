// Robots of the twin that drive the mission of their own files over DDS, as robots without a twin do: their
// agents have a drawing of the site, no world.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <set>

#include "bus/dds_domains.hpp"
#include "fleetmap/eval/trajectory.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/output/trajectory_file.hpp"
#include "fleetmap/planning/site/geojson.hpp"
#include "small_twin.hpp"
#include "support/command_line.hpp"
#include "support/eventually.hpp"
#include "support/process.hpp"

namespace fleetmap {
namespace {

using ::testing::HasSubstr;

constexpr auto kMissionWithin = std::chrono::minutes(6);
/// Lanes lie 7 m apart; GPS errs by some 1 m, the drawing by 0.5 m, so the ends of a row may be missed.
constexpr double kBesideRow = 2.5, kMinShare = 0.8;

/// Share of a straight row that has a pose of the trajectory within kBesideRow.
double share_driven(const planning::Row& row, const output::Trajectory& truth) {
  constexpr int kSteps = 40;
  int near = 0;
  for (int k = 0; k <= kSteps; ++k) {
    const double along = static_cast<double>(k) / kSteps;
    const Eigen::Vector2d point = (1.0 - along) * row.waypoints.front() + along * row.waypoints.back();
    near += std::ranges::any_of(truth, [&](const output::StampedPose& pose) {
      return (pose.T_w_base.translation().head<2>() - point).norm() < kBesideRow;
    });
  }
  return static_cast<double>(near) / (kSteps + 1);
}

class DdsMission : public ::testing::Test {
 protected:
  void SetUp() override {
    twin_.write_fleet("dds: {base_domain: " + std::to_string(domain(0)) + ", qos: " + qos() + "}\n");
    testing::Process world({testing::kProgram, "world", twin_.path("world.yaml").string(), "--out",
                            twin_.path("site").string(), "--density", "1"});
    ASSERT_EQ(world.wait(), 0) << world.output();
    for (const std::uint32_t k : {1u, 2u}) {
      const std::string id = "r" + std::to_string(k);
      std::ofstream(twin_.path(id + ".yaml"))
          << "id: " << id << "\nfleet: [r1, r2]\ndirectory: " << id << "\n"
          << "site: {origin: [39.0, -3.0, 600.0]}\nmission: {file: site/site.geojson, speed: 1.5}\n"
          << "lidar: {model: vlp16, scan_period: 0.2, translation: [0, 0, 0.6], max_range: 40, min_range: "
             "0.6}\n"
          << "imu: {translation: [0, 0, 0.1]}\ngps: {translation: [-0.2, 0, 0.5]}\nnodes: {spacing: 5}\n"
          << "dds:\n  qos: " << qos() << "\n  onboard: {domain: " << domain(1 + k) << "}\n"
          << "  long_range: {domain: " << domain(0) << ", peers: [127.0.0.1], address: 127.0.0.1}\n"
          << "  short_range: {domain: " << domain(1) << ", peers: [127.0.0.1], address: 127.0.0.1}\n";
    }
  }

  static std::string qos() { return std::string(FLEETMAP_SOURCE_DIR) + "/qos"; }
  static std::uint32_t domain(std::uint32_t offset) { return bus::testing::first_test_domain() + offset; }
  std::string file(const std::string& name) const { return twin_.path(name).string(); }
  /// Reads which rows of the drawing the chassis of a robot truly drove along.
  std::set<planning::RowId> rows_driven(const std::string& id) const {
    const LocalFrame site(geo_point_from_degrees(39.0, -3.0, 600.0));
    const auto drawing = planning::read_geojson(twin_.path("site") / "site.geojson", site);
    const auto truth = output::read_tum(twin_.path("truth") / id / "truth.tum");
    EXPECT_TRUE(drawing && truth) << id;
    std::set<planning::RowId> rows;
    if (!drawing || !truth) return rows;
    for (const planning::Row& row : drawing->rows) {
      if (share_driven(row, *truth) >= kMinShare) rows.insert(row.id);
    }
    return rows;
  }

  testing::SmallTwin twin_;
};

TEST_F(DdsMission, AgentsDriveAllRowsOfADrawing) {
  testing::Process sim({testing::kProgram, "sim", "-c", file("fleet.yaml"), "--out", file("truth")});
  testing::Process r1({testing::kProgram, "agent", "-c", file("r1.yaml")});
  testing::Process r2({testing::kProgram, "agent", "-c", file("r2.yaml")});
  const auto is_done = [](const testing::Process& agent, const std::string& id) {
    return agent.output().find(id + ": done, 3 of 3 rows driven by the fleet, 0 to go") != std::string::npos;
  };
  const bool done =
      testing::eventually([&] { return is_done(r1, "r1") && is_done(r2, "r2"); }, kMissionWithin);
  for (testing::Process* agent : {&r1, &r2}) agent->signal(SIGINT);
  EXPECT_EQ(r1.wait(), 0) << r1.output();
  EXPECT_EQ(r2.wait(), 0) << r2.output();
  sim.signal(SIGINT);
  EXPECT_EQ(sim.wait(), 0) << sim.output();
  EXPECT_TRUE(done) << r1.output() << r2.output() << sim.output();

  // The rows are checked by the wheels, not by the robots' own reports.
  const std::set<planning::RowId> by_r1 = rows_driven("r1"), by_r2 = rows_driven("r2");
  std::set<planning::RowId> by_any = by_r1;
  by_any.insert(by_r2.begin(), by_r2.end());
  EXPECT_EQ(by_any.size(), 3u) << "a row was driven by nobody";
  EXPECT_LT(by_r1.size(), 3u) << "r1 drove the share of r2";
  EXPECT_LT(by_r2.size(), 3u) << "r2 drove the share of r1";
}

TEST_F(DdsMission, CheckConfigPlansAnAgentsMission) {
  const auto check = [&](const std::vector<std::string>& more, int code) {
    std::vector<std::string> arguments{testing::kProgram, "check-config", file("r1.yaml")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    testing::Process process(arguments);
    EXPECT_EQ(process.wait(), code) << process.output();
    return process.output();
  };
  EXPECT_THAT(check({}, 0), HasSubstr("a valid agent configuration with a mission: 2 robots, 3 rows"));
  EXPECT_THAT(check({"--set", "mission.every=3"}, 78),
              AllOf(HasSubstr("r1.yaml: mission: "), HasSubstr("2 robots for 1 rows; take fewer robots")));
}

TEST_F(DdsMission, APlanIsDrawnBeforeAnyoneDrives) {
  testing::Process plan({testing::kProgram, "plan", file("site/site.geojson"), "-c", file("fleet.yaml"),
                         "--agents", "2", "--out", file("plan.geojson")});
  ASSERT_EQ(plan.wait(), 0) << plan.output();
  EXPECT_THAT(plan.output(), AllOf(HasSubstr("r1: "), HasSubstr("r2: "), HasSubstr("all meet at 39.00"),
                                   Not(HasSubstr("r3: "))));
  std::ifstream written(twin_.path("plan.geojson"));
  const auto features = nlohmann::json::parse(written, nullptr, false)["features"];
  int routes = 0;
  for (const auto& feature : features) routes += feature["properties"].contains("route") ? 1 : 0;
  EXPECT_EQ(routes, 2);
  EXPECT_GT(std::filesystem::file_size(twin_.path("plan.png")), 1000u);
  // The same division as the agents of these robots compute from their own files.
  testing::Process own({testing::kProgram, "plan", file("site/site.geojson"), "-c", file("r2.yaml")});
  ASSERT_EQ(own.wait(), 0) << own.output();
  EXPECT_EQ(own.output(), plan.output().substr(0, own.output().size()));
  testing::Process many(
      {testing::kProgram, "plan", file("site/site.geojson"), "-c", file("r2.yaml"), "--agents", "3"});
  EXPECT_EQ(many.wait(), 2);
  EXPECT_THAT(many.output(), HasSubstr("has only 2 robots"));
}

}  // namespace
}  // namespace fleetmap
