#include "fleetmap/sensor/lidar_frames.hpp"

#include "fleetmap/sensor/frame_tree.hpp"

namespace fleetmap::sensor {
namespace {

constexpr int kByTurns = 3;  // changes of the frame

}  // namespace

std::optional<std::string> LidarFrames::add(const std::string& frame_id) {
  const std::string frame = FrameTree::name_of(frame_id);
  if (frame.empty() || changes_ == kByTurns) return std::nullopt;
  if (first_.empty()) first_ = last_ = frame;
  if (frame == last_) return std::nullopt;
  const std::string before = last_;
  last_ = frame;
  if (++changes_ < kByTurns) return std::nullopt;
  return "LiDAR: the messages of its topic are of two frames by turns, '" + first_ + "' and '" +
         (frame == first_ ? before : frame) +
         "': two LiDARs publish on it, and their scans are used as those of one at the first one's mount, "
         "which spoils the map. Give each driver a topic of its own and set topics.points to one of them "
         "(recording.topics.points of a recording); a recording of both has to be split by frame_id";
}

}  // namespace fleetmap::sensor
