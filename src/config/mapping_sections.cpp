#include "mapping_sections.hpp"

namespace fleetmap::config {

void read_mapping(Section& top, agent::AgentConfig& agent) {
  Section nodes = top.section("nodes");
  nodes.read("spacing", agent.nodes.spacing);
  nodes.finish();
  nodes.check(agent.nodes.validate());

  Section submap = top.section("submap");
  submap.read("voxel", agent.submap.voxel);
  submap.read("resolution", agent.submap.resolution);
  submap.read("scan_spacing", agent.submap.scan_spacing);
  submap.read_degrees("scan_angle_deg", agent.submap.scan_angle);
  submap.read("max_bytes", agent.submap.max_bytes);
  submap.finish();
  submap.check(agent.submap.validate());

  Section map = top.section("map");
  map.read("voxel", agent.map.voxel_m);
  map.read("centroids", agent.map.centroids);
  map.finish();
  map.check(agent.map.validate());
}

}  // namespace fleetmap::config
