#include "clouds/registration_json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fleetmap::apps {
namespace {

registration::RegistrationResult ambiguous() {
  registration::RegistrationResult result;
  result.verdict = registration::Verdict::ambiguous;
  result.reason = "two rows fit";
  result.T_target_source = make_pose(rotation_from_rpy(0.0, 0.0, 0.5), {1.0, 2.0, 3.0});
  result.rmse = 0.25;
  result.covariance(0, 5) = 0.125;
  result.inliers = 77;
  registration::Mode mode;
  mode.T_target_source = result.T_target_source;
  mode.weight = 0.75;
  result.modes.push_back(mode);
  mode.T_target_source = make_pose(Eigen::Matrix3d::Identity(), {-4.0, 0.0, 0.0});
  mode.weight = 0.25;
  result.modes.push_back(mode);
  return result;
}

TEST(RegistrationJson, MatricesAreListsOfRows) {
  const nlohmann::json json = to_json(ambiguous(), registration::Method::correlation);
  const Eigen::Matrix4d T = ambiguous().T_target_source.matrix();
  ASSERT_EQ(json["T_target_source"].size(), 4u);
  for (int r = 0; r < 4; ++r) {
    ASSERT_EQ(json["T_target_source"][static_cast<std::size_t>(r)].size(), 4u);
    for (int c = 0; c < 4; ++c)
      EXPECT_EQ(json["T_target_source"][static_cast<std::size_t>(r)][static_cast<std::size_t>(c)], T(r, c));
  }
  ASSERT_EQ(json["covariance"].size(), 6u);
  EXPECT_EQ(json["covariance"][0][5], 0.125);
  EXPECT_EQ(json["covariance"][5][0], 0.0) << "rows, not columns";
}

TEST(RegistrationJson, HasTheVerdictItsReasonAndAllModesInTheirOrder) {
  const nlohmann::json json = to_json(ambiguous(), registration::Method::paper);
  EXPECT_EQ(json["method"], "paper");
  EXPECT_EQ(json["verdict"], "ambiguous");
  EXPECT_EQ(json["reason"], "two rows fit");
  EXPECT_EQ(json["rmse"], 0.25);
  EXPECT_EQ(json["inliers"], 77);
  ASSERT_EQ(json["modes"].size(), 2u);
  EXPECT_EQ(json["modes"][0]["weight"], 0.75);
  EXPECT_EQ(json["modes"][1]["T_target_source"][0][3], -4.0);
  for (const char* key : {"score", "rmse", "inlier_fraction", "overlap"})
    EXPECT_TRUE(json["modes"][1].contains(key)) << key;
}

}  // namespace
}  // namespace fleetmap::apps
