// The same fleet as four processes over DDS: two agents, two replays at the rate of the recording.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "apps/kitti_drive.hpp"
#include "bus/dds_domains.hpp"
#include "fleetmap/monitor/preview_writer.hpp"
#include "fleetmap/store/store.hpp"
#include "support/command_line.hpp"
#include "support/eventually.hpp"
#include "support/process.hpp"
#include "support/shared_data.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap {
namespace {

constexpr auto kMappedWithin = std::chrono::minutes(5);

class AgentRun : public ::testing::Test {
 protected:
  void SetUp() override {
    drive_ = testing::shared_data(testing::kKittiDrive);
    if (!drive_) GTEST_SKIP() << "recording " << testing::kKittiDrive << " is not here";
    write_config("r1", 0, "[0, 95]", 1);
    write_config("r2", 1, "[60, 153]", 2);
  }

  static std::uint32_t domain(std::uint32_t offset) { return bus::testing::first_test_domain() + offset; }

  void write_config(const std::string& id, std::uint32_t index, const std::string& frames, int seed) {
    std::ofstream(folder_.path() / (id + ".yaml"))
        << "id: " << id << "\nfleet: [r1, r2]\ndirectory: " << (folder_.path() / id).string() << '\n'
        << "site: {origin: [49.011, 8.423, 112.8]}\n"
        << "lidar: {model: hdl64e, max_range: 40.0, min_range: 2.5}\n"
        << "imu: {translation: [-0.809, 0.320, -0.800], rotation_rpy_deg: [0.849, -0.116, -0.045]}\n"
        << "gps: {translation: [-0.809, 0.320, -0.800]}\nnodes: {spacing: 3.0}\n"
        << "spherize: {radius: 30.0}\n"
        << "dds:\n  qos: " << FLEETMAP_SOURCE_DIR << "/qos\n"
        << "  onboard: {domain: " << domain(index) << "}\n"
        << "  long_range: {domain: " << domain(2) << ", peers: [127.0.0.1], address: 127.0.0.1}\n"
        << "  short_range: {domain: " << domain(3) << ", peers: [127.0.0.1], address: 127.0.0.1}\n"
        << "recording:\n  path: " << drive_->string() << "\n  frames: " << frames
        << "\n  gps_error: {sigma: 1.5, correlation_time: 60.0, seed: " << seed << "}\n";
  }
  std::string config(const std::string& id) const { return (folder_.path() / (id + ".yaml")).string(); }
  std::unique_ptr<testing::Process> agent(const std::string& id) {
    return std::make_unique<testing::Process>(
        std::vector<std::string>{testing::kProgram, "agent", "-c", config(id), "--exit-after-idle", "5"});
  }
  std::unique_ptr<testing::Process> replay(const std::string& id, const std::string& rate = "1") {
    return std::make_unique<testing::Process>(std::vector<std::string>{
        testing::kProgram, "replay", "-c", config(id), "--wait", "60", "--rate", rate});
  }
  std::size_t own_nodes(const std::string& id) const {
    const auto store = store::Store::open_read_only(folder_.path() / id / "store.db");
    return store ? store->node_set().size() : 0;
  }
  nlohmann::json report(const std::string& id) const {
    std::ifstream file(folder_.path() / id / "report.json");
    return file ? nlohmann::json::parse(file) : nlohmann::json{};
  }
  void expect_equal_complete_maps() {
    const auto r1 = report("r1");
    const auto r2 = report("r2");
    ASSERT_FALSE(r1.is_null());
    ASSERT_FALSE(r2.is_null());
    EXPECT_EQ(r1["map_hash"], r2["map_hash"]);
    EXPECT_EQ(r1["nodes"], r2["nodes"]);
    EXPECT_EQ(r1["missing_submaps"], 0);
    EXPECT_EQ(r2["missing_submaps"], 0);
    EXPECT_GT(r1["map_points"].get<std::size_t>(), 100'000u);
  }

  testing::TemporaryFolder folder_;
  std::optional<std::filesystem::path> drive_;
};

TEST_F(AgentRun, FourProcessesEndWithTheSameMap) {
  auto r1 = agent("r1");
  auto r2 = agent("r2");
  auto play1 = replay("r1");
  auto play2 = replay("r2");
  EXPECT_EQ(play1->wait(), 0) << play1->output();
  EXPECT_EQ(play2->wait(), 0) << play2->output();
  EXPECT_EQ(r1->wait(), 0) << r1->output();
  EXPECT_EQ(r2->wait(), 0) << r2->output();
  expect_equal_complete_maps();
  EXPECT_EQ(report("r1")["aligned_groups"].size(), 1u) << r1->output() << r2->output();
}

TEST_F(AgentRun, KilledAgentResumesFromItsStoreAndTheMapsComeOutEqual) {
  auto r1 = agent("r1");
  auto r2 = agent("r2");
  auto play1 = replay("r1");
  auto play2 = replay("r2", "0.6");  // so that there is something left to hear after the kill
  ASSERT_TRUE(testing::eventually([&] { return own_nodes("r2") >= 5; }, kMappedWithin))
      << r2->output() << play2->output();
  r2->signal(SIGKILL);
  EXPECT_EQ(r2->wait(), 128 + SIGKILL);
  const std::size_t held = own_nodes("r2");
  EXPECT_GE(held, 5u) << "what was stored survives the kill";
  r2 = agent("r2");
  EXPECT_EQ(play1->wait(), 0) << play1->output();
  EXPECT_EQ(play2->wait(), 0) << play2->output();
  EXPECT_EQ(r1->wait(), 0) << r1->output();
  EXPECT_EQ(r2->wait(), 0) << r2->output();
  EXPECT_NE(r2->output().find("session 1, going on from"), std::string::npos) << r2->output();
  const auto heard = report("r2")["sensors"];
  EXPECT_GT(heard["imu"].get<std::size_t>(), 0u) << "the second start heard the sensors";
  EXPECT_GT(heard["scans"].get<double>(), 0.8 * heard["imu"].get<double>()) << "large messages as small ones";
  const auto store = store::Store::open_read_only(folder_.path() / "r2" / "store.db");
  ASSERT_TRUE(store);
  std::set<std::uint16_t> sessions;
  monitor::PreviewWriter previews(folder_.path() / "r2" / "store.db.previews");
  for (const auto& [id, node] : store->nodes()) {
    EXPECT_TRUE(previews.keep(node.submap_hash)) << "the page has nothing to decode: " << to_string(id);
    if (id.agent.str() == "r2") sessions.insert(node.session);
  }
  EXPECT_EQ(sessions.size(), 2u) << r2->output();
  expect_equal_complete_maps();
}

}  // namespace
}  // namespace fleetmap
