#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace fleetmap::sim {

/// A field of a specification, and its bounds.
template <class Spec>
struct Bounded {
  const char* name;
  double Spec::*field;
  double low, high;
};

/// Each field may have its bounds and nothing beyond, and is named by what validate() says of it.
template <class Spec>
void expect_bounds(const Spec& good, const std::vector<Bounded<Spec>>& fields) {
  ASSERT_TRUE(good.validate());
  for (const auto& [name, field, low, high] : fields) {
    Spec spec = good;
    for (const double value : {low, high}) {
      spec.*field = value;
      EXPECT_TRUE(spec.validate()) << name << ' ' << value;
    }
    for (const double value : {std::nextafter(low, -1e9), std::nextafter(high, 1e9), std::nan("")}) {
      spec.*field = value;
      const auto status = spec.validate();
      ASSERT_FALSE(status) << name << ' ' << value;
      EXPECT_THAT(status.error().message, ::testing::StartsWith(std::string(name) + ": must be"));
    }
  }
}

}  // namespace fleetmap::sim
