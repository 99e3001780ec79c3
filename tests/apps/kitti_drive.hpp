#pragma once

namespace fleetmap::testing {

/// The recording among the shared data that tests play.
inline constexpr const char* kKittiDrive = "kitti_raw_2011_09_26_drive_0005";

}  // namespace fleetmap::testing
