#include "plan/plan_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "plan/fleet_to_plan.hpp"
#include "robot/mission_setup.hpp"
#include "support/file_content.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class PlanFilesTest : public ::testing::Test {
 protected:
  PlanFilesTest() {
    const std::string drawing = FLEETMAP_SOURCE_DIR "/config/sites/farm_200.geojson";
    auto fleet = fleet_to_plan(drawing, "", 2, {}).value();
    site_ = read_site(drawing, std::nullopt).value();
    plan_ = plan_on(site_.mission, std::move(fleet.robots), fleet.settings).value();
  }
  DrawnSite site_;
  std::shared_ptr<const planning::FleetPlan> plan_;
  testing::TemporaryFolder folder_;
};

TEST_F(PlanFilesTest, ThePlanIsInTheFrameOfItsDrawingAndThePictureBeside) {
  const auto out = folder_.path() / "plan.geojson";
  const auto picture = write_plan(*plan_, site_, out);
  ASSERT_TRUE(picture) << picture.error().message;
  EXPECT_EQ(*picture, folder_.path() / "plan.png");
  EXPECT_THAT(testing::file_text(*picture), StartsWith("\x89PNG"));
  const auto json = nlohmann::json::parse(testing::file_text(out));
  std::size_t routes = 0;
  for (const auto& feature : json["features"]) {
    if (!feature["properties"].contains("robot")) continue;
    ++routes;
    const auto& first = feature["geometry"]["coordinates"][0];
    EXPECT_NEAR(first[0].get<double>(), -3.0, 0.01) << "longitude, degrees";
    EXPECT_NEAR(first[1].get<double>(), 39.0, 0.01);
  }
  EXPECT_GE(routes, 2u);
}

TEST_F(PlanFilesTest, AFolderThatIsNotThereIsNamed) {
  const auto written = write_plan(*plan_, site_, folder_.path() / "none" / "plan.geojson");
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().message, HasSubstr("none/plan.geojson"));
}

}  // namespace
}  // namespace fleetmap::apps
