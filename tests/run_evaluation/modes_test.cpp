#include "fleetmap/run_evaluation/modes.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace fleetmap::run_evaluation {
namespace {

TEST(Modes, EachCombinationOfRegistrationAndPlacementOnce) {
  std::set<std::pair<registration::Method, graph::PlacementMethod>> combinations;
  for (const Mode& mode : modes()) combinations.emplace(mode.registration, mode.placement);
  EXPECT_EQ(modes().size(), 4u);
  EXPECT_EQ(combinations.size(), 4u);
  EXPECT_EQ(mode_names(), (std::set<std::string>{"correlation_paper", "fleet", "paper", "paper_graph"}));
}

TEST(Modes, ThoseOfTheConfigurationAreAmongThem) {
  for (const Mode& mode : modes()) {
    if (std::string(mode.name) == "paper") {
      EXPECT_EQ(mode.registration, registration::Method::paper);
      EXPECT_EQ(mode.placement, graph::PlacementMethod::paper);
    } else if (std::string(mode.name) == "fleet") {
      EXPECT_EQ(mode.registration, registration::Method::correlation);
      EXPECT_EQ(mode.placement, graph::PlacementMethod::graph);
    }
  }
}

}  // namespace
}  // namespace fleetmap::run_evaluation
