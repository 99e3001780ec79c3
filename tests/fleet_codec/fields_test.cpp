#include "fields.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include "random_messages.hpp"
#include "support/field_bounds.hpp"

namespace fleetmap::fleet_codec {
namespace {

using fleet_codec::testing::id;
using fleet_codec::testing::RandomMessages;
using fleetmap::testing::kNaN;
using ::testing::HasSubstr;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// The first rule that `read` broke; "none" if it kept all.
template <class Read>
std::string broken(const Read& read) {
  FieldCheck check("Some");
  read(check);
  const auto result = check.finish(0);
  return result ? "none" : result.error().message;
}

TEST(FieldCheck, TellsTheFirstBrokenRuleWithItsType) {
  FieldCheck check("fleetmap::msg::Some");
  check.require(true, "kept");
  EXPECT_EQ(check.finish(5).value(), 5);
  check.require(false, "first");
  check.require(false, "second");
  check.require(true, "kept");
  EXPECT_EQ(check.finish(5).error().message, "fleetmap::msg::Some: first");
}

TEST(FieldCheck, NamesOfAgentsArePaddedAndFollowTheirRule) {
  for (const char* name : {"a", "r1", "robot-08", "x_9"}) {
    FieldCheck check("Some");
    const AgentName octets = agent_name(id(name));
    EXPECT_EQ(std::string(octets.begin(), octets.begin() + static_cast<std::ptrdiff_t>(std::strlen(name))),
              name);
    EXPECT_EQ(check.agent(octets, "sender"), id(name));
    EXPECT_TRUE(check.finish(0));
  }
  const auto refusal = [](const AgentName& name) {
    return broken([&](FieldCheck& c) { c.agent(name, "sender"); });
  };
  EXPECT_EQ(refusal({'r', 0, '1'}), "Some: sender: agent id is not padded with zeros");
  EXPECT_EQ(refusal({0, 0, 0, 0, 0, 0, 0, 'a'}), "Some: sender: agent id is not padded with zeros");
  const std::string rule = "Some: sender: agent id must be 1 to 8 characters of a-z, 0-9, '_' and '-'";
  EXPECT_EQ(refusal({}), rule);
  EXPECT_EQ(refusal({'R', '1'}), rule);
  EXPECT_EQ(refusal({0xff, '\n'}), rule) << "which does not repeat the bytes";
}

TEST(FieldCheck, NumbersOfItemsAndRangesHaveAnEnd) {
  EXPECT_EQ(broken([](FieldCheck& c) { EXPECT_EQ(c.seq(kEndOfSeqs - 1, "seq"), kEndOfSeqs - 1); }), "none");
  EXPECT_EQ(broken([](FieldCheck& c) { c.seq(kEndOfSeqs, "seq"); }),
            "Some: seq: sequence number 4294901760 is too large");
  const auto refusal = [](const std::vector<SeqRange>& input, std::size_t limit) {
    return broken([&](FieldCheck& c) { c.ranges(ranges(input, 100), limit, "nodes"); });
  };
  const SeqRange one{id("r1"), 3, 9}, all{id("r2"), 0, kEndOfSeqs}, none{id("r3"), 5, 5};
  FieldCheck check("Some");
  EXPECT_EQ(check.ranges(ranges({one, all, none}, 100), 3, "nodes"), (std::vector<SeqRange>{one, all, none}));
  EXPECT_TRUE(check.finish(0));
  EXPECT_EQ(ranges({one, all, none}, 2).size(), 2u);
  EXPECT_EQ(refusal({one, all, none}, 2), "Some: nodes: more than 2 ranges");
  EXPECT_EQ(refusal({{id("r1"), 9, 8}}, 9), "Some: nodes: range [9, 8) is out of order or too large");
  EXPECT_EQ(refusal({{id("r1"), 0, kEndOfSeqs + 1}}, 9),
            "Some: nodes: range [0, 4294901761) is out of order or too large");
}

TEST(FieldCheck, NumbersStayWithinTheirLimitsAndNeverPassAsNan) {
  for (const double bad : {2.001, -2.001, kNaN<double>, kInfinite, -kInfinite})
    EXPECT_EQ(broken([&](FieldCheck& c) { c.within(bad, 2.0, "x"); }),
              "Some: x is not finite or beyond its range");
  for (const double bad : {2.001, -0.001, kNaN<double>, kInfinite})
    EXPECT_EQ(broken([&](FieldCheck& c) { c.size(bad, 2.0, "x"); }),
              "Some: x is negative, not finite or too large");
  EXPECT_EQ(broken([](FieldCheck& c) {
              EXPECT_EQ(c.within(-2.0, 2.0, "x"), -2.0);
              EXPECT_EQ(c.size(0.0, 2.0, "x"), 0.0);
              EXPECT_EQ(c.size(2.0, 2.0, "x"), 2.0);
              EXPECT_EQ(c.translation({1e7f, -1e7f, 0.5f}, "t"), Eigen::Vector3d(1e7, -1e7, 0.5));
            }),
            "none");
  EXPECT_THAT(broken([](FieldCheck& c) {
                c.translation({0.0f, 0.0f, 1.01e7f}, "t");
              }),
              HasSubstr("t is not finite"));
}

TEST(FieldCheck, DifferencesOfStampsCannotOverflow) {
  constexpr std::int64_t kLast = std::int64_t{1} << 62;
  EXPECT_EQ(broken([&](FieldCheck& c) {
              EXPECT_EQ(to_ns(c.stamp(0)), 0);
              EXPECT_EQ(to_ns(c.stamp(kLast)), kLast);
            }),
            "none");
  for (const std::int64_t bad : {std::int64_t{-1}, kLast + 1, std::numeric_limits<std::int64_t>::max(),
                                 std::numeric_limits<std::int64_t>::min()}) {
    EXPECT_EQ(broken([&](FieldCheck& c) { EXPECT_EQ(to_ns(c.stamp(bad)), 0); }),
              "Some: stamp is outside 1970 to 2116");
  }
}

TEST(FieldCheck, ASignatureHas64BytesOrNone) {
  Signature signature{};
  for (std::size_t k = 0; k < signature.size(); ++k) signature[k] = static_cast<std::uint8_t>(k);
  FieldCheck check("Some");
  EXPECT_EQ(check.signature(signature_bytes(signature)), signature);
  EXPECT_EQ(check.signature(signature_bytes(std::nullopt)), std::nullopt);
  EXPECT_TRUE(check.finish(0));
  for (const std::size_t size : {1u, 63u, 65u}) {
    EXPECT_EQ(broken([&](FieldCheck& c) { EXPECT_FALSE(c.signature(Bytes(size))); }),
              "Some: the signature has not 64 bytes");
  }
}

TEST(Fields, FloatsAreClampedToFiniteOnes) {
  EXPECT_EQ(to_float(1.5), 1.5f);
  EXPECT_EQ(to_float(1e300), std::numeric_limits<float>::max());
  EXPECT_EQ(to_float(-kInfinite), -std::numeric_limits<float>::max());
  EXPECT_TRUE(std::isnan(to_float(kNaN<double>))) << "its reader refuses it";
  EXPECT_EQ(bounded({1, 2, 3}, 2), (Bytes{1, 2}));
  EXPECT_EQ(bounded({1, 2, 3}, 4), (Bytes{1, 2, 3}));
}

template <class Int>
void expect_rotations_come_back(double step) {
  RandomMessages random(1);
  for (int k = 0; k < 2000; ++k) {
    const Eigen::Matrix3d R = random.rotation();
    const auto code = encode_rotation<Int>(R);
    FieldCheck check("Some");
    const Eigen::Matrix3d again = decode_rotation(code, check, "rotation");
    ASSERT_TRUE(check.finish(0));
    ASSERT_LT(so3_log(R.transpose() * again).norm(), step);
    ASSERT_EQ(encode_rotation<Int>(again), code) << "rounding twice is rounding once";
  }
}

TEST(Fields, RotationsComeBackWithinAStepOfTheirUnit) {
  // Half a step on each axis; next to half a turn codes are pulled inside, which takes two steps more.
  expect_rotations_come_back<std::int16_t>(3.1 * std::numbers::pi / 32767.0);
  expect_rotations_come_back<std::int32_t>(1.2e-6 * std::numbers::pi);
}

TEST(Fields, InvalidRotationIsEncodedAsARefusedCode) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R(2, 1) = kNaN<double>;
  const auto code = encode_rotation<std::int16_t>(R);
  EXPECT_EQ(broken([&](FieldCheck& c) { decode_rotation(code, c, "no rotation"); }), "Some: no rotation");
  for (const std::array<std::int16_t, 3>& beyond :
       {std::array<std::int16_t, 3>{32767, 0, 0}, {23200, 23200, 0}}) {
    EXPECT_EQ(broken([&](FieldCheck& c) { decode_rotation(beyond, c, "no rotation"); }), "Some: no rotation")
        << "beyond half a turn";
  }
}

TEST(Fields, LogarithmicStepsAreTheNearest) {
  constexpr LogScale<std::uint8_t> scale{1e-4, 16.0};
  for (int code = 0; code < 256; ++code)
    EXPECT_EQ(scale.encode(scale.decode(static_cast<std::uint8_t>(code))), code);
  EXPECT_NEAR(scale.decode(16), 2e-4, 1e-18);
  EXPECT_EQ(scale.encode(1e-4 * std::exp2(10.49 / 16.0)), 10);
  EXPECT_EQ(scale.encode(1e-4 * std::exp2(10.51 / 16.0)), 11);
  for (const double small : {0.0, -1.0, 1e-9, -kInfinite}) EXPECT_EQ(scale.encode(small), 0) << small;
  for (const double large : {1e9, kInfinite, kNaN<double>}) EXPECT_EQ(scale.encode(large), 255) << large;
}

TEST(Fields, OfACovarianceTheUpperTriangleIsKeptAndChecked) {
  Matrix6d C;
  for (int row = 0; row < 6; ++row) {
    for (int col = 0; col < 6; ++col) C(row, col) = row == col ? 10.0 + row : 0.1 * (row + col);
  }
  const auto upper = upper_triangle<double>(C);
  EXPECT_EQ(upper[1], C(0, 1));
  EXPECT_EQ(upper[6], C(1, 1));
  EXPECT_EQ(upper[20], C(5, 5));
  FieldCheck check("Some");
  EXPECT_EQ(covariance_from(upper, check), C);
  EXPECT_TRUE(check.finish(0));
  Matrix6d beyond = C;
  beyond(0, 1) = 1.001 * std::sqrt(C(0, 0) * C(1, 1));
  EXPECT_EQ(broken([&](FieldCheck& c) { covariance_from(upper_triangle<double>(beyond), c); }),
            "Some: covariance has a correlation beyond 1");
}

}  // namespace
}  // namespace fleetmap::fleet_codec
