#include "fleetmap/experiment/grid.hpp"

#include <gmock/gmock.h>

#include <sstream>

#include "experiment/experiment_fixture.hpp"

namespace fleetmap::experiment {
namespace {

using ::testing::HasSubstr;

class GridTest : public ExperimentTest {
 protected:
  std::filesystem::path write_grid(const std::string& rest) {
    return folder_.write("grid.yaml", "base: " FLEETMAP_SOURCE_DIR "/config/fleets/farm_small.yaml\n" + rest);
  }
};

TEST_F(GridTest, OverridesGoToEveryCase) {
  const auto file = write_grid(
      "seed_keys: [world.seed]\nstudies:\n"
      "  - {name: one, seeds: 2, axes: [{name: agents, values: [2, 3]}]}\n"
      "  - {name: two, seeds: 1, axes: [{name: agents, values: [2]}]}\n");
  const auto grid = load_grid(file, false, {{"max_time", "17"}});
  ASSERT_TRUE(grid) << grid.error().message;
  ASSERT_EQ(grid->cases.size(), 5u);
  for (const Case& one : grid->cases) {
    EXPECT_TRUE(std::ranges::any_of(one.overrides, [](const config::Override& entry) {
      return entry.key == "max_time" && entry.value == "17";
    })) << one.name;
  }
}

TEST_F(GridTest, AKeyThatNoFleetHasIsRefused) {
  const auto file = write_grid("studies:\n  - {name: one, seeds: 1, axes: [{name: agents, values: [2]}]}\n");
  ASSERT_TRUE(load_grid(file, false, {}));
  const auto grid = load_grid(file, false, {{"nodes.spacin", "2"}});
  ASSERT_FALSE(grid);
  EXPECT_THAT(grid.error().message, HasSubstr("spacin"));
}

TEST_F(GridTest, AListNamesEveryCaseAndWhichShareARun) {
  write_experiment(
      "set: [a.b=0]\nseed_keys: [world.seed]\nstudies:\n"
      "  - {name: one, agents: 2, seeds: 1, axes: [{name: x, keys: [a.b], values: [1, 2]}]}\n"
      "  - {name: two, seeds: 1, set: [a.b=2], axes: [{name: agents, values: [2, 3]}]}\n");
  const auto config = load();
  ASSERT_TRUE(config) << config.error().message;
  std::ostringstream out;
  ASSERT_TRUE(list_cases(all_cases(*config), out));
  EXPECT_THAT(out.str(), HasSubstr("one.x=1.seed=01: 2 robots --set a.b=0 --set a.b=1"));
  EXPECT_THAT(out.str(), HasSubstr("two.agents=2.seed=01: same run as one.x=2.seed=01\n"));
  EXPECT_THAT(out.str(), HasSubstr("two.agents=3.seed=01: 3 robots"));
}

}  // namespace
}  // namespace fleetmap::experiment
