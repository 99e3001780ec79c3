#include "report/distribution.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace fleetmap::apps {
namespace {

TEST(Distribution, SummarisesValuesInAnyOrder) {
  std::vector<double> values;
  for (int k = 100; k >= 0; --k) values.push_back(k);
  const Distribution d = distribution(values);
  EXPECT_EQ(d.count, 101u);
  EXPECT_EQ(d.min, 0.0);
  EXPECT_EQ(d.mean, 50.0);
  EXPECT_EQ(d.p50, 50.0);
  EXPECT_EQ(d.p99, 99.0);
  EXPECT_EQ(d.max, 100.0);
}

TEST(Distribution, SummarisesOneValueAndNone) {
  const Distribution one = distribution({7.0});
  EXPECT_EQ(one.p50, 7.0);
  EXPECT_EQ(one.p99, 7.0);
  const Distribution none = distribution({});
  EXPECT_EQ(none.count, 0u);
  EXPECT_EQ(none.max, 0.0);
}

}  // namespace
}  // namespace fleetmap::apps
