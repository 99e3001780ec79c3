#include "loopback_domains.hpp"

#include "dds_section.hpp"

namespace fleetmap::config {

LoopbackDomains read_loopback(Section& top) {
  LoopbackDomains domains;
  Section dds = top.section("dds");
  dds.read("base_domain", domains.base);
  dds.read_path("qos", domains.qos);
  dds.finish();
  if (dds.has("qos")) check_profiles(dds, domains.qos);
  if (domains.base > 200) dds.problem("base_domain", "expected at most 200: DDS has domains up to 232");
  return domains;
}

bus::DdsBusConfig dds_of(const AgentId& agent, std::size_t index, const LoopbackDomains& domains) {
  bus::DdsBusConfig dds;
  dds.agent = agent;
  dds.qos_directory = domains.qos;
  const auto domain = [&](std::size_t offset) { return static_cast<int>(domains.base + offset); };
  dds.long_range.domain = domain(0);
  dds.short_range.domain = domain(1);
  dds.onboard.domain = domain(2 + index);
  dds.long_range.address = dds.short_range.address = "127.0.0.1";
  dds.long_range.peers = dds.short_range.peers = {"127.0.0.1"};
  return dds;
}

}  // namespace fleetmap::config
