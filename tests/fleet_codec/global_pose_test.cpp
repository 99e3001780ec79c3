#include "fleetmap/geometry/global_pose.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "fleetmap/fleet_codec/messages.hpp"
#include "random_messages.hpp"
#include "support/field_bounds.hpp"
#include "wire_bytes.hpp"

namespace fleetmap::fleet_codec {
namespace {

using fleet_codec::testing::RandomMessages;
using fleet_codec::testing::WireBytes;
using fleetmap::testing::kNaN;
using ::testing::HasSubstr;

TEST(GlobalPoseCodec, KeepsEveryBit) {
  RandomMessages random(1);
  for (int k = 0; k < 50; ++k) {
    const GlobalPose pose = random.global_pose();
    const auto again = decode<GlobalPose>(encode(pose));
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(again->stamp, pose.stamp);
    EXPECT_EQ(again->position, pose.position);
    EXPECT_EQ(again->q_enu_base.coeffs(), pose.q_enu_base.coeffs());
    EXPECT_EQ(again->covariance.triangularView<Eigen::Upper>().toDenseMatrix(),
              pose.covariance.triangularView<Eigen::Upper>().toDenseMatrix());
    EXPECT_EQ(again->covariance, again->covariance.transpose());
  }
}

TEST(GlobalPoseCodec, LiesOnTheWireAsTheIdlHasIt) {
  GlobalPose pose;
  pose.stamp = stamp_from_ns(0x0102030405060708);
  pose.position = {0.5, -0.25, 110.5};
  pose.q_enu_base = Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5);  // w, x, y, z
  WireBytes wire;
  wire.octet(kSchemaVersion).number(std::int64_t{0x0102030405060708});
  wire.f64(0.5).f64(-0.25).f64(110.5).f64(-0.5).f64(0.5).f64(-0.5).f64(0.5);
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) {
      const double value = row == column ? 10.0 + row : 0.1 * (row + 1) + 0.01 * column;
      pose.covariance(row, column) = pose.covariance(column, row) = value;
      wire.f64(value);
    }
  }
  EXPECT_EQ(encode(pose), wire.bytes());
  ASSERT_TRUE(decode<GlobalPose>(wire.bytes()));
}

TEST(GlobalPoseCodec, InvalidPoseIsRefusedWithTheReason) {
  struct Case {
    const char* reason;
    std::function<void(GlobalPose&)> change;
  };
  const Case cases[] = {
      {"stamp is outside 1970 to 2116", [](GlobalPose& p) { p.stamp = stamp_from_ns(-1); }},
      {"position is not on Earth", [](GlobalPose& p) { p.position.latitude = 1.58; }},
      {"position is not on Earth", [](GlobalPose& p) { p.position.longitude = -3.15; }},
      {"position is not on Earth", [](GlobalPose& p) { p.position.altitude = kNaN<double>; }},
      {"position is not on Earth", [](GlobalPose& p) { p.position.altitude = 1.1e5; }},
      {"norm of orientation", [](GlobalPose& p) { p.q_enu_base.coeffs() *= 1.00001; }},
      {"norm of orientation", [](GlobalPose& p) { p.q_enu_base.x() = kNaN<double>; }},
      {"covariance is not finite", [](GlobalPose& p) { p.covariance(0, 5) = kNaN<double>; }},
      {"covariance has a negative variance", [](GlobalPose& p) { p.covariance(3, 3) = -1e-9; }},
      {"covariance has a correlation beyond 1", [](GlobalPose& p) { p.covariance(1, 2) = 1.01; }},
  };
  for (const Case& bad : cases) {
    GlobalPose pose{
        stamp_from_ns(1), {0.8, 0.1, 100.0}, Eigen::Quaterniond::Identity(), Matrix6d::Identity()};
    ASSERT_TRUE(decode<GlobalPose>(encode(pose)));
    bad.change(pose);
    const auto decoded = decode<GlobalPose>(encode(pose));
    ASSERT_FALSE(decoded) << bad.reason;
    EXPECT_THAT(decoded.error().message, HasSubstr(std::string("fleetmap::msg::GlobalPose: ") + bad.reason));
  }
}

}  // namespace
}  // namespace fleetmap::fleet_codec
