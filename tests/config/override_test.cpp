#include "fleetmap/config/override.hpp"

#include <gtest/gtest.h>

namespace fleetmap::config {
namespace {

TEST(Override, IsDividedAtItsFirstEqualsSign) {
  const auto plain = parse_override("lidar.translation=[0, 0, 0.35]");
  ASSERT_TRUE(plain) << plain.error().message;
  EXPECT_EQ(plain->key, "lidar.translation");
  EXPECT_EQ(plain->value, "[0, 0, 0.35]");
  EXPECT_EQ(plain->at, "") << "of a command line";
  EXPECT_EQ(parse_override("key=a=b")->value, "a=b");
  EXPECT_EQ(parse_override("key=")->value, "");
}

TEST(Override, WithoutAKeyOrAnEqualsSignIsNone) {
  for (const std::string text : {"", "key", "=value"}) {
    const auto refused = parse_override(text);
    ASSERT_FALSE(refused) << text;
    EXPECT_EQ(refused.error().message, "--set " + text + ": expected key=value, e.g. lidar.model=os1-64");
  }
}

}  // namespace
}  // namespace fleetmap::config
