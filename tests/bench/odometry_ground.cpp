// Prints what the odometry errs by and what it states where little but ground is seen: LiDAR alone, and with
// gyro and wheels (whose speed is 2 % too large). A Markdown table.
//   bench_odometry_ground [--only NAME]
#include <cstdio>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "odometry/stated_drive.hpp"

namespace {

using namespace fleetmap;
using testing::DriveLeg;
using testing::PoorDrive;
using testing::SyntheticWorld;

const std::vector<DriveLeg> kStraight{{1, 0, 0}, {27, 1.5, 0}};
const std::vector<DriveLeg> kWeaving{{1, 0, 0}, {5, 1.5, 0.2}, {10, 1.5, -0.2}, {10, 1.5, 0.2}};

SyntheticWorld with_posts(int count) {
  SyntheticWorld world;
  for (int i = 0; i < count; ++i)
    world.add_post({-6.0 + 48.0 * i / count, (i % 2 == 0 ? 1.0 : -1.0) * (9.0 + i % 3)}, 0.12, 4.0);
  return world;
}

SyntheticWorld with_wall(double length) {
  SyntheticWorld world;
  world.add_box(make_pose(Eigen::Quaterniond::Identity(), Eigen::Vector3d(20.0, 6.0, 1.0)),
                {0.5 * length, 0.2, 1.0});
  return world;
}

bool low(const sensor::ScanPoint& p) { return p.position.z() < -0.7F; }

struct Named {
  std::string name;
  PoorDrive drive;
};

std::vector<Named> drives() {
  std::vector<Named> all;
  const auto add = [&](std::string name, PoorDrive drive) -> PoorDrive& {
    return all.emplace_back(Named{std::move(name), std::move(drive)}).drive;
  };
  const auto rolls = [](double height, double rough = 0.0) {
    return testing::drive_on(testing::rolling_ground(height, rough));
  };
  add("level, errands", {});
  add("level, errands, 5 cm of noise", {}).noise = 0.05;
  add("level, straight on", {}).legs = kStraight;
  add("level, weaving", {}).legs = kWeaving;
  add("yard, nothing above 0.1 m, errands", testing::drive_in(testing::yard_world())).keep = low;
  add("rolls by 0.25 m, straight on", rolls(0.25)).legs = kStraight;
  add("rolls by 0.25 m, errands", rolls(0.25));
  add("rolls by 0.25 m, errands, 5 cm of noise", rolls(0.25)).noise = 0.05;
  add("rolls by 0.4 m, straight on", rolls(0.4)).legs = kStraight;
  add("rolls by 0.8 m, straight on", rolls(0.8)).legs = kStraight;
  add("rolls by 0.8 m, rough by 0.03 m, errands", rolls(0.8, 0.03));
  add("rough by 0.03 m, errands", rolls(0.0, 0.03));
  PoorDrive& livox = add("rolls by 0.8 m, Livox-like, straight on", rolls(0.8));
  livox.legs = kStraight;
  livox.model = odometry::generic_lidar();
  add("level, three posts, errands", testing::drive_in(with_posts(3)));
  add("level, twelve posts, errands", testing::drive_in(with_posts(12)));
  add("level, wall of 160 m along, errands", testing::drive_in(with_wall(160.0)));
  add("level, wall of 12 m, straight on", testing::drive_in(with_wall(12.0))).legs = kStraight;
  PoorDrive& panels = add("panels, Livox-like, aisle", testing::drive_in(testing::panel_world()));
  panels.legs = kStraight;
  panels.model = odometry::generic_lidar();
  add("yard, errands", testing::drive_in(testing::yard_world()));
  return all;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string only = argc == 3 && std::strcmp(argv[1], "--only") == 0 ? argv[2] : "";
  std::printf(
      "| drive | sensors | seed | error m | stated m | NEES over 3 s: mean, worst | degenerate scans | lost "
      "| "
      "exit code |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const auto& [name, drive] : drives()) {
    if (name.find(only) == std::string::npos) continue;
    for (const bool all : {false, true}) {
      for (const std::uint64_t seed : {1, 2}) {
        const testing::StatedDrive stated = testing::state_drive(drive, all, seed);
        std::printf("| %s | %s | %d | %.3f | %.3f | %.2f, %.1f | %d of %d | %d | %d |\n", name.c_str(),
                    all ? "all" : "LiDAR", static_cast<int>(seed), stated.error, stated.sigma, stated.nees,
                    stated.worst_nees, stated.degenerate, stated.scans, static_cast<int>(stated.lost),
                    stated.warned ? 1 : 0);
        std::fflush(stdout);
      }
    }
  }
  return 0;
}
