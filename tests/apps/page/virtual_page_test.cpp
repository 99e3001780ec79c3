// `fleetmap run --monitor` shows virtual time live, and takes orders.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/small_twin.hpp"
#include "monitor/browser.hpp"
#include "support/command_line.hpp"
#include "support/eventually.hpp"
#include "support/process.hpp"

namespace fleetmap {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using testing::Browser;
using testing::eventually;

constexpr const char* kAuthorization = "Authorization: Bearer 0123456789abcdef\r\n";

class VirtualPage : public ::testing::Test {
 protected:
  VirtualPage() { twin_.write("token", "0123456789abcdef"); }
  std::unique_ptr<testing::Process> run() const {
    return std::make_unique<testing::Process>(std::vector<std::string>{
        testing::kProgram, "run", "-c", twin_.path("fleet.yaml").string(), "--agents", "2", "--out",
        twin_.path("out").string(), "--monitor", "0", "--monitor-token-file", twin_.path("token").string()});
  }
  json get(const std::string& path) const {
    Browser browser(port_);
    browser.get(path, kAuthorization);
    const std::string answer = browser.answer();
    return json::parse(answer.substr(answer.find("\r\n\r\n") + 4), nullptr, false);
  }
  /// Null until the fleet has published.
  json live() const { return get("/live.json").value("live", json()); }
  json robot(std::size_t index) const {
    const json now = live();
    return now.is_null() ? json::object({{"activity", ""}, {"heard", json::array()}})
                         : now["robots"].at(index);
  }
  std::string post(const std::string& path) const {
    Browser browser(port_);
    browser.get(path, std::string(kAuthorization) + "Content-Length: 0\r\n", "POST");
    return browser.status();
  }

  testing::SmallTwin twin_;
  std::uint16_t port_ = 0;
};

TEST_F(VirtualPage, ShowsTheFleetAndItsRadiosAndHoldsARobot) {
  const auto run = this->run();
  ASSERT_TRUE(eventually([&] { return (port_ = testing::announced_port(run->output())) != 0; }, 60s))
      << run->output();
  ASSERT_TRUE(eventually([&] { return !robot(1)["heard"].empty(); }, 60s)) << run->output();
  EXPECT_EQ(post("/operator/hold?robot=r9"), "503");
  ASSERT_EQ(post("/operator/hold?robot=r2"), "202");
  // The run does not end while r2 stands, so there is time to look.
  EXPECT_TRUE(eventually([&] { return get("/state.json").value("nodes", json::array()).size() > 2; }, 60s))
      << "the map grows from files that were not there when the run began";
  ASSERT_TRUE(eventually([&] { return robot(1)["activity"] == "stands still: an operator holds it"; }, 60s))
      << live();
  const auto talks = [&] {
    const json radio = live()["radio"];
    return radio["sent"].get<double>() > 0.0 && std::ranges::any_of(radio["peers"], [](const json& one) {
             return one["robot"] == "r2" && one["received"].get<double>() > 0.0 && one["delay_s"] > 0.0;
           });
  };
  EXPECT_TRUE(eventually(talks, 60s)) << live();
  const auto senses = [&] { return robot(1)["battery"] > 0.0 && live()["sensors"].at(0)["samples"] > 0; };
  EXPECT_TRUE(eventually(senses, 60s)) << live();
  const json now = live();
  EXPECT_EQ(now["self"], "r1");
  EXPECT_EQ(now["operated"], true);
  EXPECT_EQ(now["radio"]["who_may_join"], "members of the fleet");
  EXPECT_EQ(post("/operator/resume?robot=r2"), "202");
  const auto called = [&] { return robot(1)["activity"].get<std::string>().starts_with("was called home"); };
  EXPECT_EQ(post("/operator/give?robot=r2&row=0&to=r9"), "503");
  EXPECT_EQ(post("/operator/home?robot=r2"), "202");
  EXPECT_TRUE(eventually(called, 60s)) << live();
  EXPECT_EQ(post("/operator/resume?robot=r2"), "202");
  ASSERT_TRUE(eventually([&] { return !run->running(); }, 300s)) << run->output();
  EXPECT_EQ(run->wait(), 0) << run->output();
}

// Virtual time is deterministic, so a single message that a viewer caused would show.
TEST_F(VirtualPage, AViewerCostsNoMessageOnAnyRadio) {
  const std::vector<std::string> two{"--agents", "2", "--set", "max_time=20"};
  const auto alone = twin_.run("alone", two);
  ASSERT_TRUE(alone.report.is_object()) << alone.output;
  auto shown_run = two;
  shown_run.insert(shown_run.end(), {"--monitor", "0", "--monitor-token-file", twin_.path("token").string()});
  shown_run.insert(shown_run.begin(), {testing::kProgram, "run", "-c", twin_.path("fleet.yaml").string(),
                                       "--out", twin_.path("out").string()});
  testing::Process run(shown_run);
  ASSERT_TRUE(eventually([&] { return (port_ = testing::announced_port(run.output())) != 0; }, 60s))
      << run.output();
  Browser viewer(port_);
  viewer.upgrade("/live", std::string(kAuthorization) + "Origin: http://" + viewer.host() + "\r\n");
  ASSERT_NE(viewer.answer().find(" 101 "), std::string::npos);
  std::size_t statuses = 0, states = 0;
  for (std::string said = viewer.message(); !said.empty(); said = viewer.message()) {
    ++(said.find("\"live\"") < 5 ? statuses : states);
    if (states == 1 && statuses % 4 == 0) {
      EXPECT_TRUE(get("/state.json").is_object());
    }
  }
  run.wait();
  EXPECT_GT(statuses, 5u) << "once a virtual second";
  std::ifstream file(twin_.path("out") / "report.json");
  const json report = json::parse(file, nullptr, false);
  ASSERT_TRUE(report.is_object()) << run.output();
  ASSERT_FALSE(alone.report["links"].empty());
  // Messages, losses and bytes of each kind, robot and radio.
  EXPECT_EQ(report["links"], alone.report["links"]);
  for (const char* robot : {"r1", "r2"}) {
    const json &shown = report["agents"][robot]["exchange"],
               &unseen = alone.report["agents"][robot]["exchange"];
    EXPECT_GT(unseen["long_range_wire_bytes"], 0);
    EXPECT_EQ(shown, unseen) << robot;
  }
}

}  // namespace
}  // namespace fleetmap
