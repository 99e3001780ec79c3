// Prints what `fleetmap odometry` needs and says when its scans do not belong together: peak memory, the size
// of the local map, the exit code and what was counted. A Markdown table.
//   bench_odometry_lost [--seconds S] [--only NAME] [--folder DIR]
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <random>
#include <regex>
#include <string>
#include <vector>

#include "fleetmap/config/sensor_file.hpp"
#include "fleetmap/config/world_file.hpp"
#include "fleetmap/recording/bag_writer.hpp"
#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "fleetmap/ros_codec/topics.hpp"
#include "sim/lane_odometry.hpp"
#include "support/process.hpp"

namespace {

using namespace fleetmap;

/// Kinds of spoilt scans. Numbers of scans are those of an undisturbed drive.
struct Disturbance {
  const char* name;
  int scans_between_jumps = 0;  ///< then the robot is at another place of its drive
  double noise = 0.02;          ///< m, of a range
  double keep = 1.0;            ///< share of the rays
  double foreign = 0.0;         ///< share of the points that come from another scan of the drive
  double swelling = 0.0;        ///< ranges grow and shrink by this share within 20 s
  bool times_reversed = false;
  bool points_anywhere = false;  ///< within 40 m
  std::vector<std::string> set{};
};

const Disturbance kDisturbances[] = {
    {.name = "none"},
    {.name = "carried elsewhere every 3 s", .scans_between_jumps = 30},
    {.name = "every scan from elsewhere", .scans_between_jumps = 1},
    {.name = "noise 0.5 m", .noise = 0.5},
    {.name = "one ray in ten", .keep = 0.1},
    {.name = "one ray in fifty", .keep = 0.02},
    {.name = "half of each scan from elsewhere", .foreign = 0.5},
    {.name = "ranges swell by a fifth", .swelling = 0.2},
    {.name = "times of the points reversed", .times_reversed = true},
    {.name = "the same, noise 5 cm, bent map trusted",
     .noise = 0.05,
     .times_reversed = true,
     .set = {"odometry.linear_acceleration=100", "odometry.angular_acceleration=100"}},
    {.name = "points anywhere", .points_anywhere = true},
    {.name = "all: every 3 s, 0.5 m, one ray in five", .scans_between_jumps = 30, .noise = 0.5, .keep = 0.2},
};

/// The scans of one drive, spoilt.
class SpoiltDrive {
 public:
  SpoiltDrive(const sim::World& world, const sim::Scene& scene, sim::LidarSpec lidar, const Disturbance& how)
      : scene_(scene),
        lidar_(std::move(lidar)),
        how_(how),
        drive_(world, testing::DriveCondition{.name = how.name}, 280.0, 1) {
    lidar_.range_noise = how.noise;
  }

  sensor::Scan scan(std::uint64_t number) {
    if (how_.scans_between_jumps > 0 && number % static_cast<std::uint64_t>(how_.scans_between_jumps) == 0)
      shift_ = anywhere();
    sensor::Scan scan = cast(number + shift_);
    scan.stamp = Stamp{from_seconds(static_cast<double>(number) / lidar_.rate)};
    if (how_.foreign > 0.0) mix(scan, cast(anywhere()));
    if (how_.keep < 1.0) std::erase_if(scan.points, [this](const auto&) { return !chance(how_.keep); });
    for (sensor::ScanPoint& p : scan.points) spoil(p, static_cast<double>(number) / lidar_.rate);
    return scan;
  }

