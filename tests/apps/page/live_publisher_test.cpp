// Agents without sensors show each other on the page of one of them, which takes orders.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bus/dds_domains.hpp"
#include "monitor/browser.hpp"
#include "support/command_line.hpp"
#include "support/eventually.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using testing::Browser;
using testing::eventually;

constexpr const char* kToken = "0123456789abcdef";

class LivePublisher : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const std::uint32_t k : {1u, 2u}) {
      const std::string id = "r" + std::to_string(k);
      folder_.write(id + ".yaml",
                    "id: " + id + "\nfleet: [r1, r2]\ndirectory: " + (folder_.path() / id).string() +
                        "\nsite: {origin: [39.0, -3.0, 600.0]}\nlidar: {model: vlp16}\ndds:\n  qos: " +
                        FLEETMAP_SOURCE_DIR + "/qos\n  onboard: {domain: " + domain(1 + k) +
                        "}\n  long_range: {domain: " + domain(0) + kHere +
                        "  short_range: {domain: " + domain(1) + kHere);
    }
    folder_.write("token", kToken);
  }
  static std::string domain(std::uint32_t offset) {
    return std::to_string(bus::testing::first_test_domain() + offset);
  }
  std::unique_ptr<testing::Process> agent(const std::string& id, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{testing::kProgram, "agent", "-c",
                                       (folder_.path() / (id + ".yaml")).string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return std::make_unique<testing::Process>(arguments);
  }
  static std::string bearer() { return std::string("Authorization: Bearer ") + kToken + "\r\n"; }
  /// Null until the robot has published.
  static json live(std::uint16_t port) {
    Browser browser(port);
    browser.get("/live.json", bearer());
    const std::string answer = browser.answer();
    return json::parse(answer.substr(answer.find("\r\n\r\n") + 4), nullptr, false).value("live", json());
  }
  static json robot(std::uint16_t port, std::size_t index) {
    const json now = live(port);
    return now.is_null() ? now : now["robots"].at(index);
  }
  static std::string post(std::uint16_t port, const std::string& path, const std::string& headers) {
    Browser browser(port);
    browser.get(path, headers + "Content-Length: 0\r\n", "POST");
    return browser.status();
  }

  static constexpr const char* kHere = ", peers: [127.0.0.1], address: 127.0.0.1}\n";
  testing::TemporaryFolder folder_;
};

TEST_F(LivePublisher, ShowsTheOtherRobotOnceItIsHeardAndPassesOnOrders) {
  const auto r1 =
      agent("r1", {"--monitor", "0", "--monitor-token-file", (folder_.path() / "token").string()});
  ASSERT_TRUE(eventually([&] { return testing::announced_port(r1->output()) != 0; }, 60s)) << r1->output();
  const std::uint16_t port = testing::announced_port(r1->output());
  ASSERT_TRUE(eventually([&] { return !live(port).is_null(); }, 60s)) << r1->output();
  EXPECT_EQ(robot(port, 1)["activity"], "was not heard yet");
  EXPECT_EQ(live(port)["operated"], true);
  EXPECT_TRUE(robot(port, 1)["problems"].empty()) << "nothing is known of it yet";
  EXPECT_EQ(live(port)["sensors"].size(), 4u);
  const auto r2 = agent("r2");
  ASSERT_TRUE(eventually([&] { return robot(port, 1)["heard"].size() == 2; }, 60s)) << r1->output();
  const auto idle = [&] { return robot(port, 1)["activity"] == "has nothing left to map or to exchange"; };
  EXPECT_TRUE(eventually(idle, 60s)) << live(port);
  const auto tells = [&] { return robot(port, 1)["problems"].size() == 2; };
  EXPECT_TRUE(eventually(tells, 60s)) << "r2 has no sensors, and says so by radio: " << live(port);
  const json now = live(port);
  EXPECT_EQ(now["robots"][1]["problems"], (json{"no scan comes from its LiDAR", "its pose is not known"}));
  EXPECT_EQ(now["self"], "r1");
  EXPECT_GT(now["radio"]["share"].get<double>(), 0.0);
  EXPECT_EQ(now["radio"]["missing_submaps"], 0);
  EXPECT_EQ(now["radio"]["who_may_join"], "anyone");
  EXPECT_EQ(now["maps"]["seconds_to_equal"], 0.0) << "both hold nothing";
  EXPECT_TRUE(now["maps"]["not_counted"].empty());
  // Robots in contact use the Wi-Fi.
  const auto is_heard = [&] {
    const json radio = live(port)["radio"];
    return std::ranges::any_of(radio["peers"], [](const json& one) {
      return one["robot"] == "r2" && one["received"].get<double>() > 0.0;
    });
  };
  EXPECT_TRUE(eventually(is_heard, 60s)) << live(port);
  EXPECT_EQ(post(port, "/operator/hold", ""), "403");
  EXPECT_EQ(post(port, "/operator/hold?robot=r9", bearer()), "503");
  EXPECT_EQ(robot(port, 1)["ordered_to_hold"], false);
  EXPECT_EQ(post(port, "/operator/hold?robot=r2", bearer()), "202");
  EXPECT_TRUE(eventually([&] { return robot(port, 1)["ordered_to_hold"] == true; }, 60s));
  EXPECT_EQ(robot(port, 0)["ordered_to_hold"], false);
  EXPECT_EQ(post(port, "/operator/resume?robot=r2", bearer()), "202");
  EXPECT_TRUE(eventually([&] { return robot(port, 1)["ordered_to_hold"] == false; }, 60s));
  EXPECT_EQ(post(port, "/operator/home?robot=r2", bearer()), "202");
  EXPECT_TRUE(eventually([&] { return robot(port, 1)["called_home"] == true; }, 60s));
  EXPECT_EQ(robot(port, 1)["ordered_to_hold"], false);
  r1->signal(SIGTERM);
  EXPECT_TRUE(eventually([&] { return !r1->running(); }, 60s));
}

}  // namespace
}  // namespace fleetmap
