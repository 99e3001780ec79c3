#include "item_puts.hpp"

#include "fingerprint.hpp"
#include "item_codec.hpp"
#include "item_rules.hpp"

namespace fleetmap::store {
namespace {

Status contest_node(StoreState& s, const graph::Node& node, ByteView item) {
  auto transaction = Transaction::begin(*s.db);
  if (!transaction) return tl::unexpected(transaction.error());
  const auto& [agent, seq] = node.id;
  if (auto status = s.insert("contested_node", node.id, item, node.signature); !status) return status;
  if (auto status = s.run("DELETE FROM submap_chunk WHERE agent = ? AND seq = ?", agent, seq); !status)
    return status;
  // Its own submap the agent still needs, to name the node anew.
  if (agent != s.self) {
    if (auto status = s.run("DELETE FROM submap WHERE agent = ? AND seq = ?", agent, seq); !status)
      return status;
  }
  if (auto status = transaction->commit(); !status) return status;
  s.contest(node);
  return {};
}

Status contest_alignment(StoreState& s, const graph::Alignment& alignment, ByteView item) {
  const NodeId name{alignment.computed_by, alignment.seq};
  if (auto status = s.insert("contested_alignment", name, item, alignment.signature); !status) return status;
  s.contest(alignment);
  return {};
}

}  // namespace

Result<Put> put_node(StoreState& s, const graph::Node& node, const ByteView* submap) {
  const bool submap_fits =
      !submap || (submap->size() == node.submap_bytes && content_hash(*submap) == node.submap_hash);
  if (!is_valid(node, s.config) || !submap_fits) return s.count(Put::kInvalid);
  const Bytes item = encode(node);
  if (s.contested_nodes.contains(node.id)) return s.count(submap ? Put::kConflict : Put::kKnown);
  if (const auto held = s.nodes.find(node.id); held != s.nodes.end()) {
    if (encode(held->second) == item) return s.count(Put::kKnown);
    // A new own item contests nothing, because it was not announced yet.
    if (submap) return s.count(Put::kConflict);
    if (auto status = contest_node(s, node, item); !status) return tl::unexpected(status.error());
    return s.count(Put::kConflict);
  }
  const auto insert = [&]() -> Status {
    auto transaction = Transaction::begin(*s.db);
    if (!transaction) return tl::unexpected(transaction.error());
    if (auto status = s.insert("node", node.id, item, node.signature); !status) return status;
    if (submap && !submap->empty()) {
      auto status =
          s.run("INSERT OR REPLACE INTO submap VALUES(?, ?, ?)", node.id.agent, node.id.seq, submap);
      if (!status) return status;
    }
    return transaction->commit();
  };
  const Status inserted = s.commit(node.id.agent == s.self, insert);
  if (!inserted) return tl::unexpected(inserted.error());
  s.nodes.emplace(node.id, node);
  s.node_prints.set(node.id, fingerprint(node));
  s.node_set.insert(node.id.agent, node.id.seq);
  if (submap || node.submap_bytes == 0) s.submap_set.insert(node.id.agent, node.id.seq);
  return s.count(Put::kAdded);
}

Result<Put> put_alignment(StoreState& s, const graph::Alignment& alignment) {
  if (!is_valid(alignment)) return s.count(Put::kInvalid);
  const AlignmentId id{alignment.computed_by, alignment.seq};
  const Bytes item = encode(alignment);
  if (s.contested_alignments.contains(id)) return s.count(Put::kKnown);
  if (const auto held = s.alignments.find(id); held != s.alignments.end()) {
    if (encode(held->second) == item) return s.count(Put::kKnown);
    if (auto status = contest_alignment(s, alignment, item); !status) return tl::unexpected(status.error());
    return s.count(Put::kConflict);
  }
  const Status inserted = s.commit(id.computed_by == s.self, [&] {
    return s.insert("alignment", name_of(id), item, alignment.signature);
  });
  if (!inserted) return tl::unexpected(inserted.error());
  s.alignments.emplace(id, alignment);
  s.alignment_prints.set(name_of(id), fingerprint(alignment));
  s.alignment_set.insert(id.computed_by, id.seq);
  return s.count(Put::kAdded);
}

}  // namespace fleetmap::store
