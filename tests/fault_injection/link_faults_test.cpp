#include "link_faults.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace fleetmap::fault_injection {
namespace {

using messages::Reach;
using std::chrono::milliseconds;
using ::testing::AllOf;
using ::testing::Each;
using ::testing::Ge;
using ::testing::IsEmpty;
using ::testing::Le;
using ::testing::SizeIs;

constexpr int kMany = 20'000;
constexpr Reach kRadio = Reach::kLongRange, kWifi = Reach::kShortRange;

Fault fault_among(FaultKind kind, std::vector<std::size_t> robots, double value = 0.0) {
  Fault fault;
  fault.kind = kind;
  fault.robots = std::move(robots);
  fault.value = value;
  return fault;
}

/// Counts the packets that arrive never, once and twice.
std::array<int, 3> copies(LinkFaults& faults, std::size_t from, std::size_t to, Reach reach = kRadio) {
  std::array<int, 3> counts{};
  for (int k = 0; k < kMany; ++k) ++counts.at(faults.arrivals(from, to, reach).size());
  return counts;
}

TEST(LinkFaults, WithoutAFaultEachPacketArrivesOnceAndSoon) {
  LinkFaults faults(1);
  Duration shortest = std::chrono::seconds(1), longest{};
  for (int k = 0; k < kMany; ++k) {
    const auto delays = faults.arrivals(0, 1, kRadio);
    ASSERT_THAT(delays, SizeIs(1));
    ASSERT_THAT(delays, Each(AllOf(Ge(milliseconds(5)), Le(milliseconds(60)))));
    shortest = std::min(shortest, delays[0]);
    longest = std::max(longest, delays[0]);
  }
  EXPECT_LT(shortest, milliseconds(6));
  EXPECT_GT(longest, milliseconds(59));
}

TEST(LinkFaults, LossTakesItsShareFromThoseWhomItConcerns) {
  LinkFaults faults(2);
  const Fault loss = fault_among(FaultKind::kLoss, {1}, 0.3);
  faults.begin(loss);
  EXPECT_NEAR(copies(faults, 1, 0)[0], 0.3 * kMany, 260) << "from it";
  EXPECT_NEAR(copies(faults, 0, 1)[0], 0.3 * kMany, 260) << "to it";
  EXPECT_EQ(copies(faults, 0, 2)[0], 0);
  faults.end(loss);
  EXPECT_EQ(copies(faults, 1, 0)[0], 0);
}

TEST(LinkFaults, WithoutRobotsAllAreConcernedOnTheLinksThatAreNamed) {
  LinkFaults faults(3);
  Fault loss = fault_among(FaultKind::kLoss, {}, 1.0);
  loss.short_range = false;
  faults.begin(loss);
  EXPECT_THAT(faults.arrivals(4, 7, kRadio), IsEmpty());
  EXPECT_THAT(faults.arrivals(4, 7, kWifi), SizeIs(1));
  loss.radio = false;
  loss.short_range = true;
  EXPECT_THAT(faults.arrivals(4, 7, kRadio), SizeIs(1));
  EXPECT_THAT(faults.arrivals(4, 7, kWifi), IsEmpty());
}

TEST(LinkFaults, DuplicationSendsItsShareTwiceButNothingThatWasLost) {
  LinkFaults faults(4);
  const Fault twice = fault_among(FaultKind::kDuplication, {}, 0.25),
              loss = fault_among(FaultKind::kLoss, {}, 0.5);
  faults.begin(twice);
  EXPECT_NEAR(copies(faults, 0, 1)[2], 0.25 * kMany, 250);
  faults.end(twice);
  faults.begin(loss);
  faults.begin(twice);
  const auto counts = copies(faults, 0, 1);
  EXPECT_NEAR(counts[0], 0.5 * kMany, 290);
  EXPECT_NEAR(counts[2], 0.125 * kMany, 190);
}

TEST(LinkFaults, TheLongestDelayCounts) {
  LinkFaults faults(5);
  const Fault slow = fault_among(FaultKind::kDelay, {}, 2.0),
              slower = fault_among(FaultKind::kDelay, {0}, 5.0);
  faults.begin(slower);
  faults.begin(slow);
  Duration longest{}, elsewhere{};
  for (int k = 0; k < kMany; ++k) {
    longest = std::max(longest, faults.arrivals(0, 1, kRadio).at(0));
    elsewhere = std::max(elsewhere, faults.arrivals(2, 1, kRadio).at(0));
  }
  EXPECT_GT(longest, milliseconds(4950));
  EXPECT_LE(longest, milliseconds(5060));
  EXPECT_GT(elsewhere, milliseconds(1950));
  EXPECT_LE(elsewhere, milliseconds(2060));
}

TEST(LinkFaults, OneWayIsOneWay) {
  LinkFaults faults(6);
  const Fault deaf = fault_among(FaultKind::kOneWay, {2, 0});
  faults.begin(deaf);
  EXPECT_TRUE(faults.cuts(2, 0, kRadio));
  EXPECT_FALSE(faults.cuts(0, 2, kRadio));
  EXPECT_FALSE(faults.cuts(2, 1, kRadio));
  EXPECT_THAT(faults.arrivals(2, 0, kWifi), IsEmpty());
  EXPECT_THAT(faults.arrivals(0, 2, kWifi), SizeIs(1));
}

TEST(LinkFaults, APartitionCutsBetweenItsSidesAndNotWithin) {
  LinkFaults faults(7);
  Fault split = fault_among(FaultKind::kPartition, {0, 3});
  split.short_range = false;
  faults.begin(split);
  for (std::size_t from = 0; from < 5; ++from) {
    for (std::size_t to = 0; to < 5; ++to) {
      const bool apart = (from == 0 || from == 3) != (to == 0 || to == 3);
      EXPECT_EQ(faults.cuts(from, to, kRadio), apart) << from << ' ' << to;
      EXPECT_FALSE(faults.cuts(from, to, kWifi));
    }
  }
  faults.end(split);
  EXPECT_FALSE(faults.cuts(0, 1, kRadio));
}

TEST(LinkFaults, TheLuckOfALinkIsThatOfItsSeedAndOfNoOtherLink) {
  const auto delays = [](std::uint64_t seed, bool others_talk, Reach reach = kRadio) {
    LinkFaults faults(seed);
    std::vector<Duration> all;
    for (int k = 0; k < 50; ++k) {
      if (others_talk) faults.arrivals(1, 0, kRadio), faults.arrivals(0, 1, kWifi);
      all.push_back(faults.arrivals(0, 1, reach).at(0));
    }
    return all;
  };
  EXPECT_EQ(delays(1, false), delays(1, true));
  EXPECT_NE(delays(1, false), delays(2, false));
  EXPECT_NE(delays(1, false), delays(1, false, kWifi));
}

}  // namespace
}  // namespace fleetmap::fault_injection
