#include "fleetmap/sim/lidar.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <set>
#include <thread>

#include "fleetmap/sim/robot_twin.hpp"
#include "shapes.hpp"

namespace fleetmap::sim {
namespace {

using ::testing::HasSubstr;

std::shared_ptr<const Scene> made_scene(const Mesh& mesh) {
  auto scene = Scene::create(mesh);
  EXPECT_TRUE(scene.has_value()) << (scene ? "" : scene.error().message);
  return scene.value_or(nullptr);
}

/// Level ground at z = 0 and a wall whose face is x = 10.
Mesh yard(Material wall = Material::kConcrete) {
  Mesh mesh = test_ground({-60, -60}, {60, 60}, [](double, double) { return 0.0; });
  append(mesh, test_box({10, -50, -1}, {11, 50, 20}, wall));
  return mesh;
}

LidarSpec exact() {
  LidarSpec spec = vlp16_spec();
  spec.range_noise = spec.dropout = spec.beam_divergence = 0.0;
  return spec;
}

LidarSpec non_repeating() {
  LidarSpec spec;
  spec.pattern = FiringPattern::kNonRepeating;
  spec.rays = 10000;
  return spec;
}

ScanJob standing(const Pose& T_enu_lidar, std::uint64_t number = 0) {
  ScanJob job;
  job.step = std::chrono::milliseconds(100);
  job.T_enu_lidar = {T_enu_lidar, T_enu_lidar};
  job.number = number;
  job.seed = 5;
  return job;
}

Pose above_ground(double height) {
  return make_pose(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, 0, height));
}

TEST(Scene, RefusesWhatIsNoMesh) {
  EXPECT_THAT(Scene::create({}).error().message, HasSubstr("no triangles"));
  Mesh mesh = yard();
  mesh.vertices[3].x() = std::nanf("");
  EXPECT_THAT(Scene::create(mesh).error().message, HasSubstr("vertex 3"));
  mesh = yard();
  mesh.triangles[7][1] = 4'000'000'000u;
  EXPECT_THAT(Scene::create(mesh).error().message, HasSubstr("triangle 7"));
  mesh = yard();
  mesh.materials.pop_back();
  EXPECT_THAT(Scene::create(mesh).error().message, HasSubstr("materials"));
}

TEST(Scene, DistanceIncidenceAndMaterialOfAWallFromBothSides) {
  const auto scene = made_scene(yard(Material::kMetal));
  const float nan = std::nanf("");
  const float half = std::sqrt(0.5f);
  const std::vector<Ray> rays{{{0, 0, 5}, {1, 0, 0}},      {{0, 0, 5}, {half, half, 0}},
                              {{10.4f, 0, 5}, {-1, 0, 0}}, {{0, 0, 5}, {-1, 0, 0}},
                              {{0, 0, 5}, {nan, 0, 0}},    {{nan, 0, 5}, {1, 0, 0}},
                              {{0, 0, 5}, {0, 0, 0}},      {{0, 0, 5}, {0, 0, -1}}};
  std::vector<Hit> hits(rays.size());
  scene->cast(rays, 0.3f, 30.0f, hits);
  EXPECT_NEAR(hits[0].distance, 10.0f, 1e-5);
  EXPECT_NEAR(hits[0].cos_incidence, 1.0f, 1e-5);
  EXPECT_EQ(hits[0].material, Material::kMetal);
  EXPECT_NEAR(hits[1].distance, 10.0f / half, 1e-4);
  EXPECT_NEAR(hits[1].cos_incidence, half, 1e-5);
  EXPECT_NEAR(hits[2].distance, 0.4f, 1e-5);
  for (const std::size_t k : {3u, 4u, 5u, 6u}) EXPECT_LT(hits[k].distance, 0.0f) << k;
  EXPECT_NEAR(hits[7].distance, 5.0f, 1e-5);
  EXPECT_EQ(hits[7].material, Material::kGround);
  scene->cast(rays, 0.5f, 9.9f, hits);  // out of reach on either end
  EXPECT_LT(hits[0].distance, 0.0f);
  EXPECT_LT(hits[2].distance, 0.0f);
}

TEST(Lidar, RangesAreThoseOfThePlanes) {
  const auto scene = made_scene(yard());
  for (const LidarSpec& base : {exact(), non_repeating()}) {
    LidarSpec spec = base;
    spec.range_noise = spec.dropout = 0.0;
    const sensor::Scan scan = cast_scan(*scene, spec, standing(above_ground(1.5)));
    ASSERT_GT(scan.points.size(), 1000u);
    for (const sensor::ScanPoint& point : scan.points) {
      const bool ground = std::abs(point.position.z() + 1.5f) < 2e-3f;
      const bool wall = std::abs(point.position.x() - 10.0f) < 2e-3f;
      // A beam may meet both where they join.
      const bool corner = std::hypot(point.position.x() - 10.0f, point.position.z() + 1.5f) < 0.2f;
      EXPECT_TRUE(ground || wall || corner) << point.position.transpose();
    }
  }
}

TEST(Lidar, ColumnsFollowOneAnotherClockwiseFromTheRear) {
  const auto scene = made_scene(test_ground({-60, -60}, {60, 60}, [](double, double) { return 0.0; }));
  LidarSpec spec = exact();
  spec.vertical_angles = {-0.2, -0.1};
  const sensor::Scan scan = cast_scan(*scene, spec, standing(above_ground(1.0)));
  ASSERT_EQ(scan.points.size(), 3600u);
  EXPECT_TRUE(scan.has_time && scan.has_ring);
  for (std::size_t k = 0; k < scan.points.size(); ++k) {
    const sensor::ScanPoint& point = scan.points[k];
    EXPECT_EQ(point.ring, k % 2);
    const double turn = static_cast<double>(k / 2) / 1800;
    EXPECT_NEAR(point.time, 0.1 * turn, 1e-6);
    const double azimuth = std::atan2(point.position.y(), point.position.x());
    EXPECT_NEAR(wrap_angle(azimuth - std::numbers::pi + 2.0 * std::numbers::pi * turn), 0.0, 1e-5);
    const double elevation = std::asin(point.position.z() / point.position.norm());
    EXPECT_NEAR(elevation, spec.vertical_angles[point.ring], 1e-5);
  }
}

/// Every return, moved by the pose at its own firing time, lies on the surface it came from.
TEST(Lidar, MotionDistortsTheScanAsThePoseAtEachFiring) {
  const auto scene = made_scene(yard());
  ScanJob job;
  job.step = std::chrono::milliseconds(25);
  for (int k = 0; k <= 4; ++k) {
    job.T_enu_lidar.push_back(
        make_pose(rotation_from_rpy(0.05 * k, -0.03 * k, 0.2 * k), {0.2 * k, -0.1 * k, 1.5 + 0.03 * k}));
  }
  for (const LidarSpec& base : {exact(), non_repeating()}) {
    LidarSpec spec = base;
    spec.range_noise = spec.dropout = spec.beam_divergence = 0.0;
    double worst = 0.0, worst_frozen = 0.0;
    const sensor::Scan scan = cast_scan(*scene, spec, job);
    ASSERT_GT(scan.points.size(), 1000u);
    for (const sensor::ScanPoint& point : scan.points) {
      const auto off = [&](const Pose& T) {
        const Eigen::Vector3d p = T * point.position.cast<double>();
        return std::min({std::abs(p.z()), std::abs(p.x() - 10.0), std::abs(p.x() - 11.0)});
      };
      const double at = static_cast<double>(point.time) / 0.025;
      const auto k = std::min<std::size_t>(static_cast<std::size_t>(at), 3);
      worst = std::max(
          worst, off(interpolate(job.T_enu_lidar[k], job.T_enu_lidar[k + 1], at - static_cast<double>(k))));
      worst_frozen = std::max(worst_frozen, off(job.T_enu_lidar[0]));
    }
    EXPECT_LT(worst, 1e-4);
    EXPECT_GT(worst_frozen, 0.3);
  }
}

TEST(Lidar, NoiseHasItsSigmaAndDropoutItsShare) {
  const auto scene = made_scene(test_ground({-60, -60}, {60, 60}, [](double, double) { return 0.0; }));
  LidarSpec spec = exact();
  spec.vertical_angles = {-0.3};
  spec.range_noise = 0.05;
  spec.dropout = 0.1;
  const double range = 1.5 / std::sin(0.3);
  double sum = 0.0, square = 0.0, points = 0.0;
  for (std::uint64_t number = 0; number < 50; ++number) {
    for (const auto& point : cast_scan(*scene, spec, standing(above_ground(1.5), number)).points) {
      const double error = point.position.norm() - range;
      sum += error, square += error * error, points += 1.0;
    }
  }
  EXPECT_NEAR(points / (50.0 * 1800), 0.9, 0.005);
  EXPECT_NEAR(sum / points, 0.0, 1e-3);
  EXPECT_NEAR(std::sqrt(square / points), 0.05, 1e-3);
}

TEST(Lidar, GlassReturnsNothingAtGrazingIncidence) {
  const auto steepest = [](Material wall) {
    double grazing = 0.0;
    for (const auto& point :
         cast_scan(*made_scene(yard(wall)), exact(), standing(above_ground(1.5))).points) {
      if (std::abs(point.position.x() - 10.0f) > 1e-3f) continue;
      grazing = std::max(grazing, std::acos(10.0 / point.position.norm()));
    }
    return grazing;
  };
  EXPECT_GT(steepest(Material::kConcrete), 1.34);
  EXPECT_NEAR(steepest(Material::kGlass), 1.31, 0.02);
}

/// Two walls, one 0.6 m behind the other's edge: only a beam with divergence returns ranges in between.
TEST(Lidar, BeamsOnAnEdgeReturnRangesBetween) {
  Mesh mesh = test_box({10, -20, -5}, {10.2, 0.005, 20});
  append(mesh, test_box({10.6, -20, -5}, {10.8, 20, 20}));
  const auto scene = made_scene(mesh);
  const auto between = [&](double divergence) {
    LidarSpec spec = exact();
    spec.beam_divergence = divergence;
    int count = 0;
    for (const auto& point : cast_scan(*scene, spec, standing(above_ground(1.5))).points) {
      count +=
          point.position.x() > 10.05f && point.position.x() < 10.55f && std::abs(point.position.y()) < 0.1f;
    }
    return count;
  };
  EXPECT_EQ(between(0.0), 0);
  EXPECT_GT(between(0.02), 5);
}

TEST(Lidar, NonRepeatingPatternFillsItsConeOverTime) {
  const auto scene = made_scene(test_box({-50, -50, -50}, {50, 50, 50}));
  LidarSpec spec = non_repeating();
  spec.rays = 10003;  // no multiple of a packet
  const double half = 0.5 * spec.field_of_view;
  std::set<std::pair<int, int>> cells;
  std::vector<double> filled;
  constexpr double kCell = 0.01;  // rad
  for (std::uint64_t number = 0; number < 20; ++number) {
    const sensor::Scan scan = cast_scan(*scene, spec, standing(above_ground(0.0), number));
    EXPECT_FALSE(scan.has_ring);
    EXPECT_TRUE(std::ranges::is_sorted(scan.points, {}, &sensor::ScanPoint::time));
    for (const auto& point : scan.points) {
      const Eigen::Vector3f d = point.position.normalized();
      const double angle = std::acos(std::min(1.0f, d.x()));
      EXPECT_LE(angle, half + 1e-3);
      const Eigen::Vector2d side = Eigen::Vector2d(d.y(), d.z()).normalized() * angle / kCell;
      cells.emplace(static_cast<int>(std::floor(side.x())), static_cast<int>(std::floor(side.y())));
    }
    filled.push_back(static_cast<double>(cells.size()) * kCell * kCell / (std::numbers::pi * half * half));
  }
  EXPECT_GT(filled[0], 0.2);
  EXPECT_GT(filled[1], 1.2 * filled[0]);
  EXPECT_GT(filled.back(), 0.95);
}

std::string bytes_of(const sensor::Scan& scan) {
  std::string bytes;
  for (const auto& point : scan.points) {
    const float values[] = {point.position.x(), point.position.y(), point.position.z(),
                            point.intensity,    point.time,         static_cast<float>(point.ring)};
    bytes.append(reinterpret_cast<const char*>(values), sizeof values);
  }
  return bytes;
}

TEST(Lidar, SameJobSameBytesOnAnyThread) {
  const auto scene = made_scene(yard(Material::kGlass));
  const LidarSpec spec = vlp16_spec();
  std::vector<std::string> alone(6), together(6);
  const auto run = [&](std::size_t k) {
    return bytes_of(cast_scan(*scene, spec, standing(above_ground(1.0), k / 2)));
  };
  for (std::size_t k = 0; k < alone.size(); ++k) alone[k] = run(k);
  std::vector<std::thread> threads;
  for (std::size_t k = together.size(); k-- > 0;) threads.emplace_back([&, k] { together[k] = run(k); });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(alone, together);
  EXPECT_EQ(alone[0], alone[1]);
  EXPECT_NE(alone[0], alone[2]);
}

TEST(Lidar, PartsCastAsPosesComeInAreTheWholeScan) {
  const auto scene = made_scene(yard(Material::kGlass));
  LidarSpec five_hertz = at_rate(vlp16_spec(), 5.0), odd = vlp16_spec(), rosette = non_repeating();
  odd.columns = 1003;  // the last block is not full
  rosette.range_noise = 0.02;
  for (const LidarSpec& spec : {vlp16_spec(), five_hertz, odd, rosette}) {
    ScanJob job;
    job.number = 3;
    job.step = from_seconds(1.0 / spec.rate / 20.0);
    for (int k = 0; k <= 20; ++k) {
      const Eigen::Vector3d p(-2.0 + 0.05 * k, 1.0, 1.0 + 0.01 * k);
      job.T_enu_lidar.push_back(make_pose(rotation_from_rpy(0.01 * k, 0.02, 0.1 * k), p));
    }
    ScanJob known = job;
    sensor::Scan parts;
    std::size_t first = 0;
    for (const std::size_t poses : {1u, 2u, 3u, 9u, 10u, 20u, 21u}) {
      known.T_enu_lidar.assign(job.T_enu_lidar.begin(), job.T_enu_lidar.begin() + poses);
      const std::size_t end = poses == 21u ? firings(spec) : firings_ready(spec, known);
      EXPECT_GE(end, first);
      // All but the firings after the last pose and less than a block of 64 before it.
      EXPECT_GE(static_cast<double>(end) + 64.0,
                static_cast<double>(firings(spec)) * static_cast<double>(poses - 1) / 20.0);
      const auto points = cast_firings(*scene, spec, known, first, end);
      parts.points.insert(parts.points.end(), points.begin(), points.end());
      first = end;
    }
    const std::string whole = bytes_of(cast_scan(*scene, spec, job));
    EXPECT_GT(whole.size(), 10'000u);
    EXPECT_EQ(bytes_of(parts), whole) << spec.name;
  }
}

TEST(Lidar, BadJobsAndSpecsGiveEmptyScans) {
  const auto scene = made_scene(yard());
  ScanJob job = standing(above_ground(1.5));
  job.T_enu_lidar.pop_back();
  EXPECT_TRUE(cast_scan(*scene, exact(), job).points.empty());
  job.T_enu_lidar.push_back(job.T_enu_lidar[0]);
  job.T_enu_lidar[1].translation().x() = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(cast_scan(*scene, exact(), job).points.empty());
  LidarSpec spec = exact();
  spec.columns = -4;
  EXPECT_TRUE(cast_scan(*scene, spec, standing(above_ground(1.5))).points.empty());
  EXPECT_THAT(spec.validate().error().message, HasSubstr("columns"));
  spec = exact();
  spec.rate = std::nan("");
  EXPECT_THAT(spec.validate().error().message, HasSubstr("rate"));
}

TEST(Lidar, FixedFiringRateGivesMoreColumnsToASlowerScan) {
  EXPECT_EQ(at_rate(vlp16_spec(), 5.0).columns, 3600);
  EXPECT_EQ(at_rate(vlp16_spec(), 5.0).rate, 5.0);
  LidarSpec mode = vlp16_spec();
  mode.fixed_firing_rate = false;
  EXPECT_EQ(at_rate(mode, 5.0).columns, 1800);
}

}  // namespace
}  // namespace fleetmap::sim
