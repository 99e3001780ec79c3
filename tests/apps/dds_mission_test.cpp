// Robots of the twin that drive the mission of their own files over DDS, as robots without a twin do: their
// agents have a drawing of the site, no world.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>

#include "bus/dds_domains.hpp"
#include "fleetmap/agent/trajectory_file.hpp"
#include "fleetmap/eval/trajectory.hpp"
#include "small_twin.hpp"
#include "support/eventually.hpp"
#include "support/process.hpp"

namespace fleetmap {
namespace {

using ::testing::HasSubstr;

const std::string kFleetmap = std::string(FLEETMAP_BINARY_DIR) + "/bin/fleetmap";
constexpr auto kPatience = std::chrono::minutes(4);

class DdsMission : public ::testing::Test {
 protected:
  void SetUp() override {
    twin_.write_fleet("dds: {base_domain: " + std::to_string(domain(0)) + ", qos: " + qos() + "}\n");
    testing::Process world({kFleetmap, "world", twin_.path("world.yaml").string(), "--out",
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
  /// m from where the robot's odometry began.
  double driven(const std::string& id) const {
    const auto poses = agent::read_trajectory(twin_.path(id) / "odometry.tum");
    return poses && !poses->empty() ? poses->back().T_w_base.translation().norm() : 0.0;
  }

  testing::SmallTwin twin_;
};

TEST_F(DdsMission, AgentsDriveTheirShareOfADrawing) {
  testing::Process sim({kFleetmap, "sim", "-c", file("fleet.yaml"), "--out", file("truth")});
  testing::Process r1({kFleetmap, "agent", "-c", file("r1.yaml")});
  testing::Process r2({kFleetmap, "agent", "-c", file("r2.yaml")});
  const bool drove = testing::eventually([&] { return driven("r1") > 8.0 && driven("r2") > 8.0; }, kPatience);
  for (testing::Process* agent : {&r1, &r2}) agent->signal(SIGINT);
  EXPECT_EQ(r1.wait(), 0) << r1.output();
  EXPECT_EQ(r2.wait(), 0) << r2.output();
  sim.signal(SIGINT);
  EXPECT_EQ(sim.wait(), 0) << sim.output();
  ASSERT_TRUE(drove) << r1.output() << r2.output() << sim.output();

  const auto end_of = [&](const std::string& id) -> Eigen::Vector2d {
    const auto truth = eval::read_tum(twin_.path("truth") / id / "truth.tum");
    if (!truth || truth->empty()) return Eigen::Vector2d::Zero();
    return truth->back().T_enu_base.translation().head<2>();
  };
  EXPECT_GT(std::abs(end_of("r1").y() - end_of("r2").y()), 4.0) << "each is in a lane of its own";
}

TEST_F(DdsMission, CheckConfigPlansAnAgentsMission) {
  const auto check = [&](const std::vector<std::string>& more, int code) {
    std::vector<std::string> arguments{kFleetmap, "check-config", file("r1.yaml")};
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
  testing::Process plan({kFleetmap, "plan", file("site/site.geojson"), "-c", file("fleet.yaml"), "--agents",
                         "2", "--out", file("plan.geojson")});
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
  testing::Process own({kFleetmap, "plan", file("site/site.geojson"), "-c", file("r2.yaml")});
  ASSERT_EQ(own.wait(), 0) << own.output();
  EXPECT_EQ(own.output(), plan.output().substr(0, own.output().size()));
  testing::Process many(
      {kFleetmap, "plan", file("site/site.geojson"), "-c", file("r2.yaml"), "--agents", "3"});
  EXPECT_EQ(many.wait(), 2);
  EXPECT_THAT(many.output(), HasSubstr("has only 2 robots"));
}

}  // namespace
}  // namespace fleetmap
