#include "recordings/calibration_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

namespace fleetmap::apps {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

CalibratedMounts mounts() {
  CalibratedMounts all;
  all.metres = 84.2;
  all.turned = 12.0;
  all.quantities = {{"IMU", "x", "m", {0.1234, 0.0021}, 0.0, true, ""},
                    {"IMU", "y", "m", {0.0011, 0.0021}, 0.0, true, ""},
                    {"IMU", "z", "m", {0.777, 0.9}, 0.0, false, "measure it"}};
  CalibratedPlace imu;
  imu.section = "imu";
  imu.T_base_sensor = make_pose(rotation_from_rpy(0.0, 0.0, 1.5), Eigen::Vector3d(0.1234, 0.0011, 0.3));
  imu.covariance = Matrix6d::Identity();
  imu.kept = "z";
  all.places = {imu};
  all.skipped = {"GPS antenna: not observable on this drive, no fixes: drive two figures of eight"};
  return all;
}

TEST(CalibrationReport, StatesSigmasDifferencesAndLinesOfTheConfiguration) {
  std::ostringstream out;
  print_calibration(out, mounts());
  EXPECT_THAT(out.str(), HasSubstr("84.2 m and 688 deg of turns"));
  EXPECT_THAT(out.str(), HasSubstr("IMU: x is 0.1234 m, sigma 0.0021; in use is 0.0000, 59 sigmas off\n"));
  EXPECT_THAT(out.str(), HasSubstr("IMU: y is 0.0011 m, sigma 0.0021\n"));
  EXPECT_THAT(out.str(), HasSubstr("IMU: z is not observable on this drive: measure it\n"));
  EXPECT_THAT(out.str(), Not(HasSubstr("0.777")));
  EXPECT_THAT(out.str(), HasSubstr("GPS antenna: not observable"));
  EXPECT_THAT(out.str(), HasSubstr("imu:\n  # not observable, as in use: z\n"
                                   "  translation: [0.123, 0.001, 0.300]\n"
                                   "  rotation_rpy_deg: [0.00, 0.00, 85.94]\n"));
}

TEST(CalibrationReport, JsonHoldsTheSameAndTheCovariance) {
  std::ostringstream out;
  print_calibration_json(out, mounts());
  const auto json = nlohmann::json::parse(out.str());
  EXPECT_EQ(json["quantities"][0]["differs"], true);
  EXPECT_EQ(json["quantities"][1]["differs"], false);
  EXPECT_FALSE(json["quantities"][2].contains("value"));
  EXPECT_EQ(json["mounts"]["imu"]["covariance"].size(), 6u);
  EXPECT_EQ(json["mounts"]["imu"]["not_observable"], "z");
  EXPECT_EQ(json["skipped"].size(), 1u);
}

}  // namespace
}  // namespace fleetmap::apps
