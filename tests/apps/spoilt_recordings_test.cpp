// One good recording, spoilt as drivers, cables and clocks spoil it: nothing ends in a wrong trajectory with
// exit code 0 and no sentence that names the cause.
#include "spoilt_recordings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "fleetmap/output/trajectory_file.hpp"
#include "fleetmap/recording/bag_writer.hpp"
#include "fleetmap/recording/reader.hpp"
#include "fleetmap/ros_codec/frame_transforms.hpp"
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

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Recorded;
using testing::Recording;
using testing::Spoilt;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kWorse = 2.0;  // times the error of the good recording
const std::vector<std::string> kMounted{"--set", "lidar.translation=[0,0,0.8]"};

struct Outcome {
  int exit_code = 0;
  std::string output;
  double error = 0.0;  ///< m, RMS: of the odometry after alignment, of the place as it is
};

class SpoiltRecording : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
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
      good_.push_back({std::move(**next), *(*reader)->recorded()});
    }
  }
  static void TearDownTestSuite() {
    good_.clear();
    folder_.reset();
  }

  static std::filesystem::path write(const std::string& name, const Recording& recording,
                                     const std::vector<sensor::FrameTransform>& frames = {}) {
    const std::filesystem::path bag = folder_->path() / name;
    auto writer = recording::BagWriter::create(bag);
    EXPECT_TRUE(writer) << writer.error().message;
    const std::array topics{ros_codec::topics::points(), ros_codec::topics::imu(), ros_codec::topics::fix(),
                            ros_codec::topics::wheel_odometry()};
    const bus::Topic tf = ros_codec::topics::tf_static();
    if (!frames.empty()) {
      EXPECT_TRUE(writer->write(tf.name, tf.type, recording.front().received, ros_codec::encode(frames)));
    }
    for (const Recorded& one : recording) {
      const Bytes cdr = one.cdr.empty()
                            ? std::visit([](const auto& s) { return ros_codec::encode(s); }, one.sample)
                            : one.cdr;
      const bus::Topic& topic = topics.at(one.sample.index());
      EXPECT_TRUE(writer->write(topic.name, topic.type, one.received, cdr));
    }
    EXPECT_TRUE(writer->close());
    return bag;
  }

  /// Infinite where fewer than half of the scans have a pose.
  static double error_of(const std::filesystem::path& tum, const Recording& recording, bool in_place) {
    const auto scans = std::ranges::count_if(
        recording, [](const Recorded& one) { return std::holds_alternative<sensor::Scan>(one.sample); });
    const auto poses = output::read_growing_tum(tum);
    if (!poses) return std::numeric_limits<double>::infinity();
    std::vector<Pose> estimate, truth;
    double squares = 0.0;
    for (const auto& pose : *poses) {
      const auto at = std::ranges::lower_bound(truth_.stamps, pose.stamp - std::chrono::milliseconds(50));
      if (at == truth_.stamps.end() || *at - pose.stamp > std::chrono::milliseconds(50)) continue;
      estimate.push_back(pose.T_w_base);
      truth.push_back(truth_.T_enu_base[static_cast<std::size_t>(at - truth_.stamps.begin())]);
      squares += (estimate.back().translation() - truth.back().translation()).squaredNorm();
    }
    if (estimate.size() < static_cast<std::size_t>(scans) / 2) return std::numeric_limits<double>::infinity();
    return in_place ? std::sqrt(squares / static_cast<double>(estimate.size()))
                    : testing::aligned_rmse(estimate, truth);
  }

  static Outcome odometry(const std::string& name, const Recording& recording,
                          const std::vector<std::string>& settings = kMounted,
                          const std::vector<sensor::FrameTransform>& frames = {}) {
    const std::filesystem::path bag = write(name, recording, frames), tum = folder_->path() / (name + ".tum");
    std::vector<std::string> command{testing::kProgram, "odometry", bag.string(), "--out", tum.string()};
    command.insert(command.end(), settings.begin(), settings.end());
    testing::Process process(command);
    const int exit_code = process.wait();
    std::filesystem::remove_all(bag);
    return {exit_code, process.output(), error_of(tum, recording, false)};
  }

  static Outcome run(const std::string& name, const Recording& recording) {
    const std::filesystem::path bag = write(name, recording), out = folder_->path() / (name + "_out");
    std::vector<std::string> command{
        testing::kProgram, "run",        "--recording", "r1=" + bag.string(),
        "--out",           out.string(), "--set",       "site.origin=[48.2,11.6,500]"};
    command.insert(command.end(), kMounted.begin(), kMounted.end());
    testing::Process process(command);
    const int exit_code = process.wait();
    std::filesystem::remove_all(bag);
    return {exit_code, process.output(), error_of(out / "r1/trajectory.tum", recording, true)};
  }

  static inline std::unique_ptr<testing::TemporaryFolder> folder_;
  static inline testing::GeneratedRobot truth_;
  static inline Recording good_;
};

