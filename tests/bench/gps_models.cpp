// Prints how the EKF fares with GPS errors other than its model of them, as a Markdown table: RMS errors and
// NEES, means over the seeds with the worst seed in brackets.
//   bench_gps_models [SEEDS [SECONDS]]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>

#include "sim/ekf_drive.hpp"

namespace {

using fleetmap::sim::GpsSpec;
using namespace fleetmap::sim::testing;

struct Model {
  const char* name;
  std::function<void(GpsSpec&)> set;
};

const Model kModels[] = {
    {"as the EKF models it", [](GpsSpec&) {}},
    {"correlated over 5 s", [](GpsSpec& gps) { gps.correlation_time = 5.0; }},
    {"correlated over 10 s", [](GpsSpec& gps) { gps.correlation_time = 10.0; }},
    {"correlated over 600 s", [](GpsSpec& gps) { gps.correlation_time = 600.0; }},
    {"covariance four times too small", [](GpsSpec& gps) { gps.covariance_factor = 0.25; }},
    {"covariance four times too large", [](GpsSpec& gps) { gps.covariance_factor = 4.0; }},
    {"90 jumps an hour, 5 m for 20 s",
     [](GpsSpec& gps) { gps.jumps_per_hour = 90.0, gps.jump_size = 5.0, gps.jump_duration = 20.0; }},
    {"altitude swings by 10 m in 240 s",
     [](GpsSpec& gps) { gps.altitude_wave = 5.0, gps.altitude_period = 240.0; }},
};

/// Mean and worst over the seeds.
struct Spread {
  void add(double value) { sum += value, worst = std::max(worst, value), ++count; }
  void print(const char* format) const { std::printf(format, sum / count, worst); }
  double sum = 0.0, worst = 0.0;
  int count = 0;
};

}  // namespace

int main(int argc, char** argv) {
  const int seeds = argc > 1 ? std::max(1, std::atoi(argv[1])) : 20;
  EkfDrive drive;
  drive.seconds = argc > 2 ? std::max(30.0, std::atof(argv[2])) : 300.0;
  drive.robot.gps.white_sigma = 0.45;
  drive.robot.gps.drift_sigma = 1.43;
  std::printf(
      "| GPS | horizontal m | height m | heading deg | NEES horizontal | NEES height | NEES heading |\n");
  std::printf("|---|---|---|---|---|---|---|\n");
  for (const Model& model : kModels) {
    EkfDrive varied = drive;
    model.set(varied.robot.gps);
    Spread horizontal, height, heading, nees_horizontal, nees_up, nees_yaw;
    for (int seed = 1; seed <= seeds; ++seed) {
      const EkfErrors errors = run(varied, static_cast<std::uint64_t>(seed));
      horizontal.add(errors.horizontal);
      height.add(errors.height);
      heading.add(errors.heading * 57.29577951);
      nees_horizontal.add(errors.nees_horizontal);
      nees_up.add(errors.nees_up);
      nees_yaw.add(errors.nees_yaw);
    }
    std::printf("| %s |", model.name);
    for (const Spread* spread : {&horizontal, &height, &heading, &nees_horizontal, &nees_up, &nees_yaw})
      spread->print(" %.2f (%.2f) |");
    std::printf("\n");
    std::fflush(stdout);
  }
}
