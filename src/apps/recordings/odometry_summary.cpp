#include "odometry_summary.hpp"

#include <sys/resource.h>

#include <cmath>
#include <iomanip>
#include <numbers>
#include <string>

#include "report/distribution.hpp"

namespace fleetmap::apps {
namespace {

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

}  // namespace

void print_summary(std::ostream& out, const OdometryRun& run) {
  const Distribution ms = distribution(run.wall_ms);
  out << std::fixed << std::setprecision(2) << "scans " << run.wall_ms.size() << "  mean " << ms.mean
      << " ms  p50 " << ms.p50 << " ms  p99 " << ms.p99 << " ms  max " << ms.max << " ms  CPU "
      << 1e3 * run.cpu_s / static_cast<double>(run.wall_ms.size()) << " ms/scan  peak " << peak_megabytes()
      << " MB\n";
  for (const auto& [stage, seconds] : run.counters.cpu.named())
    out << stage << ' ' << 1e3 * seconds / static_cast<double>(run.wall_ms.size()) << " ms  ";
  out << "\nlocal map at most " << run.map.windows << " windows, "
      << static_cast<double>(run.map.bytes) / (1024.0 * 1024.0) << " MB\n";
  if (run.refused > 0) out << "refused " << run.refused << " scans, first: " << run.first_refusal << '\n';
}

void print_losses(std::ostream& out, const OdometryRun& run) {
  const odometry::LoamCounters& counters = run.counters;
  const Matrix6d C = run.way.covariance();
  const double sigma = std::sqrt(C.topLeftCorner<3, 3>().trace());
  out << "length " << run.way.length() << " m, stated to " << sigma << " m and "
      << std::sqrt(C.bottomRightCorner<3, 3>().trace()) * 180.0 / std::numbers::pi
      << " deg (1 sigma) at its end\n";
  if (run.blind > 0) {
    out << run.blind << " of " << counters.updates
        << " scans show the motion in some directions only; there it follows from the scans before, "
           "gyro and wheels\n";
  }
  if (counters.refused_repeated > 0) {
    out << counters.refused_repeated
        << " scans have the very points of the scan before while the robot moves: the LiDAR's driver hangs\n";
  }
  if (counters.lost > 0) {
    out << "lost " << counters.lost << " of " << counters.updates << " scans, the first "
        << to_seconds(*run.first_lost - run.poses.front().stamp)
        << " s after the start: the poses there are predictions\n";
  }
  if (counters.map_restarts > 0) {
    out << "the local map was begun anew " << counters.map_restarts
        << " times: poses before and after do not belong together\n";
  }
  if (counters.map_overflows > 0) {
    out << "the local map was full " << counters.map_overflows
        << " times, and what lay farthest was forgotten: scans do not belong together, or "
           "odometry.map_radius asks for more than the map holds\n";
  }
  for (const std::string& warning : run.way.warnings()) out << warning << '\n';
}

}  // namespace fleetmap::apps
