#include "fleetmap/planning/division/division_config.hpp"

#include <gtest/gtest.h>

#include <string>

#include "support/field_bounds.hpp"

namespace fleetmap::planning {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kNaN;

TEST(DivisionConfig, ReserveAndRoundsAreBounded) {
  expect_accepted(DivisionConfig{}, &DivisionConfig::battery_reserve, {0.0, 0.99});
  expect_refused(DivisionConfig{}, &DivisionConfig::battery_reserve, {-0.01, 1.0, kNaN<double>},
                 "battery_reserve");
  expect_accepted(DivisionConfig{}, &DivisionConfig::search_rounds, {0, 1'000'000});
  expect_refused(DivisionConfig{}, &DivisionConfig::search_rounds, {-1, 1'000'001}, "search_rounds");
}

TEST(DivisionConfig, MethodsAreReadByTheNameThatIsWritten) {
  for (const DivisionMethod method :
       {DivisionMethod::kUniform, DivisionMethod::kBalanced, DivisionMethod::kEnergy})
    EXPECT_EQ(division_method(to_string(method)).value(), method);
  for (const char* wrong : {"", "Uniform", "fair"}) {
    const auto none = division_method(wrong);
    ASSERT_FALSE(none) << wrong;
    EXPECT_NE(none.error().message.find(std::string("'") + wrong + "'"), std::string::npos);
  }
}

}  // namespace
}  // namespace fleetmap::planning
