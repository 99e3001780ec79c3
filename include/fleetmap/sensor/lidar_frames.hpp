#pragma once

#include <optional>
#include <string>

namespace fleetmap::sensor {

/// Finds two LiDARs that publish on one topic: its messages name two frames by turns. A driver that begins to
/// use another name changes it once.
class LidarFrames {
 public:
  /// The finding with its remedy, at the message by which it is decided.
  std::optional<std::string> add(const std::string& frame_id);

 private:
  std::string first_, last_;
  int changes_ = 0;
};

}  // namespace fleetmap::sensor
