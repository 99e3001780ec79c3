#include "ros_section.hpp"

namespace fleetmap::config {

ros_output::RosOutputConfig read_ros(Section& top) {
  ros_output::RosOutputConfig ros;
  Section section = top.section("ros");
  section.read("publish", ros.publish);
  section.read("tf", ros.tf);
  section.read("map_voxel", ros.map_voxel);
  std::uint64_t points = ros.map_points;
  section.read("map_points", points);
  ros.map_points = points;
  section.read_seconds("map_period", ros.map_period);
  section.finish();
  section.check(ros.validate());
  return ros;
}

}  // namespace fleetmap::config
