#include "odometry/kitti_files.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>

#include "odometry/xz_file.hpp"

namespace fleetmap::testing {
namespace {

namespace fs = std::filesystem;

/// Values of the OXTS records by frame.
std::vector<std::vector<double>> read_oxts(const fs::path& drive) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(drive / "oxts/data")) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<std::vector<double>> records;
  for (const fs::path& file : files) {
    std::ifstream in(file);
    records.emplace_back(std::istream_iterator<double>(in), std::istream_iterator<double>());
  }
  return records;
}

}  // namespace

std::vector<fs::path> kitti_frames(const fs::path& drive) {
  std::vector<fs::path> frames;
  for (const auto& entry : fs::recursive_directory_iterator(drive / "velodyne_points")) {
    if (entry.path().extension() == ".xz") frames.push_back(entry.path());
  }
  std::sort(frames.begin(), frames.end());
  return frames;
}

std::optional<sensor::Scan> read_kitti_scan(const fs::path& file, int frame) {
  const std::vector<std::uint8_t> data = read_xz(file);
  const std::string marker = "DATA binary\n";
  const auto header = std::search(data.begin(), data.end(), marker.begin(), marker.end());
  if (header == data.end()) return std::nullopt;
  const auto offset = static_cast<std::size_t>(header - data.begin()) + marker.size();
  const std::size_t count = (data.size() - offset) / (4 * sizeof(float));
  if (count < 2) return std::nullopt;
  sensor::Scan scan;
  scan.stamp = stamp_from_ns(std::int64_t{100'000'000} * frame);
  scan.points.resize(count - 1);
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    float v[4];
    std::memcpy(v, data.data() + offset + i * sizeof(v), sizeof(v));
    scan.points[i].position = {v[0], v[1], v[2]};
    scan.points[i].intensity = v[3];
  }
  return scan;
}

std::vector<sensor::Imu> read_kitti_gyro(const fs::path& drive) {
  Eigen::Matrix3d R_velo_imu;  // of the drive's calib_imu_to_velo.txt
  R_velo_imu << 9.999976e-01, 7.553071e-04, -2.035826e-03, -7.854027e-04, 9.998898e-01, -1.482298e-02,
      2.024406e-03, 1.482454e-02, 9.998881e-01;
  std::vector<sensor::Imu> samples;
  for (const auto& record : read_oxts(drive)) {
    sensor::Imu imu;
    imu.stamp = stamp_from_ns(std::int64_t{100'000'000} * static_cast<std::int64_t>(samples.size()));
    imu.angular_velocity = R_velo_imu * Eigen::Vector3d(record.at(17), record.at(18), record.at(19));
    samples.push_back(imu);
  }
  return samples;
}

std::vector<sensor::Wheel> read_kitti_speed(const fs::path& drive) {
  std::vector<sensor::Wheel> samples;
  for (const auto& record : read_oxts(drive)) {
    sensor::Wheel wheel;
    wheel.stamp = stamp_from_ns(std::int64_t{100'000'000} * static_cast<std::int64_t>(samples.size()));
    wheel.forward_speed = record.at(8);
    samples.push_back(wheel);
  }
  return samples;
}

std::map<int, Pose> read_tum_by_frame(const fs::path& file) {
  std::map<int, Pose> poses;
  std::ifstream in(file);
  double stamp, x, y, z, qx, qy, qz, qw;
  while (in >> stamp >> x >> y >> z >> qx >> qy >> qz >> qw) {
    poses[static_cast<int>(std::lround(stamp / 0.1))] =
        make_pose(Eigen::Quaterniond(qw, qx, qy, qz), Eigen::Vector3d(x, y, z));
  }
  return poses;
}

}  // namespace fleetmap::testing