TEST_F(SpoiltRecording, IsAsGoodOrTheCauseIsNamed) {
  const Outcome good_odometry = odometry("good", good_), good_place = run("good", good_);
  for (const Outcome& good : {good_odometry, good_place}) {
    ASSERT_EQ(good.exit_code, 0) << good.output;
    EXPECT_THAT(good.output, Not(HasSubstr(" warning ")));
  }
  ASSERT_LT(good_odometry.error, 0.1);
  ASSERT_LT(good_place.error, 4.0);
  for (const Spoilt& spoilt : testing::spoilt_recordings()) {
    SCOPED_TRACE(spoilt.name);
    Recording recording = good_;
    spoilt.spoil(recording);
    const Outcome outcome = spoilt.in_place ? run(spoilt.name, recording) : odometry(spoilt.name, recording);
    const double worse = outcome.error / (spoilt.in_place ? good_place : good_odometry).error;
    std::cout << std::left << std::setw(34) << spoilt.name << std::setprecision(3) << "exit "
              << outcome.exit_code << ", error x " << std::setw(6) << worse << ' ' << spoilt.named << '\n';
    if (!spoilt.named.empty()) {
      EXPECT_THAT(outcome.output, HasSubstr(spoilt.named));
    } else if (outcome.exit_code == 0) {
      EXPECT_LE(worse, kWorse) << outcome.output;
    }
  }
}

TEST_F(SpoiltRecording, FindingsAreInTheReport) {
  Recording flat = good_;
  testing::each<sensor::Fix>(
      [](sensor::Fix& fix) { fix.position.altitude = std::numeric_limits<double>::quiet_NaN(); })(flat);
  run("flat", flat);
  std::ifstream file(folder_->path() / "flat_out/report.json");
  const auto report = nlohmann::json::parse(file);
  const auto findings = report["agents"]["r1"]["sensors"]["findings"];
  ASSERT_EQ(findings.size(), 1u) << findings;
  EXPECT_THAT(findings[0].get<std::string>(), HasSubstr("fixes have no altitude"));
}

TEST_F(SpoiltRecording, AMirroredLidarIsInTheReportOfARun) {
  Recording mirrored = good_;
  testing::each<sensor::Scan>([](sensor::Scan& scan) {
    for (sensor::ScanPoint& point : scan.points) point.position.y() *= -1.0f;
  })(mirrored);
  EXPECT_THAT(run("mirrored", mirrored).output, HasSubstr("its points are mirrored"));
  std::ifstream file(folder_->path() / "mirrored_out/report.json");
  const auto report = nlohmann::json::parse(file);
  EXPECT_THAT(report["agents"]["r1"]["sensors"]["findings"].dump(), HasSubstr("its points are mirrored"));
}

