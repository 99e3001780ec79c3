#include "trial/grid_options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <optional>

namespace fleetmap::apps {
namespace {

using ::testing::ElementsAre;

/// Nothing if the arguments are refused.
std::optional<GridOptions> parsed_grid(const std::string& arguments) {
  CLI::App app;
  GridOptions options;
  add_grid_options(app, options);
  try {
    app.parse(arguments);
  } catch (const CLI::ParseError&) {
    return std::nullopt;
  }
  return options;
}

TEST(GridOptions, HaveAFolderAndSettings) {
  const auto options = parsed_grid("--out o --quick --set a=1 --set b=2 --keep --any-build");
  ASSERT_TRUE(options);
  EXPECT_EQ(options->out, "o");
  EXPECT_THAT(options->set, ElementsAre("a=1", "b=2"));
  EXPECT_TRUE(options->quick && options->keep && options->any_build);
  EXPECT_FALSE(options->list || options->report);
  EXPECT_FALSE(parsed_grid("--quick")) << "no folder";
  EXPECT_FALSE(parsed_grid("--out ''"));
}

TEST(GridOptions, ACaseAListAndAReportExcludeEachOther) {
  ASSERT_TRUE(parsed_grid("--out o --case x"));
  EXPECT_EQ(parsed_grid("--out o --case x")->one_case, "x");
  EXPECT_FALSE(parsed_grid("--out o --case ''")) << "a variable that is unset";
  EXPECT_FALSE(parsed_grid("--out o --list --report"));
  EXPECT_FALSE(parsed_grid("--out o --case x --list"));
  EXPECT_FALSE(parsed_grid("--out o --case x --report"));
}

}  // namespace
}  // namespace fleetmap::apps
