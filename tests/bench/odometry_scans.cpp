// Writes the scans of a recording, or of a drive through the twin, for odometries that are not built here
// (tests/bench/peers): OUT/scans.bin, OUT/imu.txt; of the twin also OUT/truth.tum and the rosbag2 OUT/bag.
//   bench_odometry_scans RECORDING|WORLD:SEED OUT [--model NAME] [--length M]
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <numbers>
#include <string>

#include "bench/twin_drive.hpp"
#include "fleetmap/config/sensor_file.hpp"
#include "fleetmap/config/world_file.hpp"
#include "fleetmap/odometry/lidar_model.hpp"
#include "fleetmap/output/trajectory_file.hpp"
#include "fleetmap/recording/bag_writer.hpp"
#include "fleetmap/recording/reader.hpp"
#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "fleetmap/ros_codec/samples.hpp"
#include "fleetmap/ros_codec/topics.hpp"

namespace {

using namespace fleetmap;
namespace fs = std::filesystem;

struct Options {
  std::string source;
  fs::path out;
  std::string model = "vlp16";
  double length = 150.0;
};

/// Times by azimuth for scans without them, as the odometry assigns them.
void add_times(sensor::Scan& scan, const odometry::LidarModel& model) {
  const double start = model.sweep_start_azimuth.value_or(0.0);
  for (sensor::ScanPoint& p : scan.points) {
    const double turned = (model.clockwise ? start - std::atan2(p.position.y(), p.position.x())
                                           : std::atan2(p.position.y(), p.position.x()) - start) /
                          (2.0 * std::numbers::pi);
    p.time = static_cast<float>((turned - std::floor(turned)) * model.scan_period);
  }
  scan.stamp -= from_seconds(model.stamp_phase * model.scan_period);
}

/// scans.bin: of each scan the start of its sweep (int64, ns), the number of its points (uint32), and of each
/// point x, y, z in the LiDAR frame and the s since the start (float32). imu.txt: ns, gyro, specific force.
class Files {
 public:
  Files(const fs::path& folder, odometry::LidarModel model)
      : model_(std::move(model)), scans_(folder / "scans.bin", std::ios::binary), imu_(folder / "imu.txt") {
    imu_ << std::setprecision(12);
  }
  bool good() const { return scans_.good() && imu_.good(); }
  void add(sensor::Scan scan) {
    if (!scan.has_time) add_times(scan, model_);
    put(scan.stamp.time_since_epoch().count());
    put(static_cast<std::uint32_t>(scan.points.size()));
    for (const sensor::ScanPoint& p : scan.points) {
      for (const float value : {p.position.x(), p.position.y(), p.position.z(), p.time}) put(value);
    }
  }
  void add(const sensor::Imu& imu) {
    const Eigen::Vector3d &w = imu.angular_velocity, &a = imu.specific_force;
    imu_ << imu.stamp.time_since_epoch().count() << ' ' << w.x() << ' ' << w.y() << ' ' << w.z() << ' '
         << a.x() << ' ' << a.y() << ' ' << a.z() << '\n';
  }

 private:
  template <typename T>
  void put(T value) {
    scans_.write(reinterpret_cast<const char*>(&value), sizeof value);
  }
  odometry::LidarModel model_;
  std::ofstream scans_, imu_;
};

Status export_recording(const fs::path& recording, Files& files) {
  auto reader = recording::open(recording);
  if (!reader) return tl::unexpected(reader.error());
  while (true) {
    auto sample = (*reader)->next();
    if (!sample) return tl::unexpected(sample.error());
    if (!*sample) return {};
    if (auto* scan = std::get_if<sensor::Scan>(&**sample)) files.add(std::move(*scan));
    if (const auto* imu = std::get_if<sensor::Imu>(&**sample)) files.add(*imu);
  }
}

/// Samples of a drive into a bag, in the order in which they became due.
class Bag {
 public:
  explicit Bag(recording::BagWriter writer) : writer_(std::move(writer)) {}
  template <typename Sample>
  void add(const bus::Topic& topic, const Sample& sample, Stamp due) {
    last_ = std::max(last_, due);
    if (status_) status_ = writer_.write(topic.name, topic.type, last_, ros_codec::encode(sample));
  }
  Status close() { return status_ ? writer_.close() : status_; }

 private:
  recording::BagWriter writer_;
  Stamp last_{};
  Status status_;
};

Status export_drive(const Options& options, Files& files) {
  const fs::path config = fs::path(FLEETMAP_SOURCE_DIR) / "config";
  const auto colon = options.source.find(':');
  const std::uint64_t seed = std::stoull(options.source.substr(colon + 1));
  const auto world =
      config::make_world(config / "worlds" / (options.source.substr(0, colon) + ".yaml"), seed);
  if (!world) return tl::unexpected(world.error());
  const auto lidar = config::load_lidar_spec(config / "sensors" / (options.model + ".yaml"));
  if (!lidar) return tl::unexpected(lidar.error());
  auto writer = recording::BagWriter::create(options.out / "bag");
  if (!writer) return tl::unexpected(writer.error());
  Bag bag(std::move(*writer));
  std::vector<output::StampedPose> truth;

  const auto scene = sim::Scene::create((*world)->mesh());
  testing::TwinDrive twin(*world, *scene, testing::drive_robot(*lidar, seed), testing::first_lane_of(seed),
                          options.length);
  testing::TwinDrive::Listener listener;
  listener.imu = [&](const sensor::Imu& imu) {
    files.add(imu);
    bag.add(ros_codec::topics::imu(), imu, imu.stamp);
  };
  listener.wheel = [&](const sensor::Wheel& wheel) {
    bag.add(ros_codec::topics::wheel_odometry(), wheel, wheel.stamp);
  };
  listener.scan = [&](const sensor::Scan& scan, const Pose& T_enu_base) {
    truth.push_back({scan.stamp, T_enu_base});
    bag.add(ros_codec::topics::points(), scan, sensor::end_of(scan));
    files.add(scan);
  };
  if (!twin.run(listener)) return failure(options.source + ": the robot got stuck");
  if (const Status closed = bag.close(); !closed) return closed;
  return output::write_tum(options.out / "truth.tum", truth);
}

Status run(const Options& options) {
  const auto model = odometry::lidar_model(options.model);
  if (!model) return tl::unexpected(model.error());
  fs::create_directories(options.out);
  Files files(options.out, *model);
  const Status done =
      fs::exists(options.source) ? export_recording(options.source, files) : export_drive(options, files);
  if (!done) return done;
  return files.good() ? Status{} : failure(options.out.string() + ": cannot be written");
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  std::vector<std::string> names;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--model") == 0 && i + 1 < argc) {
      options.model = argv[++i];
    } else if (std::strcmp(argv[i], "--length") == 0 && i + 1 < argc) {
      options.length = std::stod(argv[++i]);
    } else {
      names.emplace_back(argv[i]);
    }
  }
  if (names.size() != 2) {
    std::cerr << "usage: bench_odometry_scans RECORDING|WORLD:SEED OUT [--model NAME] [--length M]\n";
    return 2;
  }
  options.source = names[0];
  options.out = names[1];
  const Status done = run(options);
  if (!done) std::cerr << done.error().message << '\n';
  return done ? 0 : 1;
}
