#include "case_groups.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace fleetmap::experiment {
namespace {

using ::testing::ElementsAre;
using ::testing::SizeIs;

TEST(CaseGroups, CasesWithEqualInputsAreTogetherInTheOrderOfTheFirst) {
  const testing::TemporaryFolder folder;
  std::vector<Case> cases(5);
  for (std::size_t k = 0; k < cases.size(); ++k) {
    cases[k].name = std::to_string(k);
    cases[k].base = folder.write("fleet.yaml", "agents: []\n");
  }
  cases[0].agents = 4;
  cases[1].overrides = {{"z", "1"}};
  cases[3].overrides = {{"z", "0"}, {"z", "1"}};
  cases[4].agents = 4;
  const auto groups = grouped(cases);
  ASSERT_TRUE(groups) << groups.error().message;
  ASSERT_THAT(*groups, SizeIs(3));
  EXPECT_THAT((*groups)[0].cases, ElementsAre(0, 4));
  EXPECT_THAT((*groups)[1].cases, ElementsAre(1, 3));
  EXPECT_THAT((*groups)[2].cases, ElementsAre(2));
  EXPECT_EQ((*groups)[1].hash, input_hash(cases[3]).value());
}

TEST(CaseGroups, InputsThatCannotBeReadAreAnError) {
  const testing::TemporaryFolder folder;
  std::vector<Case> cases(1);
  cases[0].base = folder.path() / "none.yaml";
  const auto groups = grouped(cases);
  ASSERT_FALSE(groups);
  EXPECT_THAT(groups.error().message, ::testing::HasSubstr("none.yaml: no such file"));
  EXPECT_THAT(grouped({}).value(), ::testing::IsEmpty());
}

}  // namespace
}  // namespace fleetmap::experiment
