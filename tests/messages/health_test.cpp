#include "fleetmap/messages/health.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace fleetmap::messages {
namespace {

TEST(Health, AClassOfAClockIsWithinAFactorOfTheSquareRootOfTwo) {
  for (double seconds = 1e-3; seconds < 4e8; seconds *= 1.1) {
    for (const double behind : {seconds, -seconds}) {
      const double ratio = seconds_behind(clock_code(behind)).value() / behind;
      EXPECT_GT(ratio, 0.999 / std::sqrt(2.0)) << behind;
      EXPECT_LT(ratio, 1.001 * std::sqrt(2.0)) << behind;
    }
  }
}

TEST(Health, AClockThatIsRightIsToldFromOneThatIsNotKnown) {
  EXPECT_EQ(clock_code(0.0), 1);
  EXPECT_EQ(seconds_behind(1), 1e-3);
  EXPECT_FALSE(seconds_behind(0));
  EXPECT_EQ(clock_code(std::nan("")), 0);
  EXPECT_EQ(clock_code(std::numeric_limits<double>::infinity()), 0);
  EXPECT_EQ(clock_code(-1e300), -clock_code(1e300)) << "as far as a byte reaches";
}

TEST(Health, EachProblemHasItsWordsAndTheWorstComesFirst) {
  EXPECT_TRUE(words_of({}).empty());
  EXPECT_THAT(words_of({.problems = Health::kNoScan | Health::kDiskRefuses}),
              ::testing::ElementsAre("its disk refused writes", "no scan comes from its LiDAR"));
  EXPECT_EQ(words_of({.problems = Health::kAllProblems}).size(), 5u);
}

}  // namespace
}  // namespace fleetmap::messages
