#include "sim/spec_rules.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fleetmap::sim {
namespace {

TEST(SpecRules, BoundsBelongToTheRange) {
  for (const double value : {0.5, 1.0, 2.0}) {
    EXPECT_TRUE(within("rate", value, 0.5, 2.0, "Hz"));
    EXPECT_TRUE(in_range("rate", value, 0.5, 2.0, " Hz"));
  }
  for (const double value : {0.499, 2.001, std::nan(""), HUGE_VAL}) {
    EXPECT_FALSE(within("rate", value, 0.5, 2.0, "Hz")) << value;
    EXPECT_FALSE(in_range("rate", value, 0.5, 2.0, " Hz")) << value;
  }
}

TEST(SpecRules, AFailureNamesFieldRuleAndValue) {
  EXPECT_EQ(within("rate", 3.0, 0.5, 2.0, "Hz").error().message, "rate: must be 0.5 to 2 Hz, is 3");
  EXPECT_EQ(in_range("trees", -1.0, 0.0, 1000.0, "").error().message,
            "trees must be from 0 to 1000, found -1");
  EXPECT_EQ(in_range("margin", 1.0, 2.0, 9.0, " m").error().message, "margin must be from 2 to 9 m, found 1");
}

TEST(SpecRules, TheFirstFailureCounts) {
  EXPECT_TRUE(first_failure({}));
  EXPECT_TRUE(first_failure({Status{}, Status{}}));
  EXPECT_EQ(first_failure({Status{}, failure("a"), failure("b")}).error().message, "a");
}

TEST(SpecRules, FieldsOfAPartBearItsName) {
  EXPECT_TRUE(named("fence", Status{}));
  EXPECT_EQ(named("fence", failure("height must be positive")).error().message,
            "fence.height must be positive");
}

}  // namespace
}  // namespace fleetmap::sim
