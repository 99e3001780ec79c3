#include "fleetmap/monitor/live_status.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "monitor/views.hpp"
#include "store/items.hpp"

namespace fleetmap::monitor {
namespace {

using nlohmann::json;
using testing::agent;

json written(const LiveStatus& status, bool operated = false) {
  return json::parse(live_json(status, operated))["live"];
}

TEST(LiveStatus, robots_are_written_with_what_is_known_of_them) {
  LiveStatus status;
  status.self = agent("r1");
  status.lost_after_s = 60.0;
  RobotNow robot;
  robot.id = agent("r2");
  robot.activity = "drives row 7";
  robot.problems = {"no scan for 9 s"};
  robot.past = {{"no fix", false, 61.4}, {"its disk refused writes", true, std::nullopt}};
  robot.heard = {{"short_range", 0.42}, {"long_range", 3.0}};
  robot.battery = 0.615;
  robot.nodes = 12;
  robot.driven = robot.ordered_to_hold = true;
  robot.rows = {7, 9};
  robot.clock = {"gps", -2.048};
  robot.place = {geo_point_from_degrees(39.0, -3.25, 600.123), 1.5,
                 Stamp{std::chrono::milliseconds(1234560)}};
  status.robots = {robot};
  const json live = written(status);
  EXPECT_EQ(live["self"], "r1");
  EXPECT_EQ(live["lost_after_s"], 60.0);
  const json& one = live["robots"].at(0);
  EXPECT_EQ(one["id"], "r2");
  EXPECT_EQ(one["activity"], "drives row 7");
  EXPECT_EQ(one["problems"], json({"no scan for 9 s"}));
  EXPECT_EQ(one["past_problems"], json::parse(R"([{"text": "no fix", "total": false, "seconds_ago": 61.0},
      {"text": "its disk refused writes", "total": true, "seconds_ago": null}])"));
  EXPECT_EQ(one["heard"], json::parse(R"([{"link": "short_range", "seconds_ago": 0.4},
                                          {"link": "long_range", "seconds_ago": 3.0}])"));
  EXPECT_EQ(one["battery"], 0.615);
  EXPECT_TRUE(one["sigma_m"].is_null()) << "not known";
  EXPECT_EQ(one["nodes"], 12);
  EXPECT_EQ(one["driven"], true);
  EXPECT_EQ(one["ordered_to_hold"], true);
  EXPECT_EQ(one["called_home"], false);
  EXPECT_EQ(one["rows"], json({7, 9}));
  EXPECT_EQ(one["place"].dump(), "[39.0,-3.25,600.12,1.5,1234.56]");
  EXPECT_EQ(one["clock"], json({{"sensor", "gps"}, {"behind_s", -2.048}}));
}

TEST(LiveStatus, radio_and_sensors_are_written) {
  LiveStatus status;
  status.sensors = {{"lidar", 100, 9.96, -0.25, std::nullopt, 0.0, {{"no points", true}}}};
  status.radio.who_may_join = "anyone";
  status.radio.sent = 310.04;
  status.radio.share = 1812.5;
  status.radio.queues = {{"cloud", 3, 1}};
  status.radio.kinds = {{"long_range", "node", 120.0, 60.0}};
  status.radio.peers = {{agent("r2"), "long_range", 60.0, 0.125, 0.02}};
  status.radio.missing_submaps = 2;
  status.radio.missing_bytes = 5000;
  const json live = written(status);
  EXPECT_EQ(live["sensors"], json::parse(R"([{"name": "lidar", "samples": 100, "per_second": 10.0,
                                              "clock_behind_s": -0.25, "clock_slow_ppm": null,
                                              "findings": [{"text": "no points", "over": true}]}])"));
  const json& radio = live["radio"];
  EXPECT_EQ(radio["who_may_join"], "anyone");
  EXPECT_EQ(radio["sent"], 310.0);
  EXPECT_EQ(radio["share"], 1812.5);
  EXPECT_TRUE(radio["backlog_s"].is_null());
  EXPECT_EQ(radio["queues"], json::parse(R"([{"priority": "cloud", "waiting": 3, "dropped": 1}])"));
  EXPECT_EQ(radio["kinds"],
            json::parse(R"([{"link": "long_range", "kind": "node", "sent": 120.0, "received": 60.0}])"));
  EXPECT_EQ(radio["peers"], json::parse(R"([{"robot": "r2", "link": "long_range", "received": 60.0,
                                             "loss": 0.125, "delay_s": 0.02}])"));
  EXPECT_EQ(radio["missing_bytes"], 5000);
  EXPECT_TRUE(radio["seconds_to_equal_map"].is_null()) << "none arrive";
}

TEST(LiveStatus, time_until_maps_are_equal_is_written) {
  LiveStatus status;
  status.maps = {agent("r3"), 20, 299.6, {agent("r2")}};
  EXPECT_EQ(written(status)["maps"], json::parse(R"({"last": "r3", "missing_submaps": 20,
                                                     "seconds_to_equal": 300.0, "not_counted": ["r2"]})"));
  status.maps = {};
  EXPECT_TRUE(written(status)["maps"]["last"].is_null());
  EXPECT_TRUE(written(status)["maps"]["seconds_to_equal"].is_null());
}

TEST(LiveStatus, tells_whether_orders_may_be_given) {
  EXPECT_EQ(written({}, false)["operated"], false);
  EXPECT_EQ(written({}, true)["operated"], true);
}

}  // namespace
}  // namespace fleetmap::monitor
