#include "dds_section.hpp"

#include <string>

namespace fleetmap::config {
namespace {

void read_dds_link(Section& dds, const char* key, bus::DdsLinkConfig& link) {
  Section section = dds.section(key);
  section.read("enabled", link.enabled);
  section.read("domain", link.domain);
  section.read("address", link.address);
  section.read("peers", link.peers);
  section.read("participants_per_peer", link.participants_per_peer);
  section.read("multicast", link.multicast);
  section.read("shared_memory", link.shared_memory);
  section.finish();
}

}  // namespace

void read_dds(Section& top, bus::DdsBusConfig& dds) {
  Section section = top.section("dds");
  section.read_path("qos", dds.qos_directory);
  read_dds_link(section, "onboard", dds.onboard);
  read_dds_link(section, "long_range", dds.long_range);
  read_dds_link(section, "short_range", dds.short_range);
  section.finish();
  section.check(dds.validate());
}

void check_profiles(Section& dds, const std::filesystem::path& folder) {
  for (const char* link : {"onboard", "long_range", "short_range"}) {
    const std::filesystem::path file = folder / (std::string(link) + ".xml");
    const auto reason = unreadable(file);
    if (!reason) continue;
    return dds.problem("qos", file.string() + ": " + *reason +
                                  "; expected the folder of the links' profiles (qos/ of fleetmap), relative "
                                  "to this file or with its whole path");
  }
}

}  // namespace fleetmap::config
