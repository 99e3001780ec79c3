#pragma once

#include <optional>
#include <vector>

#include "fleetmap/sensor/calibration_drive.hpp"

namespace fleetmap::sensor {

/// Every scan that is `spacing` s later than the last one taken.
std::vector<LidarPose> lidar_knots(const std::vector<LidarPose>& track, double spacing);
/// rad that base_link turned from pose to pose, summed.
double turned(const std::vector<LidarPose>& track);
/// Between the two poses around `stamp`; empty if these are more than 0.5 s apart.
std::optional<Pose> pose_at(const std::vector<LidarPose>& track, Stamp stamp);

}  // namespace fleetmap::sensor
