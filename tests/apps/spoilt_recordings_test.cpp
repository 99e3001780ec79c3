// One good recording, spoilt as drivers spoil it: what cannot be corrected is named, and nothing ends in a
// wrong trajectory with exit code 0 and no word.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <functional>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "fleetmap/output/trajectory_file.hpp"
#include "fleetmap/recording/bag_writer.hpp"
#include "fleetmap/recording/reader.hpp"
#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "fleetmap/ros_codec/samples.hpp"
#include "fleetmap/ros_codec/topics.hpp"
#include "odometry/trajectory_error.hpp"
#include "support/command_line.hpp"
#include "support/generated_fleet.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap {
namespace {

using recording::Sample;
using ::testing::HasSubstr;

constexpr double kG = 9.80665, kDegree = std::numbers::pi / 180.0;

struct Spoilt {
  const char* name;
  std::function<void(Sample&)> spoil;
  const char* named;      ///< what is said
  bool corrected = true;  ///< and the trajectory is as good as that of the sound recording
};

template <class T>
std::function<void(Sample&)> each(std::function<void(T&)> change) {
  return [change](Sample& sample) {
    if (auto* of_kind = std::get_if<T>(&sample)) change(*of_kind);
  };
}

/// Odometry whose pose is filled, and whose twist is not.
std::function<void(Sample&)> pose_instead_of_twist() {
  auto T = std::make_shared<Pose>(Pose::Identity());
  auto last = std::make_shared<std::optional<sensor::Wheel>>();
  return each<sensor::Wheel>([T, last](sensor::Wheel& wheel) {
    if (*last) {
      const double dt = to_seconds(wheel.stamp - (*last)->stamp);
      const double turn = (*last)->yaw_rate.value_or(0.0) * dt;
      *T = *T * make_pose(rotation_from_rpy(0.0, 0.0, turn),
                          Eigen::Vector3d((*last)->forward_speed * dt, 0.0, 0.0));
    }
    *last = wheel;
    wheel = {wheel.stamp, 0.0, 0.0, *T};
  });
}

const std::vector<Spoilt>& spoilt() {
  static const std::vector<Spoilt> all{
      {"good", [](Sample&) {}, ""},
      {"acceleration_in_g", each<sensor::Imu>([](auto& imu) { imu.specific_force /= kG; }), "its unit is g "},
      {"acceleration_in_milli_g", each<sensor::Imu>([](auto& imu) { imu.specific_force *= 1e3 / kG; }),
       "its unit is milli-g "},
      {"acceleration_without_gravity", each<sensor::Imu>([](auto& imu) { imu.specific_force.setZero(); }),
       "the acceleration is 0"},
      {"gyro_in_degrees", each<sensor::Imu>([](auto& imu) { imu.angular_velocity /= kDegree; }), "deg/s",
       false},
      {"lidar_pitched", each<sensor::Scan>([](auto& scan) {
         const Eigen::Matrix3f R = rotation_from_rpy(0.0, 20.0 * kDegree, 0.0).template cast<float>();
         for (auto& point : scan.points) point.position = R * point.position;
       }),
       "the ground is tilted by", false},
      {"pose_instead_of_twist", pose_instead_of_twist(), "its pose moves while its twist is zero"},
  };
  return all;
}

class SpoiltRecording : public ::testing::Test {
 protected:
  void SetUp() override {
    if (folder_) return;
    folder_ = std::make_unique<testing::TemporaryFolder>();
    auto fleet = testing::write_generated_fleet(folder_->path() / "bags");
    ASSERT_TRUE(fleet) << fleet.error().message;
    truth_ = fleet->robots[0];
    auto reader = recording::open(folder_->path() / "bags/r1");
    ASSERT_TRUE(reader) << reader.error().message;
    for (;;) {
      auto next = (*reader)->next();
      ASSERT_TRUE(next) << next.error().message;
      if (!*next) break;
      samples_.push_back(std::move(**next));
    }
  }
  static void TearDownTestSuite() {
    samples_.clear();
    folder_.reset();
  }

  static std::filesystem::path write(const Spoilt& spoilt) {
    const std::filesystem::path bag = folder_->path() / spoilt.name;
    auto writer = recording::BagWriter::create(bag);
    EXPECT_TRUE(writer) << writer.error().message;
    const std::array topics{ros_codec::topics::points(), ros_codec::topics::imu(), ros_codec::topics::fix(),
                            ros_codec::topics::wheel_odometry()};
    for (Sample sample : samples_) {
      spoilt.spoil(sample);
      const Bytes cdr = std::visit([](const auto& s) { return ros_codec::encode(s); }, sample);
      const bus::Topic& topic = topics.at(sample.index());
      EXPECT_TRUE(writer->write(topic.name, topic.type, recording::stamp_of(sample), cdr));
    }
    EXPECT_TRUE(writer->close());
    return bag;
  }

  static inline std::unique_ptr<testing::TemporaryFolder> folder_;
  static inline testing::GeneratedRobot truth_;
  static inline std::vector<Sample> samples_;
};

TEST_F(SpoiltRecording, IsCorrectedOrNamed) {
  double good = 0.0;
  for (const Spoilt& spoilt : spoilt()) {
    SCOPED_TRACE(spoilt.name);
    const std::filesystem::path tum = folder_->path() / (std::string(spoilt.name) + ".tum");
    const std::filesystem::path bag = write(spoilt);
    testing::Process inspect({testing::kProgram, "inspect", bag.string()});
    EXPECT_EQ(inspect.wait(), *spoilt.named == '\0' ? 0 : 1) << inspect.output();
    EXPECT_THAT(inspect.output(), HasSubstr(spoilt.named));
    testing::Process odometry({testing::kProgram, "odometry", bag.string(), "--out", tum.string(), "--set",
                               "lidar.translation=[0,0,0.8]"});
    const int exit_code = odometry.wait();
    EXPECT_THAT(odometry.output(), HasSubstr(spoilt.named));
    ASSERT_EQ(exit_code, 0) << odometry.output();
    const auto poses = output::read_growing_tum(tum);
    ASSERT_TRUE(poses) << poses.error().message;
    std::vector<Pose> estimate;
    for (const auto& pose : *poses) estimate.push_back(pose.T_w_base);
    ASSERT_EQ(estimate.size(), truth_.T_enu_base.size());
    const double error = testing::aligned_rmse(estimate, truth_.T_enu_base);
    if (good == 0.0) good = error;
    if (spoilt.corrected) {
      EXPECT_LE(error, 2.0 * good);
    }
  }
}

TEST_F(SpoiltRecording, FixesWithoutAltitudeAreNamedInLogAndReport) {
  const Spoilt flat{"fixes_without_altitude", each<sensor::Fix>([](auto& fix) {
                      fix.position.altitude = std::numeric_limits<double>::quiet_NaN();
                    }),
                    "fixes have no altitude"};
  const std::filesystem::path out = folder_->path() / "out";
  testing::Process run({testing::kProgram, "run", "--recording", "r1=" + write(flat).string(), "--out",
                        out.string(), "--set", "lidar.translation=[0,0,0.8]"});
  run.wait();
  EXPECT_THAT(run.output(), HasSubstr(flat.named));
  std::ifstream file(out / "report.json");
  const auto report = nlohmann::json::parse(file);
  const auto findings = report["agents"]["r1"]["sensors"]["findings"];
  ASSERT_EQ(findings.size(), 1u) << findings;
  EXPECT_THAT(findings[0].get<std::string>(), HasSubstr(flat.named));
}

}  // namespace
}  // namespace fleetmap
