#include "generated_drive.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fleetmap/output/trajectory_file.hpp"
#include "fleetmap/recording/bag_writer.hpp"
#include "fleetmap/recording/reader.hpp"
#include "fleetmap/ros_codec/frame_transforms.hpp"
#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "fleetmap/ros_codec/samples.hpp"
#include "fleetmap/ros_codec/topics.hpp"
#include "odometry/trajectory_error.hpp"
#include "support/command_line.hpp"
#include "support/process.hpp"

namespace fleetmap::testing {
namespace {

constexpr Duration kSameScan = std::chrono::milliseconds(50);
constexpr double kNone = std::numeric_limits<double>::infinity();

/// RMS errors of the poses in `tum`: after alignment, and as they are.
std::pair<double, double> errors_of(const std::filesystem::path& tum, const Recording& recording,
                                    const GeneratedRobot& robot) {
  const auto scans = std::ranges::count_if(
      recording, [](const Recorded& one) { return std::holds_alternative<sensor::Scan>(one.sample); });
  const auto poses = output::read_growing_tum(tum);
  if (!poses) return {kNone, kNone};
  std::vector<Pose> estimate, truth;
  double squares = 0.0;
  for (const auto& pose : *poses) {
    const auto at = std::ranges::lower_bound(robot.stamps, pose.stamp - kSameScan);
    if (at == robot.stamps.end() || *at - pose.stamp > kSameScan) continue;
    estimate.push_back(pose.T_w_base);
    truth.push_back(robot.T_enu_base[static_cast<std::size_t>(at - robot.stamps.begin())]);
    squares += (estimate.back().translation() - truth.back().translation()).squaredNorm();
  }
  if (estimate.size() < static_cast<std::size_t>(scans) / 2) return {kNone, kNone};
  return {aligned_rmse(estimate, truth), std::sqrt(squares / static_cast<double>(estimate.size()))};
}

}  // namespace

void GeneratedDrive::SetUpTestSuite() {
  folder_ = std::make_unique<TemporaryFolder>();
  auto fleet = write_generated_fleet(folder_->path() / "bags");
  ASSERT_TRUE(fleet) << fleet.error().message;
  fleet_ = std::move(*fleet);
  read_recording(folder_->path() / "bags/r1", good_);
}

void GeneratedDrive::read_recording(const std::filesystem::path& bag, Recording& recording) {
  auto reader = recording::open(bag);
  ASSERT_TRUE(reader) << reader.error().message;
  for (;;) {
    auto next = (*reader)->next();
    ASSERT_TRUE(next) << next.error().message;
    if (!*next) break;
    recording.push_back({std::move(**next), *(*reader)->recorded()});
  }
}

void GeneratedDrive::TearDownTestSuite() {
  good_.clear();
  folder_.reset();
}

std::filesystem::path GeneratedDrive::write(const std::string& name, const Recording& recording,
                                            const std::vector<sensor::FrameTransform>& frames) {
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
    EXPECT_TRUE(writer->write(one.topic.empty() ? topic.name : one.topic, topic.type, one.received, cdr));
  }
  EXPECT_TRUE(writer->close());
  return bag;
}

GeneratedDrive::Outcome GeneratedDrive::odometry(const std::string& name, const Recording& recording,
                                                 const std::vector<std::string>& settings,
                                                 const std::vector<sensor::FrameTransform>& frames) {
  const std::filesystem::path bag = write(name, recording, frames), tum = folder_->path() / (name + ".tum");
  std::vector<std::string> command{kProgram, "odometry", bag.string(), "--out", tum.string()};
  command.insert(command.end(), settings.begin(), settings.end());
  Process process(command);
  const int exit_code = process.wait();
  std::filesystem::remove_all(bag);
  const auto [shape, place] = errors_of(tum, recording, fleet_.robots[0]);
  return {exit_code, process.output(), shape, place};
}

GeneratedDrive::Outcome GeneratedDrive::run(const std::string& name, const Recording& recording,
                                            const std::vector<std::string>& settings) {
  const std::filesystem::path bag = write(name, recording), out = folder_->path() / (name + "_out");
  std::vector<std::string> command{kProgram, "run",        "--recording", "r1=" + bag.string(),
                                   "--out",  out.string(), "--set",       "site.origin=[48.2,11.6,500]"};
  command.insert(command.end(), settings.begin(), settings.end());
  Process process(command);
  const int exit_code = process.wait();
  std::filesystem::remove_all(bag);
  const auto [shape, place] = errors_of(out / "r1/trajectory.tum", recording, fleet_.robots[0]);
  return {exit_code, process.output(), shape, place};
}

}  // namespace fleetmap::testing
