#include "store_load.hpp"

#include <algorithm>
#include <utility>

#include "fingerprint.hpp"
#include "item_codec.hpp"
#include "item_rules.hpp"
#include "row_hash.hpp"

namespace fleetmap::store {
namespace {

/// Passes agent, seq, item and signature of each row to `use`; drops rows whose hash differs or that `use`
/// refuses.
template <class Use>
Status load_rows(StoreState& s, const char* table, const Use& use) {
  struct Name {
    std::string agent;
    std::int64_t seq;
  };
  std::vector<Name> damaged;
  {
    auto rows = s.db->prepare("SELECT agent, seq, item, hash, signature FROM " + std::string(table));
    if (!rows) return tl::unexpected(rows.error());
    for (auto row = rows->step();; row = rows->step()) {
      if (!row) return tl::unexpected(row.error());
      if (!*row) break;
      const ByteView item = rows->blob(2);
      const ByteView bytes = rows->blob(4);
      std::optional<Signature> signature;
      if (bytes.size() == sizeof(Signature)) std::ranges::copy(bytes, signature.emplace().begin());
      const ContentHash hash = row_hash(item, bytes);
      const bool whole = std::ranges::equal(rows->blob(3), hash) &&
                         bytes.size() == bytes_of(signature).size() &&
                         use(rows->text(0), rows->integer(1), item, signature);
      if (!whole) damaged.push_back({std::string(rows->text(0)), rows->integer(1)});
    }
  }
  for (const Name& name : damaged) {
    s.damage.push_back(s.path.string() + ": the row of " + table + " " + name.agent + "/" +
                       std::to_string(name.seq) +
                       " is damaged; it was dropped and is fetched from other robots");
    if (s.read_only) continue;
    auto drop = s.db->prepare("DELETE FROM " + std::string(table) + " WHERE agent = ? AND seq = ?");
    if (!drop) return tl::unexpected(drop.error());
    if (auto status = drop->bind(1, std::string_view(name.agent)).bind(2, name.seq).run(); !status)
      return status;
  }
  return {};
}

Status load_values(StoreState& s) {
  std::vector<std::string> damaged;
  {
    auto rows = s.db->prepare("SELECT key, value, hash FROM meta");
    if (!rows) return tl::unexpected(rows.error());
    for (auto row = rows->step();; row = rows->step()) {
      if (!row) return tl::unexpected(row.error());
      if (!*row) break;
      if (!std::ranges::equal(rows->blob(2), value_hash(rows->text(0), rows->blob(1))))
        damaged.emplace_back(rows->text(0));
    }
  }
  for (const std::string& key : damaged) {
    s.damage.push_back(s.path.string() + ": the value of '" + key + "' is damaged; it was dropped");
    if (s.read_only) continue;
    auto drop = s.db->prepare("DELETE FROM meta WHERE key = ?");
    if (!drop) return tl::unexpected(drop.error());
    if (auto status = drop->bind(1, std::string_view(key)).run(); !status) return status;
  }
  return {};
}

/// A second content whose first was damaged is held alone, until others show the evidence again.
Status load_contested(StoreState& s) {
  using Signed = std::optional<Signature>;
  const auto contest_node = [&s](std::string_view, std::int64_t, ByteView item, const Signed& by) {
    auto node = decode_node(item);
    if (!node || !s.nodes.contains(node->id)) return false;
    node->signature = by;
    s.contest(*node);
    return true;
  };
  if (auto status = load_rows(s, "contested_node", contest_node); !status) return status;
  const auto contest_alignment = [&s](std::string_view, std::int64_t, ByteView item, const Signed& by) {
    auto alignment = decode_alignment(item);
    if (!alignment || !s.alignments.contains({alignment->computed_by, alignment->seq})) return false;
    alignment->signature = by;
    s.contest(*alignment);
    return true;
  };
  return load_rows(s, "contested_alignment", contest_alignment);
}

Status load_items(StoreState& s) {
  // A limit that was lowered since concerns what is to come.
  StoreConfig unlimited;
  unlimited.max_submap_bytes = 1u << 30;
  using Signed = std::optional<Signature>;
  const auto add_node = [&](std::string_view agent, std::int64_t seq, ByteView item, const Signed& by) {
    auto node = decode_node(item);
    if (!node || node->id.agent.str() != agent || node->id.seq != seq || !is_valid(*node, unlimited))
      return false;
    s.node_set.insert(node->id.agent, node->id.seq);
    if (node->submap_bytes == 0) s.submap_set.insert(node->id.agent, node->id.seq);
    s.node_prints.set(node->id, fingerprint(*node));
    node->signature = by;
    s.nodes.emplace(node->id, *node);
    return true;
  };
  if (auto status = load_rows(s, "node", add_node); !status) return status;
  const auto add_alignment = [&s](std::string_view agent, std::int64_t seq, ByteView item, const Signed& by) {
    auto alignment = decode_alignment(item);
    if (!alignment || alignment->computed_by.str() != agent || alignment->seq != seq || !is_valid(*alignment))
      return false;
    const AlignmentId id{alignment->computed_by, alignment->seq};
    s.alignment_set.insert(id.computed_by, id.seq);
    s.alignment_prints.set(name_of(id), fingerprint(*alignment));
    alignment->signature = by;
    s.alignments.emplace(id, *alignment);
    return true;
  };
  if (auto status = load_rows(s, "alignment", add_alignment); !status) return status;
  return load_contested(s);
}

const graph::Node* node_of_row(const StoreState& s, const Statement& row) {
  const auto agent = AgentId::parse(row.text(0));
  const auto seq = row.integer(1);
  if (!agent || seq < 0 || seq >= kEndOfSeqs) return nullptr;
  const auto node = s.nodes.find({*agent, static_cast<std::uint32_t>(seq)});
  return node == s.nodes.end() ? nullptr : &node->second;
}

Status load_submaps(StoreState& s) {
  std::vector<NodeId> damaged;
  {
    // A reader needs no submap before it loads one, and opens faster without reading them all.
    auto rows =
        s.db->prepare(s.read_only ? "SELECT agent, seq FROM submap" : "SELECT agent, seq, bytes FROM submap");
    if (!rows) return tl::unexpected(rows.error());
    for (auto row = rows->step();; row = rows->step()) {
      if (!row) return tl::unexpected(row.error());
      if (!*row) break;
      const graph::Node* node = node_of_row(s, *rows);
      if (!node) continue;
      if (s.read_only || content_hash(rows->blob(2)) == node->submap_hash) {
        s.submap_set.insert(node->id.agent, node->id.seq);
      } else {
        damaged.push_back(node->id);
      }
    }
  }
  for (const NodeId& id : damaged) {
    s.damage.push_back(s.path.string() + ": the submap of node " + to_string(id) +
                       " is damaged; it was dropped and is fetched from other robots");
    if (auto status = s.remove("submap", id); !status) return status;
  }
  return {};
}

Status load_chunk_names(StoreState& s) {
  auto rows = s.db->prepare("SELECT agent, seq, chunk FROM submap_chunk");
  if (!rows) return tl::unexpected(rows.error());
  for (auto row = rows->step();; row = rows->step()) {
    if (!row) return tl::unexpected(row.error());
    if (!*row) return {};
    const graph::Node* node = node_of_row(s, *rows);
    const auto chunk = rows->integer(2);
    if (!node || s.submap_set.contains(node->id.agent, node->id.seq) || chunk < 0 ||
        chunk >= chunk_count(*node))
      continue;
    PartialSubmap& held = s.partial(*node);
    if (!held.held[static_cast<std::size_t>(chunk)]) --held.missing;
    held.held[static_cast<std::size_t>(chunk)] = true;
  }
}

}  // namespace

Status load(StoreState& s) {
  for (auto* names : {&s.node_prints, &s.alignment_prints}) *names = {};
  for (auto* set : {&s.node_set, &s.alignment_set, &s.submap_set}) *set = {};
  s.nodes.clear();
  s.alignments.clear();
  s.contested_nodes.clear();
  s.contested_alignments.clear();
  s.partials.clear();
  if (auto status = load_values(s); !status) return status;
  if (auto status = load_items(s); !status) return status;
  if (auto status = load_submaps(s); !status) return status;
  return load_chunk_names(s);
}

}  // namespace fleetmap::store
