#include "fleetmap/planning/mission/plan_geojson.hpp"

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "fleetmap/planning/site/geojson.hpp"
#include "planning/sites.hpp"

namespace fleetmap::planning {
namespace {

using testing::site_frame;

TEST(PlanGeoJson, APlanShowsWhoDrivesWhatAndIsADrawingAgain) {
  testing::SiteSpec spec;
  spec.width = spec.depth = 80.0;
  const auto plan = plan_fleet(testing::site(spec), testing::fleet(2, false), {});
  ASSERT_TRUE(plan) << plan.error().message;
  const std::vector<std::string> colours = {"#112233", "#445566"};
  const std::string text = to_geojson(**plan, colours, site_frame());
  const auto features = nlohmann::json::parse(text)["features"];
  std::map<std::string, std::size_t> rows;
  std::set<std::string> routes;
  bool meeting = false;
  for (const auto& feature : features) {
    const auto& properties = feature["properties"];
    if (properties.contains("robot")) {
      ++rows[properties["robot"]];
      EXPECT_EQ(properties["stroke"], colours[properties["robot"] == "r1" ? 0 : 1]);
    }
    if (properties.contains("route")) routes.insert(properties["route"].get<std::string>());
    meeting |= properties.contains("meeting");
  }
  EXPECT_EQ(rows["r1"], (*plan)->division.routes[0].visits.size());
  EXPECT_EQ(rows["r2"], (*plan)->division.routes[1].visits.size());
  EXPECT_EQ(routes, (std::set<std::string>{"r1", "r2"}));
  EXPECT_TRUE(meeting);
  const auto again = parse_geojson(text, "plan", site_frame());
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->rows.size(), (*plan)->mission.rows.size());
  EXPECT_EQ(again->keep_out.size(), (*plan)->mission.keep_out.size());
  const auto first = first_position(text);
  ASSERT_TRUE(first);
  EXPECT_LT(site_frame().to_enu(*first).head<2>().norm(), 200.0);
  EXPECT_FALSE(first_position(to_geojson((*plan)->mission, site_frame(), FileFrame::kEnu)));
}

}  // namespace
}  // namespace fleetmap::planning
