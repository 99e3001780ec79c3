// One good recording, spoilt as drivers, cables and clocks spoil it: nothing ends in a wrong trajectory with
// exit code 0 and no sentence that names the cause.
#include <gmock/gmock.h>

#include <fstream>
#include <iomanip>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "fleetmap/geometry/degree.hpp"
#include "fleetmap/output/trajectory_file.hpp"
#include "fleetmap/recording/bag_writer.hpp"
#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "fleetmap/ros_codec/samples.hpp"
#include "fleetmap/ros_codec/topics.hpp"
#include "generated_drive.hpp"
#include "support/command_line.hpp"
#include "support/process.hpp"

namespace fleetmap {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Recorded;
using testing::Recording;
using testing::Spoilt;

constexpr double kWorse = 2.0;  // times the error of the good recording
const std::vector<std::string>& kMounted = testing::kGeneratedMount;

using SpoiltRecording = testing::GeneratedDrive;

std::vector<std::string> inspection_of(const std::filesystem::path& bag) {
  std::vector<std::string> command{testing::kProgram, "inspect", bag.string()};
  command.insert(command.end(), kMounted.begin(), kMounted.end());
  return command;
}

/// The findings of `inspect` hold the cause that the odometry or the run names, else there is none.
void expect_inspected(const Spoilt& spoilt, testing::Process& inspect) {
  const int exit_code = inspect.wait();
  std::istringstream lines(inspect.output());
  std::string findings;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("- ")) findings.append(line).append("\n");
  }
  EXPECT_EQ(exit_code, spoilt.named.empty() ? 0 : 1) << inspect.output();
  EXPECT_EQ(findings.empty(), spoilt.named.empty()) << inspect.output();
  EXPECT_THAT(findings, HasSubstr(spoilt.named)) << inspect.output();
}

TEST_F(SpoiltRecording, IsAsGoodOrTheCauseIsNamed) {
  const Outcome good_odometry = odometry("good", good_), good_place = run("good", good_);
  for (const Outcome& good : {good_odometry, good_place}) {
    ASSERT_EQ(good.exit_code, 0) << good.output;
    EXPECT_THAT(good.output, Not(HasSubstr(" warning ")));
  }
  ASSERT_LT(good_odometry.shape, 0.1);
  ASSERT_LT(good_place.place, 4.0);
  for (const Spoilt& spoilt : testing::spoilt_recordings()) {
    SCOPED_TRACE(spoilt.name);
    Recording recording = good_;
    spoilt.spoil(recording);
    const std::filesystem::path bag = write(spoilt.name + "_inspected", recording);
    testing::Process inspect(inspection_of(bag));  // beside the other process
    const Outcome outcome = spoilt.in_place ? run(spoilt.name, recording) : odometry(spoilt.name, recording);
    const double worse =
        spoilt.in_place ? outcome.place / good_place.place : outcome.shape / good_odometry.shape;
    std::cout << std::left << std::setw(34) << spoilt.name << std::setprecision(3) << "exit "
              << outcome.exit_code << ", error x " << std::setw(6) << worse << ' ' << spoilt.named << '\n';
    if (!spoilt.named.empty()) {
      EXPECT_THAT(outcome.output, HasSubstr(spoilt.named));
    }
    const bool converted = outcome.output.find("converted") != std::string::npos;
    if (spoilt.corrected || converted || (spoilt.named.empty() && outcome.exit_code == 0)) {
      EXPECT_LE(worse, kWorse) << outcome.output;
    }
    expect_inspected(spoilt, inspect);
    std::filesystem::remove_all(bag);
  }
}

/// The reader, the survey and the search for the first fix open the file.
TEST_F(SpoiltRecording, AFileThatWasCutIsReadToItsEndWhichIsNamedOnceAndFails) {
  const std::filesystem::path bag = write("cut", good_), tum = folder_->path() / "cut.tum";
  for (const auto& entry : std::filesystem::directory_iterator(bag)) {
    if (entry.path().extension() == ".mcap")
      std::filesystem::resize_file(entry.path(), entry.file_size() * 3 / 4);
  }
  const std::filesystem::path out = folder_->path() / "cut_out";
  testing::Process odometry({testing::kProgram, "odometry", bag.string(), "--out", tum.string()});
  testing::Process run(
      {testing::kProgram, "run", "--recording", "r1=" + bag.string(), "--out", out.string()});
  for (testing::Process* process : {&odometry, &run}) {
    EXPECT_EQ(process->wait(), 1) << process->output();
    EXPECT_THAT(process->output(), HasSubstr("1 part of the recording is damaged or cut off"));
    const std::string output = process->output(), news = "its end is missing";
    const auto first = output.find(news);
    EXPECT_NE(first, std::string::npos) << output;
    EXPECT_EQ(output.find(news, first + 1), std::string::npos) << output;
  }
  EXPECT_GT(output::read_growing_tum(tum).value().size(), good_.size() / 30);
  EXPECT_TRUE(std::filesystem::exists(out / "r1/map.ply"));
  EXPECT_TRUE(std::filesystem::exists(out / "report.json"));
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

/// The first check of the stamps is over long before.
TEST_F(SpoiltRecording, AnImuThatIsLateFromAMomentOnIsNamed) {
  ASSERT_TRUE(testing::write_winding_drive(folder_->path() / "winding"));
  Recording winding;
  read_recording(folder_->path() / "winding/r1", winding);
  EXPECT_THAT(odometry("sound", winding).output, Not(HasSubstr(" warning ")));
  const Stamp start = winding.front().received;
  for (Recorded& one : winding) {
    auto* imu = std::get_if<sensor::Imu>(&one.sample);
    if (imu != nullptr && to_seconds(one.received - start) > 24.0)
      imu->stamp -= std::chrono::milliseconds(250);
  }
  EXPECT_THAT(odometry("late", winding).output,
              AllOf(HasSubstr("the gyro turns"), HasSubstr("stamps, since")));
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
  EXPECT_LE(by_frames.shape, good.shape + 0.005);
  // A configuration that contradicts is used, and both are named.
  const Outcome contradicted = odometry("contradicted", recording, kMounted, frames);
  EXPECT_THAT(contradicted.output,
              AllOf(HasSubstr("0.000 m and 20.0 deg apart"), HasSubstr("the ground is tilted")));
  EXPECT_GT(contradicted.shape, 10.0 * good.shape);
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
