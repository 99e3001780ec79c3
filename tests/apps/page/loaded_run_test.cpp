#include "page/loaded_run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "apps/driven_days.hpp"
#include "fleetmap/output/map_recipe.hpp"
#include "fleetmap/output/registrations_file.hpp"
#include "store/items.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class ShownRunTest : public ::testing::Test {
 protected:
  /// A run in which robot `folder` holds the day `session`.
  void add_robot(const std::string& folder, std::uint16_t session) {
    std::filesystem::create_directories(days_.path("run/" + folder));
    days_.drive("run/" + folder + "/store.db", session, {0.0, 0.0, 0.0});
  }
  DrivenDays days_;
};

TEST_F(ShownRunTest, AViewOfResultsHoldsTheStoreAndTheirPlacement) {
  days_.drive("a.db", 0, {0.0, 0.0, 0.0});
  const auto store = store::Store::open_read_only(days_.path("a.db"));
  ASSERT_TRUE(store) << store.error().message;
  output::Results results;
  results.placement.T_enu_node[{AgentId::parse("r1").value(), 0}] = Pose::Identity();
  const monitor::FleetView view = view_of(*store, results);
  EXPECT_EQ(view.self, AgentId::parse("r1").value());
  EXPECT_THAT(view.nodes, SizeIs(4));
  EXPECT_THAT(view.has_submap, ElementsAre(true, true, true, true));
  EXPECT_THAT(view.holdings, SizeIs(1));
  EXPECT_THAT(view.placement.T_enu_node, SizeIs(1)) << "as the results have it, not placed anew";
}

TEST_F(ShownRunTest, OneStoreIsPlacedWithWhatItHolds) {
  days_.drive("a.db", 0, {0.0, 0.0, 0.0});
  const auto run = open_one(days_.path("a.db"));
  ASSERT_TRUE(run) << run.error().message;
  const monitor::FleetView& view = run->view;
  EXPECT_EQ(view.self, AgentId::parse("r1").value());
  EXPECT_THAT(view.nodes, SizeIs(4));
  EXPECT_THAT(view.has_submap, ElementsAre(true, true, true, true));
  EXPECT_EQ(view.placement.T_enu_node.size(), 4u);
  EXPECT_EQ(view.placement.covariance.size(), 4u) << "of few nodes each; the page colours submaps by it";
  ASSERT_THAT(view.holdings, SizeIs(1));
  EXPECT_EQ(view.holdings[0].nodes, 4u);
  EXPECT_EQ(view.holdings[0].submaps, 4u);
  EXPECT_THAT(view.notes, IsEmpty());
}

TEST_F(ShownRunTest, RunShowsTheHoldingsOfAllAndNotesDamagedStores) {
  add_robot("r1", 0);
  add_robot("r2", 1);
  std::filesystem::create_directories(days_.path("run/r3"));
  std::ofstream(days_.path("run/r3/store.db")) << "no store";
  const auto run = open_run(days_.path("run"), "");
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_EQ(run->view.title, "run");
  EXPECT_THAT(run->view.holdings, SizeIs(2));
  EXPECT_THAT(run->view.notes, ElementsAre(HasSubstr("r3/store.db: is no store")));
}

TEST_F(ShownRunTest, RobotsWithAFileOfRegistrationsHaveALogHere) {
  add_robot("r1", 0);
  add_robot("r2", 1);
  const auto none = open_run(days_.path("run"), "");
  ASSERT_TRUE(none) << none.error().message;
  EXPECT_THAT(none->view.logs, IsEmpty());
  ASSERT_TRUE(output::begin_registrations(days_.path("run/r1/registrations.csv")));
  const auto run = open_run(days_.path("run"), "");
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_THAT(run->view.logs, ElementsAre(AgentId::parse("r1").value()));
  EXPECT_THAT(run->view.notes, IsEmpty());
}

TEST_F(ShownRunTest, TheRadiusThatWasConfiguredDecidesWhoWasNear) {
  days_.drive("a.db", 0, {0.0, 0.0, 0.0});
  {
    auto store = store::Store::open(days_.path("a.db"), AgentId::parse("r1").value()).value();
    output::RecipeConfig config;
    config.search_radius_m = 12.5;
    ASSERT_TRUE(output::keep_recipe(store, config));
  }
  const auto run = open_one(days_.path("a.db"));
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_EQ(run->view.search_radius_m, 12.5);
  EXPECT_EQ(view_of(*run->store, {}).search_radius_m, 12.5);
}

TEST_F(ShownRunTest, OfARobotThatIsLeftOutNothingIsShownButItsName) {
  add_robot("r1", 0);
  const AgentId r1 = AgentId::parse("r1").value(), r2 = AgentId::parse("r2").value();
  std::filesystem::create_directories(days_.path("run/r2"));
  for (const std::string folder : {"run/r1/", "run/r2/"}) {
    auto store = store::Store::open(days_.path(folder + "store.db"), folder == "run/r1/" ? r1 : r2).value();
    const Bytes submap(10, 1);
    ASSERT_TRUE(store.put_node_with_submap(testing::make_node(r2, 0, submap), submap));
    const auto log = days_.path(folder + "registrations.csv");
    ASSERT_TRUE(output::append_registration(log, {{r1, 0}, {r2, 0}, "rejected", {}, {}, {}, 0.1, "too far"}));
    ASSERT_TRUE(output::append_registration(log, {{r1, 0}, {r1, 3}, "accepted", {}, {}, {}, 0.1, ""}));
  }
  const auto all = open_run(days_.path("run"), "");
  ASSERT_TRUE(all) << all.error().message;
  EXPECT_THAT(all->view.attempts, SizeIs(4));
  EXPECT_THAT(all->view.holdings, SizeIs(3));
  const std::vector left_out{r2};
  const auto run = open_run(days_.path("run"), "", left_out);
  const auto one = open_one(days_.path("run/r1/store.db"), left_out);
  for (const auto* shown : {&run, &one}) {
    ASSERT_TRUE(*shown) << shown->error().message;
    const monitor::FleetView& view = (*shown)->view;
    ASSERT_THAT(view.attempts, SizeIs(1));
    EXPECT_EQ(view.attempts[0].source, (NodeId{r1, 3}));
    ASSERT_THAT(view.holdings, SizeIs(1));
    EXPECT_EQ(view.holdings[0].maker, r1);
    EXPECT_THAT(view.logs, ElementsAre(r1));
    EXPECT_THAT(monitor::robots_of(view), ElementsAre(r1));
    EXPECT_THAT(view.notes, ElementsAre("left out (--without): r2"));
  }
}

TEST_F(ShownRunTest, WithoutTheRobotThatWasAskedForNothingIsShown) {
  add_robot("r1", 0);
  const auto run = open_run(days_.path("run"), "r7");
  ASSERT_FALSE(run);
  EXPECT_THAT(run.error().message, HasSubstr("holds no store of r7; give the --out of a run"));
  const auto none = open_run(days_.path("nowhere"), "");
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("nowhere: no such folder"));
}

}  // namespace
}  // namespace fleetmap::apps
