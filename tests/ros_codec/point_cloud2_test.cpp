#include "fleetmap/ros_codec/point_cloud2.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <random>
#include <tuple>

#include "fleetmap/bus/cdr.hpp"
#include "sensor_msgs.h"

namespace fleetmap::ros_codec {
namespace {

using sensor_msgs::msg::dds_::PointCloud2_;
using ::testing::HasSubstr;

enum : std::uint8_t { kUint8 = 2, kUint16 = 4, kUint32 = 6, kFloat32 = 7, kFloat64 = 8 };

struct Column {
  std::string name;
  std::uint8_t datatype;
  std::uint32_t offset;
  std::vector<double> values;
};

template <class T>
void store(std::uint8_t* at, double value, bool swap) {
  auto raw = std::bit_cast<std::array<std::uint8_t, sizeof(T)>>(static_cast<T>(value));
  if (swap) std::reverse(raw.begin(), raw.end());
  std::memcpy(at, raw.data(), sizeof(T));
}

/// As a driver would lay it out.
PointCloud2_ message(const std::vector<Column>& columns, std::uint32_t point_step, bool big_endian = false) {
  PointCloud2_ out;
  out.header().stamp().sec(1000);
  out.height(1);
  out.width(static_cast<std::uint32_t>(columns.front().values.size()));
  out.point_step(point_step);
  out.row_step(point_step * out.width());
  out.is_bigendian(big_endian);
  out.data().resize(out.row_step());
  for (const Column& column : columns) {
    sensor_msgs::msg::dds_::PointField_ field;
    field.name(column.name);
    field.offset(column.offset);
    field.datatype(column.datatype);
    field.count(1);
    out.fields().push_back(field);
    for (std::size_t k = 0; k < column.values.size(); ++k) {
      std::uint8_t* at = out.data().data() + k * point_step + column.offset;
      switch (column.datatype) {
        case kUint8:
          store<std::uint8_t>(at, column.values[k], big_endian);
          break;
        case kUint16:
          store<std::uint16_t>(at, column.values[k], big_endian);
          break;
        case kUint32:
          store<std::uint32_t>(at, column.values[k], big_endian);
          break;
        case kFloat32:
          store<float>(at, column.values[k], big_endian);
          break;
        default:
          store<double>(at, column.values[k], big_endian);
          break;
      }
    }
  }
  return out;
}

std::vector<Column> xyz() {
  return {{"x", kFloat32, 0, {1, 2, 3}}, {"y", kFloat32, 4, {4, 5, 6}}, {"z", kFloat32, 8, {7, 8, 9}}};
}
PointCloud2_ with_time(const std::string& name, std::uint8_t datatype, std::vector<double> values) {
  auto columns = xyz();
  columns.push_back({name, datatype, 16, std::move(values)});
  return message(columns, 24);
}
DecodedScan read(const PointCloud2_& m) {
  auto decoded = decode_scan(bus::to_cdr(m));
  EXPECT_TRUE(decoded) << decoded.error().message;
  return decoded.value_or(DecodedScan{});
}
std::string refusal(const PointCloud2_& m) {
  const auto decoded = decode_scan(bus::to_cdr(m));
  return decoded ? "accepted" : decoded.error().message;
}

TEST(PointCloud2, CoordinatesMayBeDoubles) {
  const std::vector<Column> doubles{
      {"x", kFloat64, 0, {1, 2, 1e300}}, {"y", kFloat64, 8, {4, 5, 6}}, {"z", kFloat64, 16, {7, -8.5, 9}}};
  for (const bool big_endian : {false, true}) {
    const DecodedScan decoded = read(message(doubles, 24, big_endian));
    ASSERT_EQ(decoded.scan.points.size(), 2u);
    EXPECT_EQ(decoded.non_finite_points, 1u) << "1e300 is no float";
    EXPECT_EQ(decoded.scan.points[1].position, Eigen::Vector3f(2.0f, 5.0f, -8.5f));
  }
}

TEST(PointCloud2, RoundTripOfEveryKindOfScan) {
  std::mt19937 engine(31);
  std::uniform_real_distribution<float> metres(-40.0f, 40.0f);
  for (const bool has_time : {false, true}) {
    for (const bool has_ring : {false, true}) {
      sensor::Scan scan;
      scan.stamp = stamp_from_ns(1'700'000'000'987'654'321);
      scan.has_time = has_time;
      scan.has_ring = has_ring;
      for (int k = 0; k < 1000; ++k) {
        scan.points.push_back({{metres(engine), metres(engine), metres(engine)},
                               metres(engine),
                               has_time ? static_cast<float>(k) * 1e-4f : 0.0f,
                               static_cast<std::uint16_t>(has_ring ? k % 16 : 0)});
      }
      const auto back = decode<sensor::Scan>(encode(scan));
      ASSERT_TRUE(back) << back.error().message;
      EXPECT_EQ(back->stamp, scan.stamp);
      EXPECT_EQ(back->has_time, has_time);
      EXPECT_EQ(back->has_ring, has_ring);
      ASSERT_EQ(back->points.size(), scan.points.size());
      for (std::size_t k = 0; k < scan.points.size(); ++k) {
        ASSERT_EQ(back->points[k].position, scan.points[k].position);
        ASSERT_EQ(back->points[k].intensity, scan.points[k].intensity);
        ASSERT_EQ(back->points[k].time, scan.points[k].time);
        ASSERT_EQ(back->points[k].ring, scan.points[k].ring);
      }
    }
  }
}

TEST(PointCloud2, FieldsInAnyOrderOffsetAndByteOrder) {
  for (const bool big_endian : {false, true}) {
    const auto scan = read(message({{"ring", kUint8, 3, {0, 15, 7}},
                                    {"z", kFloat32, 21, {7, 8, 9}},
                                    {"reflectivity", kUint16, 25, {1, 1, 1}},
                                    {"intensity", kUint16, 5, {100, 200, 65535}},
                                    {"x", kFloat32, 9, {1, 2, 3}},
                                    {"y", kFloat32, 14, {4, 5, 6}}},
                                   31, big_endian))
                          .scan;
    ASSERT_EQ(scan.points.size(), 3u);
    EXPECT_EQ(scan.points[1].position, Eigen::Vector3f(2, 5, 8));
    EXPECT_EQ(scan.points[1].ring, 15);
    EXPECT_EQ(scan.points[2].intensity, 65535.0f);
    EXPECT_TRUE(scan.has_ring);
    EXPECT_FALSE(scan.has_time);
  }
}

TEST(PointCloud2, ChannelIsARing) {
  auto columns = xyz();
  columns.push_back({"channel", kUint32, 12, {1, 2, 3}});
  EXPECT_EQ(read(message(columns, 16)).scan.points[2].ring, 3);
}

TEST(PointCloud2, TimesOfAllDrivers) {
  const struct {
    const char* name;
    std::uint8_t datatype;
    std::vector<double> values;
  } cases[] = {
      {"time", kFloat32, {0.0, 0.05, 0.1}},
      {"t", kUint32, {0, 5e7, 1e8}},
      {"offset_time", kUint32, {0, 5e7, 1e8}},
      {"timestamp", kFloat64, {1000.0, 1000.05, 1000.1}},
      {"timestamp", kFloat64, {1000e9 * 1.0, 1000.05e9, 1000.1e9}},
      {"time_stamp", kFloat64, {0.0, 0.05, 0.1}},
  };
  for (const auto& c : cases) {
    const auto decoded = read(with_time(c.name, c.datatype, c.values));
    ASSERT_TRUE(decoded.scan.has_time) << c.name;
    EXPECT_FALSE(decoded.foreign_clock);
    EXPECT_NEAR(decoded.scan.points[0].time, 0.0, 1e-6) << c.name;
    EXPECT_NEAR(decoded.scan.points[1].time, 0.05, 1e-6) << c.name;
    EXPECT_NEAR(decoded.scan.points[2].time, 0.1, 1e-6) << c.name;
  }
}

TEST(PointCloud2, TimesBeforeTheStampStayNegative) {
  const auto decoded = read(with_time("time", kFloat32, {-0.1, -0.05, 0.0}));
  EXPECT_NEAR(decoded.scan.points[0].time, -0.1, 1e-6);
}

TEST(PointCloud2, AForeignClockIsCountedFromItsFirstPoint) {
  const auto decoded = read(with_time("timestamp", kFloat64, {52.0, 52.05, 52.1}));
  EXPECT_TRUE(decoded.foreign_clock);
  EXPECT_NEAR(decoded.scan.points[2].time, 0.1, 1e-6);
}

TEST(PointCloud2, TimesThatCannotBeTrueAreNoTimes) {
  EXPECT_FALSE(read(with_time("time", kFloat32, {0, 0, 0})).scan.has_time);
  EXPECT_FALSE(read(with_time("time", kFloat32, {0, std::nan(""), 0.1})).scan.has_time);
  EXPECT_FALSE(read(with_time("time", kFloat32, {0, 50, 2000})).scan.has_time);
  EXPECT_FALSE(read(with_time("timestamp", kFloat32, {1.7e9, 1.7e9, 1.7001e9})).scan.has_time);
}

TEST(PointCloud2, NonReturnsAreDroppedAndCounted) {
  const double nan = std::nan("");
  const auto decoded = read(message({{"x", kFloat32, 0, {nan, 0, 1, INFINITY}},
                                     {"y", kFloat32, 4, {1, 0, 1, 1}},
                                     {"z", kFloat32, 8, {1, 0, 1, 1}},
                                     {"t", kUint32, 12, {0, 1e6, 3e6, 4e6}}},
                                    16));
  EXPECT_EQ(decoded.scan.points.size(), 1u);
  EXPECT_EQ(decoded.non_finite_points, 2u);
  EXPECT_EQ(decoded.origin_points, 1u);
  EXPECT_NEAR(decoded.scan.points[0].time, 3e-3, 1e-9);
}

TEST(PointCloud2, OrganisedCloudsWithPaddedRows) {
  auto m = message(xyz(), 12);
  m.height(2);
  m.width(1);
  m.row_step(24);
  const auto scan = read(m).scan;
  ASSERT_EQ(scan.points.size(), 2u);
  EXPECT_EQ(scan.points[1].position, Eigen::Vector3f(3, 6, 9));
}

TEST(PointCloud2, RowsWithoutPointsTakeNoTime) {
  auto m = message(xyz(), 12);
  m.height(0xffffffff);
  m.width(0);
  m.row_step(0);
  EXPECT_TRUE(read(m).scan.points.empty());
}

TEST(PointCloud2, ContradictionsAreRefused) {
  auto m = message(xyz(), 12);
  m.width(4);
  m.row_step(48);
  EXPECT_THAT(refusal(m), HasSubstr("data has 36 bytes, too few for height 1 x row_step 48"));
  m = message(xyz(), 12);
  m.row_step(20);
  EXPECT_THAT(refusal(m), HasSubstr("row_step 20 is less than width 3 x point_step 12"));
  m = message(xyz(), 12);
  m.height(0xffffffff);
  m.row_step(0xffffffff);
  EXPECT_THAT(refusal(m), HasSubstr("too few for height"));
  m = message(xyz(), 12);
  m.point_step(0);
  EXPECT_THAT(refusal(m), HasSubstr("point_step is 0"));
  m = message(xyz(), 12);
  m.point_step(10);
  m.row_step(36);
  EXPECT_THAT(refusal(m), HasSubstr("no field 'z' of float32 or float64 within point_step; fields: x, y, z"));
  auto integers = xyz();
  integers[1].datatype = kUint32;
  EXPECT_THAT(refusal(message(integers, 12 + 4)), HasSubstr("no field 'y' of float32 or float64"));
  m = message(xyz(), 12);
  m.fields().resize(300);
  EXPECT_THAT(refusal(m), HasSubstr("300 point fields"));
}

TEST(PointCloud2, NoiseIsRefused) {
  std::mt19937 engine(13);
  for (int round = 0; round < 2000; ++round) {
    Bytes bytes(5 + engine() % 396);
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(engine());
    bytes[0] = 0;
    bytes[1] = static_cast<std::uint8_t>(round & 1);
    EXPECT_FALSE(decode_scan(bytes));
  }
}

TEST(PointCloud2, TruncationsAndDamageNeverCrash) {
  auto columns = xyz();
  columns.push_back({"t", kUint32, 12, {0, 5e7, 1e8}});
  columns.push_back({"ring", kUint16, 16, {0, 1, 2}});
  const Bytes whole = bus::to_cdr(message(columns, 18));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    // The last member is is_dense; its absence is a truncation like any other.
    EXPECT_FALSE(decode_scan(ByteView(whole).first(size))) << size;
  }
  std::mt19937 engine(32);
  std::size_t accepted = 0;
  for (int round = 0; round < 20'000; ++round) {
    Bytes bytes = whole;
    for (int flips = 0; flips < 3; ++flips)
      bytes[engine() % bytes.size()] ^= static_cast<std::uint8_t>(1u << (engine() % 8));
    const auto decoded = decode_scan(bytes);
    if (!decoded) continue;
    ++accepted;
    EXPECT_LE(decoded->scan.points.size(), whole.size() / 4);
  }
  EXPECT_GT(accepted, 1000u);
}

TEST(PointCloud2, FloatTimesOfASweepInOneUnitAloneAreConverted) {
  using enum TimeUnit;
  for (const auto& [unit, scale] : {std::pair{kAsDefined, 1.0}, std::pair{kMilliseconds, 1e3},
                                    std::pair{kMicroseconds, 1e6}, std::pair{kNanoseconds, 1e9}}) {
    for (const std::uint8_t type : {std::uint8_t{kFloat32}, std::uint8_t{kFloat64}}) {
      auto columns = xyz();
      columns.push_back({"time", type, 12, {0.0, 0.05 * scale, 0.1 * scale}});
      const auto decoded = decode_scan(bus::to_cdr(message(columns, 20)));
      ASSERT_TRUE(decoded);
      EXPECT_EQ(decoded->time_unit, unit) << scale;
      ASSERT_TRUE(decoded->scan.has_time);
      EXPECT_NEAR(decoded->scan.points[1].time, 0.05, 1e-6);
      EXPECT_EQ(finding_of(unit).empty(), unit == kAsDefined);
    }
  }
}

TEST(PointCloud2, DatesInMilliAndMicrosecondsAreConverted) {
  using enum TimeUnit;
  constexpr double kStamp = 1.7e9, kAnHourAhead = kStamp + 3600.0, kSinceBoot = 5.4e4;
  for (const auto& [zero, scale, unit] :
       {std::tuple{kStamp, 1.0, kAsDefined}, std::tuple{kStamp, 1e3, kMilliseconds},
        std::tuple{kStamp, 1e6, kMicroseconds}, std::tuple{kStamp, 1e9, kAsDefined},
        std::tuple{kAnHourAhead, 1e3, kMilliseconds}, std::tuple{kSinceBoot, 1e9, kAsDefined}}) {
    auto m = with_time("timestamp", kFloat64,
                       {(zero + 0.02) * scale, (zero + 0.07) * scale, (zero + 0.12) * scale});
    m.header().stamp().sec(static_cast<std::int32_t>(kStamp));
    const DecodedScan decoded = read(m);
    EXPECT_EQ(decoded.time_unit, unit) << zero << ' ' << scale;
    EXPECT_EQ(decoded.foreign_clock, zero != kStamp) << zero << ' ' << scale;
    EXPECT_NEAR(decoded.scan.points[1].time, zero == kStamp ? 0.07 : 0.05, 1e-5) << zero << ' ' << scale;
  }
}

TEST(PointCloud2, FloatTimesOfASweepInNoUnitAreNotUsed) {
  for (const auto& [middle, last] : {std::pair{1.5, 3.0}, std::pair{0.05, 100.0}, std::pair{1e9, 3e9}}) {
    std::vector<Column> columns = xyz();
    for (Column& column : columns) column.values.assign(9, column.values[1]);
    columns.push_back({"timestamp", kFloat64, 12, std::vector<double>(9, middle)});
    columns.back().values.front() = 0.0;
    columns.back().values.back() = last;
    const auto decoded = decode_scan(bus::to_cdr(message(columns, 20)));
    ASSERT_TRUE(decoded);
    EXPECT_EQ(decoded->time_unit, TimeUnit::kUnclear) << last;
    EXPECT_FALSE(decoded->scan.has_time) << "of 0.05 and 100 the last is one stray point";
  }
}

}  // namespace
}  // namespace fleetmap::ros_codec
