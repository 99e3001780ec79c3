#include "store_summary.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "fleetmap/fleet_codec/messages.hpp"

namespace fleetmap::apps {
namespace {

struct Count {
  std::size_t nodes = 0, alignments = 0, submaps = 0;
  std::set<std::uint16_t> sessions;
};

nlohmann::json json_of(const Count& count) {
  return {{"nodes", count.nodes}, {"alignments", count.alignments}, {"submaps", count.submaps}};
}

}  // namespace

nlohmann::json summary_of(const store::Store& store) {
  Count all;
  std::map<std::string, Count> robots;
  std::uint64_t submap_bytes = 0;
  Bytes items;
  const auto add = [&items](const Bytes& item) { items.insert(items.end(), item.begin(), item.end()); };
  for (const auto& [id, node] : store.nodes()) {
    Count& robot = robots[id.agent.str()];
    ++all.nodes;
    ++robot.nodes;
    robot.sessions.insert(node.session);
    const bool whole = store.has_submap(id);
    all.submaps += whole;
    submap_bytes += whole ? node.submap_bytes : 0u;
    robot.submaps += whole;
    add(fleet_codec::encode(node));
    items.push_back(whole);
  }
  for (const auto& [id, alignment] : store.alignments()) {
    ++all.alignments;
    ++robots[id.computed_by.str()].alignments;
    add(fleet_codec::encode(alignment));
  }
  for (const NodeId& id : store.partial_submaps()) {
    const std::uint32_t whole = store.node(id)->submap_bytes;
    submap_bytes += whole;
    for (const std::uint32_t chunk : store.missing_chunks(id)) {
      const std::uint32_t begin = chunk * store::Store::kChunkBytes;
      submap_bytes -= std::min(store::Store::kChunkBytes, whole - begin);  // the last one is shorter
    }
  }
  nlohmann::json json = json_of(all);
  json["store_of"] = store.self().str();
  json["submap_bytes"] = submap_bytes;
  json["hash"] = to_hex(content_hash(items));
  json["robots"] = nlohmann::json::object();
  for (const auto& [name, count] : robots) {
    json["robots"][name] = json_of(count);
    json["robots"][name]["sessions"] = count.sessions.size();
  }
  return json;
}

}  // namespace fleetmap::apps
