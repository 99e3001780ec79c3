#include "fleetmap/odometry/lidar_model.hpp"

#include <cmath>
#include <numbers>

#include "fleetmap/core/text_list.hpp"
#include "fleetmap/geometry/degree.hpp"

namespace fleetmap::odometry {
namespace {

/// `count` angles, evenly spaced from `first` to `last` degrees, in radians.
void append_angles(std::vector<double>& angles, int count, double first, double last) {
  for (int i = 0; i < count; ++i) angles.push_back((first + (last - first) * i / (count - 1)) * kDegree);
}

}  // namespace

Status LidarModel::validate() const {
  if (name.empty()) return failure("lidar.name: must not be empty");
  if (vertical_angles.size() > kMaxRings) return failure("lidar.vertical_angles: at most 256 rings");
  for (const double angle : vertical_angles) {
    if (!(std::abs(angle) < std::numbers::pi / 2)) {
      return failure("lidar.vertical_angles: each must lie between -90 and 90 degrees");
    }
  }
  if (!(scan_period >= 1e-3 && scan_period <= 10.0))
    return failure("lidar.scan_period: must be 0.001 to 10 s");
  if (columns < 1 || columns > 100000) return failure("lidar.columns: must be 1 to 100000");
  if (sweep_start_azimuth && !std::isfinite(*sweep_start_azimuth)) {
    return failure("lidar.sweep_start_azimuth: must be finite");
  }
  if (!(stamp_phase >= 0.0 && stamp_phase <= 1.0)) return failure("lidar.stamp_phase: must be 0 to 1");
  return {};
}

LidarModel vlp16() {
  LidarModel model;
  model.name = "vlp16";
  append_angles(model.vertical_angles, 16, -15.0, 15.0);
  model.columns = 1800;
  return model;
}

LidarModel os1_64() {
  LidarModel model;
  model.name = "os1-64";
  append_angles(model.vertical_angles, 64, 16.611, -16.611);
  model.columns = 1024;
  return model;
}

LidarModel hdl64e() {
  LidarModel model;
  model.name = "hdl64e";
  append_angles(model.vertical_angles, 32, 2.0, -8.33);
  append_angles(model.vertical_angles, 32, -8.83, -24.33);
  model.ring_source = RingSource::kPointOrder;
  model.columns = 2000;
  model.sweep_start_azimuth = std::numbers::pi;
  model.stamp_phase = 0.5;
  return model;
}

LidarModel generic_lidar() {
  LidarModel model;
  model.name = "generic";
  model.ring_source = RingSource::kNone;
  return model;
}

Result<LidarModel> lidar_model(std::string_view name) {
  std::string known;
  for (const auto make : {&vlp16, &os1_64, &hdl64e, &generic_lidar}) {
    LidarModel model = make();
    if (model.name == name) return model;
    append_to_list(known, model.name);
  }
  std::string message = "'";  // GCC 12 warns wrongly of a sum that begins with so short a literal
  return failure(message.append(name).append("' is unknown; expected one of ").append(known));
}

}  // namespace fleetmap::odometry
