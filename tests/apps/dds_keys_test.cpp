// Agents of a fleet with keys as processes on this machine, beside one that has none.
#include <gmock/gmock.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "bus/dds_domains.hpp"
#include "monitor/browser.hpp"
#include "support/command_line.hpp"
#include "support/eventually.hpp"
#include "support/file_content.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr auto kNewsWithin = std::chrono::seconds(60);

class FleetWithKeys : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string folder = (folder_.path() / "keys").string();
    for (const std::vector<std::string>& arguments : std::initializer_list<std::vector<std::string>>{
             {"keys", "init"}, {"keys", "add", "r1"}, {"keys", "add", "r2"}}) {
      std::vector<std::string> command{testing::kProgram};
      command.insert(command.end(), arguments.begin(), arguments.end());
      command.insert(command.end(), {"--dir", folder});
      testing::Process process(command);
      ASSERT_EQ(process.wait(), 0) << process.output();
    }
  }
  std::string file(int robot, bool with_keys) const {
    const std::string name = std::string("r").append(std::to_string(robot));
    const std::uint32_t domain = bus::testing::first_test_domain();
    std::ostringstream text;
    text << "id: " << name << "\nfleet: [r1, r2" << (robot > 2 ? ", r3" : "")
         << "]\ndirectory: " << (folder_.path() / name).string() << "\nlidar: {model: vlp16}\n";
    if (with_keys) text << "keys: keys/" << name << '\n';
    text << "dds:\n  qos: " FLEETMAP_SOURCE_DIR "/qos\n  onboard: {domain: " << domain + 2 + robot % 4
         << "}\n  long_range: {domain: " << domain << ", peers: [127.0.0.1], address: 127.0.0.1}\n"
         << "  short_range: {enabled: false}\n";
    return folder_.write(name + ".yaml", text.str()).string();
  }
  void start(int robot, bool with_keys) {
    agents_.push_back(std::make_unique<testing::Process>(std::vector<std::string>{
        testing::kProgram, "agent", "-c", file(robot, with_keys), "--monitor", "0"}));
  }
  /// `radio.who_may_join` on the agent's page; empty until it has published.
  std::string who_may_join_of_page(std::size_t agent) const {
    const std::uint16_t port = testing::announced_port(agents_.at(agent)->output());
    if (port == 0) return {};
    testing::Browser browser(port);
    browser.get("/live.json");
    const std::string answer = browser.answer();
    const auto all =
        nlohmann::json::parse(answer.substr(std::min(answer.find('{'), answer.size())), nullptr, false);
    const auto who = nlohmann::json::json_pointer("/live/radio/who_may_join");
    return all.is_object() && all.contains(who) ? all[who].get<std::string>() : std::string();
  }
  bool says(std::size_t agent, const std::string& what) const {
    return testing::eventually([&] { return agents_.at(agent)->output().find(what) != std::string::npos; },
                               kNewsWithin);
  }
  std::string report_of(const char* robot) const {
    return testing::file_text(folder_.path() / robot / "report.json");
  }

  testing::TemporaryFolder folder_;
  std::vector<std::unique_ptr<testing::Process>> agents_;
};

TEST_F(FleetWithKeys, MembersKnowEachOtherAndNameWhoIsNone) {
  start(1, true);
  start(2, true);
  start(3, false);
  EXPECT_TRUE(says(0, "heard r2 at")) << agents_[0]->output();
  EXPECT_TRUE(says(1, "heard r1 at")) << agents_[1]->output();
  EXPECT_TRUE(says(0, "r3 has no keys")) << agents_[0]->output();
  EXPECT_TRUE(says(2, "no keys: anyone on the radios may join")) << agents_[2]->output();
  EXPECT_TRUE(says(0, "keys of r1 (robot), valid until"));
  for (const auto& agent : agents_) EXPECT_THAT(agent->output(), Not(HasSubstr("heard r3")));
  EXPECT_THAT(agents_[2]->output(), Not(HasSubstr("heard r")));
  for (std::size_t agent = 0; agent < agents_.size(); ++agent) {
    const char* who = agent < 2 ? "members of the fleet" : "anyone";
    EXPECT_TRUE(testing::eventually([&] { return who_may_join_of_page(agent) == who; }, kNewsWithin))
        << agent;
    EXPECT_EQ(agents_[agent]->output().find("anyone on the radios") == std::string::npos, agent < 2);
  }
  for (const auto& agent : agents_) agent->signal(SIGTERM);
  for (const auto& agent : agents_) agent->wait();
  EXPECT_THAT(report_of("r1"), HasSubstr("\"who_may_join\": \"members of the fleet\""));
  EXPECT_THAT(report_of("r1"), HasSubstr("r3 has no keys"));
  EXPECT_THAT(report_of("r3"), HasSubstr("\"who_may_join\": \"anyone\""));
}

TEST_F(FleetWithKeys, AnOperatorsProgramsUseTheRobotsKeys) {
  start(1, true);
  start(2, true);
  ASSERT_TRUE(says(0, "heard r2 at") && says(1, "heard r1 at"));
  testing::Process check({testing::kProgram, "check-config", "--network", "--seconds", "3", file(1, true)});
  EXPECT_EQ(check.wait(), 0) << check.output();
  testing::Process hold({testing::kProgram, "hold", "-c", file(1, true)});
  EXPECT_EQ(hold.wait(), 0) << hold.output();
  testing::Process stranger({testing::kProgram, "hold", "--timeout", "3", "-c", file(1, false)});
  EXPECT_EQ(stranger.wait(), 1) << "who has no keys orders nobody: " << stranger.output();
}

}  // namespace
}  // namespace fleetmap
