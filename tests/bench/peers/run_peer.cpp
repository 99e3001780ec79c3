// Runs one public odometry over scans of bench_odometry_scans, in one thread; prints CPU and peak memory.
//   peer_NAME FOLDER OUT.tum [lidar=X,Y,Z,ROLL,PITCH,YAW] [imu_mount=...] [SETTING=VALUE ...]   (m, rad)
#include <sys/resource.h>
#include <tbb/global_control.h>

#include <cstdio>
#include <ctime>
#include <fstream>
#include <iostream>
#include <optional>
#include <sstream>

#include "peer.hpp"

namespace fleetmap::peers {
namespace {

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::optional<PeerScan> next_scan(std::ifstream& file) {
  PeerScan scan;
  std::uint32_t count = 0;
  file.read(reinterpret_cast<char*>(&scan.start), sizeof scan.start);
  if (!file.read(reinterpret_cast<char*>(&count), sizeof count)) return std::nullopt;
  std::vector<float> values(4 * std::size_t{count});
  file.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(4 * values.size()));
  scan.points.reserve(count);
  scan.times.reserve(count);
  for (std::size_t i = 0; i < values.size(); i += 4) {
    scan.points.emplace_back(values[i], values[i + 1], values[i + 2]);
    scan.times.push_back(values[i + 3]);
  }
  return scan;
}

std::vector<PeerImu> read_imu(const std::string& name) {
  std::ifstream file(name);
  std::vector<PeerImu> samples;
  PeerImu s;
  while (file >> s.stamp >> s.angular_velocity.x() >> s.angular_velocity.y() >> s.angular_velocity.z() >>
         s.specific_force.x() >> s.specific_force.y() >> s.specific_force.z()) {
    samples.push_back(s);
  }
  return samples;
}

Eigen::Isometry3d mount(const std::string& text) {
  std::stringstream list(text);
  std::array<double, 6> v{};
  std::string part;
  for (double& value : v) {
    if (std::getline(list, part, ',')) value = std::stod(part);
  }
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Eigen::Vector3d(v[0], v[1], v[2]);
  T.linear() =
      (Eigen::AngleAxisd(v[5], Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(v[4], Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(v[3], Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  return T;
}

void write(std::FILE* out, std::int64_t stamp, const Eigen::Isometry3d& T) {
  const Eigen::Quaterniond q(T.linear());
  const Eigen::Vector3d t = T.translation();
  std::fprintf(out, "%.9f %.6f %.6f %.6f %.9f %.9f %.9f %.9f\n", 1e-9 * static_cast<double>(stamp), t.x(),
               t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
}

int run(const std::string& folder, const std::string& out_name, Peer& peer) {
  const std::vector<PeerImu> imu = peer.wants_imu() ? read_imu(folder + "/imu.txt") : std::vector<PeerImu>{};
  std::ifstream scans(folder + "/scans.bin", std::ios::binary);
  std::FILE* out = std::fopen(out_name.c_str(), "w");
  if (!scans || out == nullptr) return 1;
  std::size_t count = 0, heard = 0;
  double cpu = 0.0;
  while (const auto scan = next_scan(scans)) {
    const std::int64_t end = scan->start + static_cast<std::int64_t>(1e9 * scan->times.back());
    const double before = cpu_seconds();
    for (; heard < imu.size() && imu[heard].stamp <= end; ++heard) peer.add(imu[heard]);
    const Eigen::Isometry3d T_odom_base = peer.add(*scan);
    cpu += cpu_seconds() - before;
    write(out, scan->start, T_odom_base);
    ++count;
  }
  std::fclose(out);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf("scans %zu  CPU %.2f ms/scan  peak %.1f MB\n", count, 1e3 * cpu / static_cast<double>(count),
              static_cast<double>(usage.ru_maxrss) / 1024.0);
  return 0;
}

}  // namespace
}  // namespace fleetmap::peers

int main(int argc, char** argv) {
  using namespace fleetmap::peers;
  if (argc < 3) {
    std::cerr << "usage: peer_NAME FOLDER OUT.tum [lidar=X,Y,Z,R,P,Y] [imu_mount=...] [SETTING=VALUE ...]\n";
    return 2;
  }
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  Mounts mounts;
  std::map<std::string, double> values;
  for (int i = 3; i < argc; ++i) {
    const std::string argument = argv[i];
    const auto equals = argument.find('=');
    const std::string name = argument.substr(0, equals), value = argument.substr(equals + 1);
    if (name == "lidar") {
      mounts.T_base_lidar = mount(value);
    } else if (name == "imu_mount") {
      mounts.T_base_imu = mount(value);
    } else {
      values[name] = std::stod(value);
    }
  }
  Settings settings(values);
  const auto peer = make_peer(mounts, settings);
  for (const auto& [name, value] : settings.left()) {
    std::cerr << name << ": unknown setting\n";
    return 2;
  }
  return run(argv[1], argv[2], *peer);
}
