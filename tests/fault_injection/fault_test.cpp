#include "fleetmap/fault_injection/fault.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fleetmap::fault_injection {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(FaultKinds, AreParsedByTheNamesThatTheyAreWrittenWith) {
  const auto all = parse_fault_kinds("all").value();
  EXPECT_EQ(all.size(), kFaultKinds);
  std::set<std::string> names;
  for (const FaultKind kind : all) {
    names.insert(to_string(kind));
    EXPECT_THAT(parse_fault_kinds(to_string(kind)).value(), ElementsAre(kind));
  }
  EXPECT_EQ(names.size(), kFaultKinds) << "two have one name";
  EXPECT_STREQ(to_string(FaultKind::kLoss), "loss");
  EXPECT_STREQ(to_string(FaultKind::kPartition), "partition");
  EXPECT_STREQ(to_string(FaultKind::kDamagedStore), "damaged_store");
}

TEST(FaultKinds, SeveralAreSeparatedByCommas) {
  EXPECT_THAT(parse_fault_kinds("crash,loss,crash").value(),
              ElementsAre(FaultKind::kLoss, FaultKind::kCrash));
  EXPECT_TRUE(parse_fault_kinds("").value().empty());
  const auto wrong = parse_fault_kinds("loss,rain");
  ASSERT_FALSE(wrong);
  EXPECT_THAT(wrong.error().message, HasSubstr("'rain' is none of all, loss, delay, duplication"));
}

TEST(FaultKinds, OfLinksAreTheFirstFive) {
  for (const FaultKind kind : {FaultKind::kLoss, FaultKind::kDelay, FaultKind::kDuplication,
                               FaultKind::kOneWay, FaultKind::kPartition})
    EXPECT_TRUE(impairs_links(kind));
  for (const FaultKind kind : {FaultKind::kCrash, FaultKind::kStranger, FaultKind::kDamagedStore})
    EXPECT_FALSE(impairs_links(kind));
}

TEST(FaultKinds, SomeKeepTheirRobotFromRunning) {
  for (const FaultKind kind : {FaultKind::kCrash, FaultKind::kManyStarts, FaultKind::kOldStore})
    EXPECT_TRUE(stops_robot(kind)) << to_string(kind);
  for (const FaultKind kind : {FaultKind::kCompromised, FaultKind::kFullDisk, FaultKind::kNewOrigin})
    EXPECT_FALSE(stops_robot(kind)) << to_string(kind);
}

TEST(Fault, IsALineOfAReport) {
  Fault fault{.kind = FaultKind::kPartition,
              .begin = milliseconds(12'500),
              .length = seconds(30),
              .robots = {0, 2},
              .radio = true,
              .short_range = false,
              .value = 0.0};
  EXPECT_EQ(to_string(fault), "at 12.5 s for 30 s: partition of r1, r3, radio");
  fault.kind = FaultKind::kLoss;
  fault.value = 0.25;
  fault.robots.clear();
  fault.radio = false;
  fault.short_range = true;
  EXPECT_EQ(to_string(fault), "at 12.5 s for 30 s: loss 0.25, short range");
  fault.radio = true;
  EXPECT_EQ(to_string(fault), "at 12.5 s for 30 s: loss 0.25") << "on both links";
  fault.kind = FaultKind::kCrash;
  fault.value = 0.0;
  fault.robots = {9};
  fault.short_range = false;
  EXPECT_EQ(to_string(fault), "at 12.5 s for 30 s: crash of r10") << "a crash has no link";
}

}  // namespace
}  // namespace fleetmap::fault_injection
