#include "fleetmap/cloud/las_format.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "cloud/las_reader.hpp"
#include "support/field_bounds.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::cloud {
namespace {

using fleetmap::testing::kNaN;
using fleetmap::testing::LasFile;

const Eigen::Vector3d kNone = Eigen::Vector3d::Zero();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Header and records as a file, read back.
LasFile read_back(const Bytes& bytes) {
  const fleetmap::testing::TemporaryFolder folder;
  return fleetmap::testing::read_las(folder.write("file.las", std::string(bytes.begin(), bytes.end())));
}

LasDescription description() {
  LasDescription description;
  description.wkt = "PROJCS[\"somewhere\"]";
  description.text = "Heights are above the ellipsoid.";
  description.software = "fleetmap 1.2";
  for (std::size_t k = 0; k < 16; ++k) description.project[k] = static_cast<std::uint8_t>(k + 1);
  description.day_of_year = 330;
  description.year = 2026;
  description.offset = {499'000, 4'316'000, -7};
  return description;
}

TEST(LasSteps, AreWithinHalfAStepHoweverFarTheOffset) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> metres(-2'000'000.0, 2'000'000.0);
  for (const Eigen::Vector3i& offset :
       {Eigen::Vector3i(0, 0, 0), Eigen::Vector3i(500'000, 9'999'000, -400)}) {
    for (int k = 0; k < 10'000; ++k) {
      const Eigen::Vector3d p =
          offset.cast<double>() + Eigen::Vector3d(metres(random), metres(random), metres(random));
      const auto steps = las_steps(p, offset);
      ASSERT_TRUE(steps);
      const Eigen::Vector3d back = steps->cast<double>() * kLasStep + offset.cast<double>();
      EXPECT_LE((back - p).cwiseAbs().maxCoeff(), 0.5 * kLasStep + 3e-9);
    }
  }
}

TEST(LasSteps, RefusesWhatDoesNotFit) {
  const Eigen::Vector3i offset(1'000'000, 0, 0);
  const double limit = 2'147'483.647;
  EXPECT_EQ(las_steps({1'000'000 + limit, -limit, limit}, offset),
            Eigen::Vector3i(2147483647, -2147483647, 2147483647));
  for (const double wrong : {kNaN<double>, kInfinity, -kInfinity, limit + 0.001, -limit - 0.001, 1e300}) {
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Vector3d p = offset.cast<double>();
      p[axis] += wrong;
      EXPECT_FALSE(las_steps(p, offset)) << wrong;
    }
  }
}

TEST(LasFormat, HeaderAndPointsAreReadBackByTheSpecification) {
  LasTotals totals;
  Bytes records;
  const std::vector<std::pair<Eigen::Vector3i, LasPoint>> points{{{-1000, 5, 123456789}, {kNone, 65535, 1}},
                                                                 {{20, -7, -2147483647}, {kNone, 0, 255}},
                                                                 {{0, 0, 0}, {kNone, 258, 3}}};
  for (const auto& [steps, point] : points) {
    totals.add(steps);
    append_las_record(records, steps, point);
  }
  EXPECT_EQ(records.size(), points.size() * kLasRecordSize);
  Bytes bytes = las_header(description(), totals);
  EXPECT_EQ(bytes.size(), las_header(description(), {}).size())
      << "it is written before the points are counted";
  bytes.insert(bytes.end(), records.begin(), records.end());
  const LasFile file = read_back(bytes);
  EXPECT_EQ(file.signature, "LASF");
  EXPECT_EQ(file.major * 10 + file.minor, 14);
  EXPECT_EQ(file.global_encoding, 16) << "WKT, and nothing else";
  EXPECT_EQ(file.project, description().project);
  EXPECT_EQ(file.system, "MERGE");
  EXPECT_EQ(file.software, "fleetmap 1.2");
  EXPECT_EQ(file.day_of_year, 330);
  EXPECT_EQ(file.year, 2026);
  EXPECT_EQ(file.format, 6);
  EXPECT_EQ(file.legacy_points, 0u);
  EXPECT_EQ(file.count, 3u);
  EXPECT_EQ(file.first_returns, 3u);
  EXPECT_EQ(file.scale, Eigen::Vector3d::Constant(0.001));
  EXPECT_EQ(file.offset, Eigen::Vector3d(499'000, 4'316'000, -7));
  EXPECT_EQ(file.wkt(), description().wkt);
  EXPECT_EQ(file.text(), description().text);
  Eigen::Vector3d min = file.points[0].position, max = min;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const LasFile::Point& point = file.points[k];
    EXPECT_EQ(point.position, (points[k].first.cast<double>() * 0.001 + file.offset).eval());
    EXPECT_EQ(point.intensity, points[k].second.intensity);
    EXPECT_EQ(point.source, points[k].second.source);
    EXPECT_EQ(point.returns, 0x11) << "the first of one";
    EXPECT_EQ(point.flags + point.classification, 0);
    EXPECT_EQ(point.gps_time, 0.0);
    min = min.cwiseMin(point.position);
    max = max.cwiseMax(point.position);
  }
  EXPECT_EQ(file.min, min);
  EXPECT_EQ(file.max, max);
}

TEST(LasFormat, AFileWithoutPointsHasNoBounds) {
  const LasFile file = read_back(las_header(description(), {}));
  EXPECT_EQ(file.count, 0u);
  EXPECT_TRUE(file.points.empty());
  EXPECT_EQ(file.min, Eigen::Vector3d::Zero());
  EXPECT_EQ(file.max, Eigen::Vector3d::Zero());
}

TEST(LasFormat, TextsThatAreTooLongAreCut) {
  LasDescription long_one = description();
  long_one.software = std::string(50, 's');
  long_one.wkt = std::string(70'000, 'w');
  long_one.text = "";
  const LasFile file = read_back(las_header(long_one, {}));
  EXPECT_EQ(file.software, std::string(32, 's'));
  EXPECT_EQ(file.wkt(), std::string(65'534, 'w'));
  EXPECT_EQ(file.text(), "");
}

}  // namespace
}  // namespace fleetmap::cloud
