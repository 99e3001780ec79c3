#include "fleetmap/fault_injection/invariant.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fleetmap::fault_injection {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(Invariants, AreParsedByTheNamesThatTheyAreWrittenWith) {
  const auto all = parse_invariants("all").value();
  EXPECT_EQ(all.size(), kInvariants);
  std::set<std::string> names;
  for (const Invariant invariant : all) {
    names.insert(to_string(invariant));
    EXPECT_THAT(parse_invariants(to_string(invariant)).value(), ElementsAre(invariant));
  }
  EXPECT_EQ(names.size(), kInvariants) << "two have one name";
  EXPECT_STREQ(to_string(Invariant::kNothingLost), "nothing_lost");
  EXPECT_STREQ(to_string(Invariant::kStarts), "starts");
  EXPECT_THAT(parse_invariants("budget,luck").error().message, HasSubstr("'luck' is none of all, converges"));
}

TEST(Violation, IsASentenceOfWhenWhoAndWhat) {
  Violation violation{Invariant::kBudget, std::chrono::milliseconds(12'345), "r2", "sent too much"};
  EXPECT_EQ(to_string(violation), "budget at 12.35 s, r2: sent too much");
  violation.robot.clear();
  violation.at = {};
  EXPECT_EQ(to_string(violation), "budget at 0.00 s, fleet: sent too much");
}

}  // namespace
}  // namespace fleetmap::fault_injection