 private:
  sensor::Scan cast(std::uint64_t number) const {
    const auto scans = static_cast<std::uint64_t>(drive_.duration() * lidar_.rate) - 1;
    return sim::cast_scan(scene_, lidar_, testing::scan_of(drive_, lidar_, number % scans, 1));
  }
  std::uint64_t anywhere() { return random_() % 100'000; }
  bool chance(double share) { return uniform_(random_) < share; }
  void mix(sensor::Scan& scan, const sensor::Scan& other) {
    for (std::size_t i = 0; i < std::min(scan.points.size(), other.points.size()); ++i) {
      if (chance(how_.foreign)) scan.points[i] = other.points[i];
    }
  }
  void spoil(sensor::ScanPoint& p, double seconds) {
    if (how_.swelling > 0.0)
      p.position *= static_cast<float>(1.0 + how_.swelling * std::sin(0.314 * seconds));
    if (how_.times_reversed) p.time = static_cast<float>(1.0 / lidar_.rate) - p.time;
    if (how_.points_anywhere) {
      const auto to = [this] { return static_cast<float>(80.0 * uniform_(random_) - 40.0); };
      p.position = {to(), to(), to()};
    }
  }

  const sim::Scene& scene_;
  sim::LidarSpec lidar_;
  const Disturbance& how_;
  testing::LaneDrive drive_;
  std::mt19937_64 random_{3};
  std::uniform_real_distribution<double> uniform_{0.0, 1.0};
  std::uint64_t shift_ = 0;
};

Status record(SpoiltDrive& drive, double seconds, const std::filesystem::path& bag_folder) {
  auto bag = recording::BagWriter::create(bag_folder);
  if (!bag) return tl::unexpected(bag.error());
  const bus::Topic topic = ros_codec::topics::points();
  for (std::uint64_t k = 0; static_cast<double>(k) < 10.0 * seconds; ++k) {
    const sensor::Scan scan = drive.scan(k);
    const Status written = bag->write(topic.name, topic.type, scan.stamp + std::chrono::milliseconds(100),
                                      ros_codec::encode(scan));
    if (!written) return written;
  }
  return bag->close();
}

/// The number that stands for (...) in the program's output; 0 if it says no such thing.
std::string said(const std::string& output, const char* pattern) {
  std::smatch match;
  return std::regex_search(output, match, std::regex(pattern)) ? match[1].str() : "0";
}

void print(const Disturbance& how, const std::filesystem::path& bag, const std::filesystem::path& out) {
  std::vector<std::string> command{std::string(FLEETMAP_BINARY_DIR) + "/bin/fleetmap", "odometry",
                                   bag.string(), "--out", out.string()};
  for (const std::string& key : how.set) command.insert(command.end(), {"--set", key});
  testing::Process program(command);
  const int exit_code = program.wait();
  const std::string text = program.output();
  std::printf("| %s | %s | %s | %s | %s | %s | %s | %s | %s | %d |\n", how.name,
              said(text, "scans ([0-9]+)").c_str(), said(text, "peak ([0-9.]+) MB").c_str(),
              said(text, "at most ([0-9]+) windows").c_str(), said(text, "windows, ([0-9.]+) MB").c_str(),
              said(text, "refused ([0-9]+)").c_str(), said(text, "lost ([0-9]+) of").c_str(),
              said(text, "begun anew ([0-9]+)").c_str(), said(text, "was full ([0-9]+)").c_str(), exit_code);
  std::fflush(stdout);
}

int run(double seconds, const std::string& only, const std::filesystem::path& folder) {
  const std::filesystem::path config = std::filesystem::path(FLEETMAP_SOURCE_DIR) / "config";
  const auto world = config::make_world(config / "worlds/rolling_60.yaml", 1);
  const auto lidar = config::load_lidar_spec(config / "sensors/vlp16.yaml");
  if (!world || !lidar) return 1;
  const auto scene = sim::Scene::create((*world)->mesh());
  std::printf(
      "| scans are spoilt by | scans | peak MB | map: windows | MB | refused | lost | begun anew | full | "
      "exit "
      "|\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Disturbance& how : kDisturbances) {
    if (!only.empty() && std::string(how.name).find(only) == std::string::npos) continue;
    const std::filesystem::path bag = folder / "bag";
    std::filesystem::remove_all(bag);
    SpoiltDrive drive(**world, **scene, *lidar, how);
    if (const Status recorded = record(drive, seconds, bag); !recorded) {
      std::printf("%s\n", recorded.error().message.c_str());
      return 1;
    }
    print(how, bag, folder / "o.tum");
    std::filesystem::remove_all(bag);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  double seconds = 300.0;
  std::string only;
  std::filesystem::path folder = std::filesystem::temp_directory_path() / "bench_odometry_lost";
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--seconds") == 0) seconds = std::stod(argv[i + 1]);
    if (std::strcmp(argv[i], "--only") == 0) only = argv[i + 1];
    if (std::strcmp(argv[i], "--folder") == 0) folder = argv[i + 1];
  }
  std::filesystem::create_directories(folder);
  return run(seconds, only, folder);
}
