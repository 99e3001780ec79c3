#include "store_state.hpp"

#include "fingerprint.hpp"
#include "row_hash.hpp"

namespace fleetmap::store {

std::uint32_t chunk_count(const graph::Node& node) {
  return node.submap_bytes / Store::kChunkBytes + (node.submap_bytes % Store::kChunkBytes != 0);
}

std::uint32_t chunk_size(const graph::Node& node, std::uint32_t chunk) {
  return std::min(Store::kChunkBytes, node.submap_bytes - chunk * Store::kChunkBytes);
}

const graph::Node* StoreState::node(const NodeId& id) const {
  const auto it = nodes.find(id);
  return it == nodes.end() ? nullptr : &it->second;
}

Put StoreState::count(Put put) {
  switch (put) {
    case Put::kAdded:
      ++stats.added;
      break;
    case Put::kKnown:
      ++stats.known;
      break;
    case Put::kConflict:
      ++stats.conflicts;
      break;
    case Put::kInvalid:
      ++stats.invalid;
      break;
  }
  return put;
}

Status StoreState::run(std::string_view sql, const AgentId& agent, std::uint32_t seq, const ByteView* blob) {
  auto statement = db->prepare(sql);
  if (!statement) return tl::unexpected(statement.error());
  statement->bind(1, agent.str()).bind(2, std::int64_t{seq});
  if (blob) statement->bind(3, *blob);
  return statement->run();
}

Status StoreState::insert(const char* table, const NodeId& name, ByteView item,
                          const std::optional<Signature>& signature) {
  auto statement = db->prepare("INSERT INTO " + std::string(table) + " VALUES(?, ?, ?, ?, ?)");
  if (!statement) return tl::unexpected(statement.error());
  const ContentHash hash = row_hash(item, bytes_of(signature));
  return statement->bind(1, name.agent.str())
      .bind(2, std::int64_t{name.seq})
      .bind(3, item)
      .bind(4, ByteView(hash))
      .bind(5, bytes_of(signature))
      .run();
}

Status StoreState::remove(const char* table, const NodeId& name) {
  return run("DELETE FROM " + std::string(table) + " WHERE agent = ? AND seq = ?", name.agent, name.seq);
}

Status StoreState::remove_submap(const NodeId& name) {
  if (auto status = remove("submap", name); !status) return status;
  return remove("submap_chunk", name);
}

void StoreState::contest(const graph::Node& second) {
  contested_nodes.emplace(second.id, Contested<graph::Node>{nodes.extract(second.id), second});
  node_prints.set(second.id, fingerprint_of_contested(second.id));
  submap_set.erase(second.id.agent, second.id.seq);
  partials.erase(second.id);
}

void StoreState::contest(const graph::Alignment& second) {
  const AlignmentId id{second.computed_by, second.seq};
  contested_alignments.emplace(id, Contested<graph::Alignment>{alignments.extract(id), second});
  alignment_prints.set(name_of(id), fingerprint_of_contested(name_of(id)));
}

PartialSubmap& StoreState::partial(const graph::Node& node) {
  const auto [it, fresh] = partials.try_emplace(node.id);
  if (fresh) {
    it->second.missing = chunk_count(node);
    it->second.held.assign(it->second.missing, false);
  }
  return it->second;
}

}  // namespace fleetmap::store
