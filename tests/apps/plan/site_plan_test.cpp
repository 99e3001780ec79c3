#include "plan/site_plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include "apps/plan/farm_site.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

PlanOptions options_for(const std::string& site) {
  PlanOptions options;
  options.site = site;
  return options;
}

CommandError refused(const PlanOptions& options) {
  std::ostringstream out;
  const auto planned = plan_site(options, out);
  EXPECT_FALSE(planned);
  return planned ? CommandError{} : planned.error();
}

TEST(SitePlan, IsPrintedAndWrittenWithAPicture) {
  const testing::TemporaryFolder folder;
  std::ostringstream out;
  PlanOptions options = options_for(kSite);
  options.out = (folder.path() / "plan.geojson").string();
  options.agents = 3;
  const auto planned = plan_site(options, out);
  ASSERT_TRUE(planned) << planned.error().error.message;
  EXPECT_EQ(*planned, kDone);
  EXPECT_THAT(out.str(), HasSubstr("r3: "));
  EXPECT_THAT(out.str(), HasSubstr("written to " + options.out + " and "));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "plan.geojson"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "plan.png"));
}

TEST(SitePlan, PlansTheFirstRobotsOfAFleetAndNoMoreThanItHas) {
  std::ostringstream out;
  PlanOptions options = options_for(kSite);
  options.config = FLEETMAP_SOURCE_DIR "/config/agents/r1.yaml";
  options.agents = 1;
  ASSERT_TRUE(plan_site(options, out));
  EXPECT_THAT(out.str(), HasSubstr("r1: "));
  EXPECT_THAT(out.str(), Not(HasSubstr("r2: ")));
  options.agents = 3;
  const CommandError error = refused(options);
  EXPECT_EQ(error.code, kUsage);
  EXPECT_THAT(error.error.message, HasSubstr("has only 2 robots; give at most so many"));
}

TEST(SitePlan, ADrawingThatIsMissingIsABadConfiguration) {
  const CommandError error = refused(options_for("none.geojson"));
  EXPECT_EQ(error.code, kBadConfiguration);
  EXPECT_EQ(error.error.message, "none.geojson: no such file; give the GeoJSON drawing of a site");
  PlanOptions options = options_for(kSite);
  options.set = {"mission"};
  EXPECT_EQ(refused(options).code, kUsage);
}

}  // namespace
}  // namespace fleetmap::apps
