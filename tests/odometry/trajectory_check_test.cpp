#include "fleetmap/odometry/trajectory_check.hpp"

#include <gtest/gtest.h>

namespace fleetmap::odometry {
namespace {

/// Drives straight on at 1.5 m/s, ten scans a second.
class Drive {
 public:
  void scans(int count, bool lost = false, double metres = 0.0, double radians = 0.0) {
    for (int k = 0; k < count; ++k) {
      OdometryUpdate update;
      update.stamp = stamp_from_ns(number_ * 100'000'000LL);
      update.T_odom_base.translation().x() = 0.15 * number_++;
      update.covariance(0, 0) = metres * metres / count;
      update.covariance(5, 5) = radians * radians / count;
      update.lost = lost;
      check_.add(update);
    }
  }
  const TrajectoryCheck& check() const { return check_; }
  bool kept() const { return check_.warnings().empty(); }

 private:
  TrajectoryCheck check_;
  int number_ = 0;
};

TEST(TrajectoryCheck, EmptyTrajectoryHasNoWarning) { EXPECT_TRUE(TrajectoryCheck().warnings().empty()); }

TEST(TrajectoryCheck, ADriveThatIsStatedWellIsKept) {
  Drive drive;
  drive.scans(2000, false, 0.3, 0.05);
  EXPECT_NEAR(drive.check().length(), 0.15 * 1999, 1e-9);
  EXPECT_TRUE(drive.kept());
}

TEST(TrajectoryCheck, ALostScanOrTwoAreKept) {
  Drive drive;
  drive.scans(500);
  drive.scans(2, true);
  drive.scans(500);
  EXPECT_TRUE(drive.kept());
}

/// 9 of 3,000 scans: a third of a per cent.
TEST(TrajectoryCheck, ALongDriveDoesNotHideASecondThatWasLost) {
  Drive drive;
  drive.scans(1000);
  drive.scans(9, true);
  drive.scans(2000);
  ASSERT_EQ(drive.check().warnings().size(), 1u);
  EXPECT_NE(drive.check().warnings()[0].find("9.00 % of the scans of 10 s are lost, 100.8 s"),
            std::string::npos)
      << drive.check().warnings()[0];
}

/// 3 m on one stretch of 450 m: below 5 % of the way at its end.
TEST(TrajectoryCheck, ALongDriveDoesNotHideAVagueStretch) {
  Drive drive;
  drive.scans(1000);
  drive.scans(30, false, 3.0);
  drive.scans(2000);
  ASSERT_EQ(drive.check().warnings().size(), 1u);
  EXPECT_NE(drive.check().warnings()[0].find("20 m of the way are stated to"), std::string::npos);
}

TEST(TrajectoryCheck, AHeadingThatIsNotKnownIsNotKept) {
  Drive drive;
  drive.scans(1000);
  drive.scans(30, false, 0.0, 1.0);
  EXPECT_TRUE(drive.kept()) << "the stretch is not at its end";
  drive.scans(200);
  EXPECT_FALSE(drive.kept());
}

TEST(TrajectoryCheck, OneOfAHundredScansThatAreLostIsTooMany) {
  Drive drive;
  for (int k = 0; k < 10; ++k) {
    drive.scans(120);
    drive.scans(2, true);
  }
  ASSERT_EQ(drive.check().warnings().size(), 1u);
  EXPECT_NE(drive.check().warnings()[0].find("of all scans are lost"), std::string::npos);
}

}  // namespace
}  // namespace fleetmap::odometry
