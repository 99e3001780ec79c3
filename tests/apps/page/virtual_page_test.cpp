// `fleetmap run --monitor` shows virtual time live, and takes orders.
#include <gtest/gtest.h>

#include <algorithm>
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

}  // namespace
}  // namespace fleetmap
