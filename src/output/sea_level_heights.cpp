#include "fleetmap/output/sea_level_heights.hpp"

#include <sstream>
#include <string>

#include "fleetmap/core/text_list.hpp"

namespace fleetmap::output {
namespace {

constexpr const char* kSeaLevelKey = "sea_level_heights";
constexpr const char* kKnownHeightsKey = "known_heights";  // names, each behind a blank

}  // namespace

Status keep_sea_level_heights(store::Store& store) { return store.set_meta(kSeaLevelKey, Bytes{1}); }

bool has_sea_level_heights(const store::Store& store) {
  const auto kept = store.meta(kSeaLevelKey);
  return kept && kept->has_value();
}

Status keep_known_heights(store::Store& store, const std::set<AgentId>& robots) {
  std::string names;
  for (const AgentId& robot : robots) append_to_list(names, robot.str(), " ");
  return store.set_meta(kKnownHeightsKey, bytes_of(names));
}

std::set<AgentId> known_heights(const store::Store& store) {
  std::set<AgentId> known{store.self()};
  const auto kept = store.meta(kKnownHeightsKey);
  if (!kept || !kept->has_value()) return known;
  std::istringstream names(std::string((*kept)->begin(), (*kept)->end()));
  for (std::string name; names >> name;) {
    if (const auto robot = AgentId::parse(name)) known.insert(*robot);
  }
  return known;
}

std::set<AgentId> unknown_heights(const store::Store& store) {
  const std::set<AgentId> known = known_heights(store);
  std::set<AgentId> unknown;
  for (const auto& [id, node] : store.nodes()) {
    if (node.G && !known.contains(id.agent)) unknown.insert(id.agent);
  }
  return unknown;
}

}  // namespace fleetmap::output
