// The operator's remedy for a member that lies: maps without what it made.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fleetmap/cloud/file_io.hpp"
#include "support/bent_store.hpp"
#include "support/command_line.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class MapWithout : public testing::CommandLineTest {
 protected:
  MapWithout() {
    auto store = store::Store::open(path("store.db"), testing::bent_robot(1)).value();
    testing::add_bent_fleet(store);
  }
  void map(const std::string& what, std::vector<std::string> more) {
    more.insert(more.begin(), {"map", what, path("store.db")});
    run(std::move(more));
  }
  /// North of r1's nodes to north of r2's, m, in an exported map, whose origin is r1's first node.
  double apart(const std::string& file) const {
    const auto cloud = cloud::read_cloud(path(file)).value();
    double of_r1 = 0.0, of_r2 = 0.0;
    for (const auto& point : cloud.points) {
      if (point.y() < 5.0f) of_r1 += point.y() / testing::kNodesEach;
      if (point.y() > 5.0f && point.y() < 16.0f) of_r2 += point.y() / testing::kNodesEach;
    }
    return of_r2 - of_r1;
  }
};

TEST_F(MapWithout, IsStraightWhereAMemberHadBentIt) {
  map("export", {"--out", path("all.ply")});
  ASSERT_EQ(exit_code_, 0) << output_;
  EXPECT_GT(apart("all.ply"), 10.0 + 0.8 * testing::kBend) << "the liar must have an effect";
  map("export", {"--without", "r3", "--out", path("rest.ply")});
  ASSERT_EQ(exit_code_, 0) << output_;
  EXPECT_THAT(output_, HasSubstr("24 points from 24 submaps"));
  EXPECT_NEAR(apart("rest.ply"), 10.0, 0.1);
}

TEST_F(MapWithout, AllThatReadsTheStoreLeavesOutTheSame) {
  map("info", {"--without", "r3"});
  EXPECT_THAT(output_, HasSubstr("nodes 24, submaps held 24, alignments 0 (0 used)"));
  map("info", {});
  EXPECT_THAT(output_, HasSubstr("nodes 36, submaps held 36, alignments 24"));
  map("tracks", {"--without", "r3,r2", "--out", path("ways.geojson")});
  EXPECT_THAT(output_, HasSubstr("12 nodes"));
  map("graph", {"--without", "r3", "--out", path("all.g2o")});
  EXPECT_THAT(output_, HasSubstr("24 vertices"));
}

TEST_F(MapWithout, ARobotOfWhichNothingIsHeldIsRefusedWithThoseThatThereAre) {
  map("export", {"--without", "r9", "--out", path("none.ply")});
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_, AllOf(HasSubstr("store.db: holds nothing of 'r9'"), HasSubstr("r1, r2, r3")));
  EXPECT_FALSE(std::filesystem::exists(path("none.ply")));
  map("export", {"--without", "r1,r2,r3", "--out", path("none.ply")});
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_, HasSubstr("no node is left"));
  map("info", {"--json", "--without", "r3"});
  EXPECT_EQ(exit_code_, 2);
}

}  // namespace
}  // namespace fleetmap
