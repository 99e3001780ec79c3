#include "submap_rows.hpp"

namespace fleetmap::store {
namespace {

Status complete_submap(StoreState& s, const graph::Node& node, ByteView encoded) {
  auto transaction = Transaction::begin(*s.db);
  if (!transaction) return tl::unexpected(transaction.error());
  const auto& [agent, seq] = node.id;
  if (auto status = s.run("INSERT OR REPLACE INTO submap VALUES(?, ?, ?)", agent, seq, &encoded); !status)
    return status;
  if (auto status = s.run("DELETE FROM submap_chunk WHERE agent = ? AND seq = ?", agent, seq); !status)
    return status;
  if (auto status = transaction->commit(); !status) return status;
  s.partials.erase(node.id);
  s.submap_set.insert(agent, seq);
  return {};
}

}  // namespace

Result<Put> put_submap(StoreState& s, const NodeId& id, ByteView encoded) {
  const graph::Node* held = s.node(id);
  if (!held || encoded.size() != held->submap_bytes || content_hash(encoded) != held->submap_hash) {
    return s.count(Put::kInvalid);
  }
  if (s.has_submap(id)) return s.count(Put::kKnown);
  if (auto status = complete_submap(s, *held, encoded); !status) return tl::unexpected(status.error());
  return s.count(Put::kAdded);
}

Result<Put> put_submap_chunk(StoreState& s, const NodeId& id, std::uint32_t chunk, ByteView bytes) {
  const graph::Node* held = s.node(id);
  if (!held || chunk >= chunk_count(*held) || bytes.size() != chunk_size(*held, chunk))
    return s.count(Put::kInvalid);
  if (s.has_submap(id)) return s.count(Put::kKnown);
  if (const auto it = s.partials.find(id); it != s.partials.end() && it->second.held[chunk]) {
    return s.count(Put::kKnown);
  }
  auto insert = s.db->prepare("INSERT OR REPLACE INTO submap_chunk VALUES(?, ?, ?, ?)");
  if (!insert) return tl::unexpected(insert.error());
  insert->bind(1, id.agent.str()).bind(2, std::int64_t{id.seq}).bind(3, std::int64_t{chunk}).bind(4, bytes);
  if (auto status = insert->run(); !status) return tl::unexpected(status.error());
  PartialSubmap& partial = s.partial(*held);
  partial.held[chunk] = true;
  if (--partial.missing == 0) return finish_download(s, id);
  return s.count(Put::kAdded);
}

Result<Put> finish_download(StoreState& s, const NodeId& id) {
  const auto partial = s.partials.find(id);
  if (partial == s.partials.end() || partial->second.missing > 0) return s.count(Put::kInvalid);
  const graph::Node& node = s.nodes.at(id);
  auto rows = s.db->prepare("SELECT bytes FROM submap_chunk WHERE agent = ? AND seq = ? ORDER BY chunk");
  if (!rows) return tl::unexpected(rows.error());
  rows->bind(1, node.id.agent.str()).bind(2, std::int64_t{node.id.seq});
  Bytes encoded;
  encoded.reserve(node.submap_bytes);
  for (auto row = rows->step();; row = rows->step()) {
    if (!row) return tl::unexpected(row.error());
    if (!*row) break;
    const ByteView piece = rows->blob(0);
    encoded.insert(encoded.end(), piece.begin(), piece.end());
  }
  if (encoded.size() == node.submap_bytes && content_hash(encoded) == node.submap_hash) {
    if (auto status = complete_submap(s, node, encoded); !status) return tl::unexpected(status.error());
    return s.count(Put::kAdded);
  }
  auto status = s.run("DELETE FROM submap_chunk WHERE agent = ? AND seq = ?", node.id.agent, node.id.seq);
  if (!status) return tl::unexpected(status.error());
  s.partials.erase(node.id);
  ++s.stats.bad_submaps;
  return s.count(Put::kInvalid);
}

Result<Bytes> contested_submap(const StoreState& s, const NodeId& id) {
  const auto held = s.contested_nodes.find(id);
  if (held == s.contested_nodes.end()) return failure("node " + to_string(id) + " is not contested");
  const graph::Node& first = held->second.first.mapped();
  if (first.submap_bytes == 0) return Bytes{};
  auto rows = s.db->prepare("SELECT bytes FROM submap WHERE agent = ? AND seq = ?");
  if (!rows) return tl::unexpected(rows.error());
  const auto row = rows->bind(1, id.agent.str()).bind(2, std::int64_t{id.seq}).step();
  if (!row) return tl::unexpected(row.error());
  const ByteView bytes = *row ? rows->blob(0) : ByteView();
  if (content_hash(bytes) != first.submap_hash) {
    return failure(s.path.string() + ": the submap of contested node " + to_string(id) + " is not held");
  }
  return Bytes(bytes.begin(), bytes.end());
}

Result<Bytes> submap(StoreState& s, const NodeId& id) {
  const graph::Node* held = s.node(id);
  if (!held || !s.has_submap(id)) return failure("submap of node " + to_string(id) + " is not held");
  // A node without a submap may state any hash, and has nothing on the disk that could be damaged.
  if (held->submap_bytes == 0) return Bytes{};
  auto bytes = submap_part(s, id, 0, held->submap_bytes);
  if (bytes && bytes->size() == held->submap_bytes && content_hash(*bytes) == held->submap_hash) return bytes;
  if (!bytes && !s.db->is_damaged()) return bytes;
  // If its pages are damaged the row may stay in the file until the next start replaces that.
  if (!s.read_only) static_cast<void>(s.remove("submap", id));
  s.submap_set.erase(id.agent, id.seq);
  ++s.stats.lost_submaps;
  return failure(s.path.string() + ": submap of node " + to_string(id) +
                 " is damaged on disk; it was dropped");
}

Result<Bytes> submap_part(const StoreState& s, const NodeId& id, std::uint32_t offset, std::uint32_t length) {
  const graph::Node* held = s.node(id);
  if (!held || !s.has_submap(id)) return failure("submap of node " + to_string(id) + " is not held");
  if (offset >= held->submap_bytes) return Bytes{};
  auto rows = s.db->prepare("SELECT substr(bytes, ?3, ?4) FROM submap WHERE agent = ?1 AND seq = ?2");
  if (!rows) return tl::unexpected(rows.error());
  rows->bind(1, id.agent.str()).bind(2, std::int64_t{id.seq});
  rows->bind(3, std::int64_t{offset} + 1).bind(4, std::int64_t{length});
  const auto row = rows->step();
  if (!row) return tl::unexpected(row.error());
  const ByteView bytes = *row ? rows->blob(0) : ByteView();
  return Bytes(bytes.begin(), bytes.end());
}

std::vector<std::uint32_t> missing_chunks(const StoreState& s, const NodeId& id) {
  std::vector<std::uint32_t> missing;
  const graph::Node* held = s.node(id);
  if (!held || s.has_submap(id)) return missing;
  const auto partial = s.partials.find(id);
  for (std::uint32_t chunk = 0; chunk < chunk_count(*held); ++chunk) {
    if (partial == s.partials.end() || !partial->second.held[chunk]) missing.push_back(chunk);
  }
  return missing;
}

}  // namespace fleetmap::store