TEST_F(SpoiltRecording, InspectNamesTheCauseAndFails) {
  Recording swift = good_;
  testing::each<sensor::Wheel>([](sensor::Wheel& wheel) { wheel.forward_speed *= 3.6; })(swift);
  std::vector<std::string> command{testing::kProgram, "inspect", write("swift", swift).string()};
  command.insert(command.end(), kMounted.begin(), kMounted.end());
  testing::Process inspect(command);
  EXPECT_EQ(inspect.wait(), 1);
  EXPECT_THAT(inspect.output(), HasSubstr("km/h"));
}

/// A LiDAR that is pitched, on a mast, as /tf_static says.
TEST_F(SpoiltRecording, AMountInTheFramesIsUsed) {
  const Eigen::Quaterniond pitched(rotation_from_rpy(0.0, 20.0 * kDegree, 0.0));
  const std::vector<sensor::FrameTransform> frames{{"base_link", "mast", {0.0, 0.0, 0.5}},
                                                   {"mast", "velodyne", {0.0, 0.0, 0.3}, pitched},
                                                   {"base_link", "imu"},
                                                   {"base_link", "gps"}};
  Recording recording = good_;
  for (Recorded& one : recording) {
    auto* scan = std::get_if<sensor::Scan>(&one.sample);
    if (scan == nullptr) continue;
    const Eigen::Matrix3f R = pitched.inverse().toRotationMatrix().cast<float>();
    for (auto& point : scan->points) point.position = R * point.position;
    one.cdr = ros_codec::encode(*scan, "velodyne");
  }
  const Outcome good = odometry("level", good_);
  const Outcome by_frames = odometry("by_frames", recording, {}, frames);
  EXPECT_EQ(by_frames.exit_code, 0) << by_frames.output;
  EXPECT_THAT(by_frames.output,
              AllOf(HasSubstr("[0.000, 0.000, 0.800] m, [0.0, 20.0, 0.0] deg in base_link, by /tf"),
                    Not(HasSubstr("tilted"))));
  EXPECT_LE(by_frames.error, good.error + 0.005);
  // A configuration that contradicts is used, and both are named.
  const Outcome contradicted = odometry("contradicted", recording, kMounted, frames);
  EXPECT_THAT(contradicted.output,
              AllOf(HasSubstr("0.000 m and 20.0 deg apart"), HasSubstr("the ground is tilted")));
  EXPECT_GT(contradicted.error, 10.0 * good.error);
  testing::Process inspect({testing::kProgram, "inspect", write("framed", recording, frames).string()});
  EXPECT_EQ(inspect.wait(), 0) << inspect.output();
  EXPECT_THAT(inspect.output(), HasSubstr("by /tf_static"));
}

TEST_F(SpoiltRecording, OfTwoOdometriesNoneIsChosenInSilence) {
  const std::filesystem::path bag = folder_->path() / "two";
  auto writer = recording::BagWriter::create(bag).value();
  for (const Recorded& one : good_) {
    if (const auto* scan = std::get_if<sensor::Scan>(&one.sample)) {
      const bus::Topic topic = ros_codec::topics::points();
      ASSERT_TRUE(writer.write(topic.name, topic.type, one.received, ros_codec::encode(*scan)));
    } else if (const auto* wheel = std::get_if<sensor::Wheel>(&one.sample)) {
      const bus::Topic topic = ros_codec::topics::wheel_odometry();
      for (const char* name : {"rt/odom", "rt/odometry/filtered"})
        ASSERT_TRUE(writer.write(name, topic.type, one.received, ros_codec::encode(*wheel)));
    }
  }
  ASSERT_TRUE(writer.close());
  testing::Process odometry(
      {testing::kProgram, "odometry", bag.string(), "--out", (folder_->path() / "two.tum").string()});
  EXPECT_EQ(odometry.wait(), 1);
  EXPECT_THAT(odometry.output(), AllOf(HasSubstr("/odom "), HasSubstr("recording.topics.wheel")));
}

}  // namespace
}  // namespace fleetmap
