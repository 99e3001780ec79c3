#include "run_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace fleetmap::run_evaluation {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kPoses = "1.0 0 0 0 0 0 0 1\n2.0 1 0 0 0 0 0 1\n";

class RunFolderTest : public ::testing::Test {
 protected:
  testing::TemporaryFolder folder_;
};

TEST_F(RunFolderTest, RobotsAreSortedAndOtherFoldersIgnored) {
  folder_.write("r2/trajectory.tum", kPoses);
  folder_.write("r1/trajectory.tum", kPoses);
  folder_.write("r1/ekf.tum", kPoses);
  folder_.write("r1/truth.tum", kPoses);
  folder_.write("plots/plot.svg", "");
  folder_.write("report.json", "{\"exchange_ended\": true}");
  const auto run = open_run(folder_.path(), {});
  ASSERT_TRUE(run) << run.error().message;
  ASSERT_EQ(run->agents.size(), 2u);
  EXPECT_EQ(run->agents[0].id.str(), "r1");
  EXPECT_EQ(run->agents[1].id.str(), "r2");
  ASSERT_TRUE(run->agents[0].trajectory && run->agents[0].ekf && run->agents[0].truth);
  EXPECT_EQ(run->agents[0].trajectory->size(), 2u);
  EXPECT_FALSE(run->agents[0].odometry);
  EXPECT_FALSE(run->agents[1].truth);
  EXPECT_EQ(run->report["exchange_ended"], true);
  EXPECT_THAT(run->notes, IsEmpty());
}

TEST_F(RunFolderTest, TrueTrajectoriesMayLieInAFolderOfTheirOwn) {
  for (const char* robot : {"r1", "r2", "r3"}) folder_.write(std::string(robot) + "/trajectory.tum", kPoses);
  folder_.write("truths/r1.tum", kPoses);
  folder_.write("truths/r2/truth.tum", kPoses);
  const auto run = open_run(folder_.path(), folder_.path() / "truths");
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_TRUE(run->agents[0].truth);
  EXPECT_TRUE(run->agents[1].truth);
  EXPECT_FALSE(run->agents[2].truth);
  EXPECT_THAT(run->notes, ElementsAre(HasSubstr("no usable true trajectory of r3")));
  EXPECT_FALSE(open_run(folder_.path(), folder_.path() / "elsewhere"));
}

TEST_F(RunFolderTest, DamagedFilesAreNotesAndAFolderWithoutRobotsIsAnError) {
  EXPECT_THAT(open_run(folder_.path(), {}).error().message, HasSubstr("holds no robot's folder"));
  folder_.write("r1/trajectory.tum", "");
  folder_.write("report.json", "[1, 2");
  const auto run = open_run(folder_.path(), {});
  ASSERT_TRUE(run);
  EXPECT_FALSE(run->agents[0].trajectory);
  EXPECT_TRUE(run->report.is_null());
  EXPECT_THAT(run->notes, ElementsAre(HasSubstr("holds no pose"), HasSubstr("is not the JSON")));
}

TEST_F(RunFolderTest, ARunWithoutMapAndReportWasCutOff) {
  folder_.write("r1/odometry.tum", kPoses);
  folder_.write("r1/store.db", "");
  const auto cut_off = open_run(folder_.path(), {});
  ASSERT_TRUE(cut_off);
  EXPECT_TRUE(cut_off->agents[0].cut_off);
  EXPECT_THAT(cut_off->notes, ElementsAre(HasSubstr("fleetmap map export")));
  folder_.write("r1/map.ply", "");
  EXPECT_FALSE(open_run(folder_.path(), {})->agents[0].cut_off);
}

TEST_F(RunFolderTest, MapsAreToldApartByTheirBytes) {
  for (const char* robot : {"r1", "r2", "r3", "r4"})
    folder_.write(std::string(robot) + "/trajectory.tum", kPoses);
  folder_.write("r1/map.ply", "one");
  folder_.write("r2/map.ply", "two");
  folder_.write("r3/map.ply", "two");
  auto run = open_run(folder_.path(), {});
  ASSERT_TRUE(run);
  const auto maps = distinct_maps(*run);
  ASSERT_EQ(maps.size(), 2u);
  EXPECT_EQ(maps[0].agents.size(), 2u);  // most holders first
  EXPECT_EQ(maps[0].agents[0].str(), "r2");
  EXPECT_EQ(maps[1].agents[0].str(), "r1");
  EXPECT_NE(maps[0].hash, maps[1].hash);
  EXPECT_THAT(run->notes, ElementsAre(HasSubstr("r4 has no map")));
}

TEST_F(RunFolderTest, RegistrationsAreReadAndDamagedLinesNoted) {
  folder_.write("r1/trajectory.tum", kPoses);
  folder_.write("r1/registrations.csv",
                "cpu_s,source,target,verdict\n0.5,r2/1,r1/1,accepted\n,r2/2,r1/2,rejected\n1.0\n");
  folder_.write("r2/trajectory.tum", kPoses);
  const auto run = open_run(folder_.path(), {});
  ASSERT_TRUE(run);
  const auto& rows = run->agents[0].registrations.rows;
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].verdict, "accepted");
  EXPECT_EQ(rows[0].cpu_seconds, 0.5);
  EXPECT_EQ(rows[1].cpu_seconds, 0.0);
  EXPECT_TRUE(run->agents[1].registrations.rows.empty());
  EXPECT_THAT(run->notes, ElementsAre(HasSubstr("r1/registrations.csv: 1 lines cannot be read")));
}

}  // namespace
}  // namespace fleetmap::run_evaluation
