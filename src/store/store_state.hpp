#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "database.hpp"
#include "fingerprint_sums.hpp"
#include "fleetmap/core/file_lock.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::store {

/// Records which chunks of one submap are on disk.
struct PartialSubmap {
  std::vector<bool> held;
  std::uint32_t missing = 0;
};

/// Both contents of a name. The first keeps its address, so that pointers to it stay valid.
template <class Item>
struct Contested {
  typename std::map<std::conditional_t<std::is_same_v<Item, graph::Node>, NodeId, AlignmentId>,
                    Item>::node_type first;
  Item second;
};

inline NodeId name_of(const AlignmentId& id) { return {id.computed_by, id.seq}; }
inline ByteView bytes_of(const std::optional<Signature>& signature) {
  return signature ? ByteView(*signature) : ByteView();
}
std::uint32_t chunk_count(const graph::Node& node);
std::uint32_t chunk_size(const graph::Node& node, std::uint32_t chunk);

/// The open file of a Store and its copy in memory. The functions of store_load.hpp, item_puts.hpp,
/// submap_rows.hpp and resign.hpp work on it.
struct StoreState {
  std::filesystem::path path;
  AgentId self;
  StoreConfig config;
  FileLock lock;
  std::optional<Database> db;
  bool read_only = false;
  std::map<NodeId, graph::Node> nodes;
  std::map<AlignmentId, graph::Alignment> alignments;
  std::map<NodeId, Contested<graph::Node>> contested_nodes;
  std::map<AlignmentId, Contested<graph::Alignment>> contested_alignments;
  FingerprintSums node_prints;
  FingerprintSums alignment_prints;  ///< by (computed_by, seq)
  std::vector<std::string> damage;
  SeqSet node_set;
  SeqSet alignment_set;
  SeqSet submap_set;
  std::map<NodeId, PartialSubmap> partials;
  /// Database::changes() at the last sync. Empty before the first, because a killed process may have left
  /// commits that were not synced.
  std::optional<std::int64_t> synced_changes;
  StoreStats stats;

  const graph::Node* node(const NodeId& id) const;  ///< null when not held
  bool has_submap(const NodeId& id) const { return submap_set.contains(id.agent, id.seq); }
  PartialSubmap& partial(const graph::Node& node);
  /// Moves the name of a held item to the contested ones.
  void contest(const graph::Node& second);
  void contest(const graph::Alignment& second);
  /// Runs one statement whose first two parameters are agent and seq.
  Status run(std::string_view sql, const AgentId& agent, std::uint32_t seq, const ByteView* blob = nullptr);
  /// Puts an encoded item, its signature and the hash of both into `table`.
  Status insert(const char* table, const NodeId& name, ByteView item,
                const std::optional<Signature>& signature);
  Status remove(const char* table, const NodeId& name);
  /// Removes the submap of a node and its chunks.
  Status remove_submap(const NodeId& name);
  /// Runs `write`, which commits. With `durable` the commit survives a power cut, or nothing is written.
  template <class Write>
  Status commit(bool durable, const Write& write);
  Put count(Put put);
};

template <class Write>
Status StoreState::commit(bool durable, const Write& write) {
  if (!durable || !config.power_safe) return write();
  // Frames behind a hole in the log are lost with it.
  if (db->log_is_uncertain()) {
    if (auto status = db->sync_log(); !status) return status;
  }
  if (auto status = db->execute("PRAGMA synchronous = FULL"); !status) return status;
  const Status written = write();
  if (auto status = db->execute("PRAGMA synchronous = NORMAL"); !status) return status;
  if (written) {
    db->note_log_synced();
    synced_changes = db->changes();
  }
  return written;
}

}  // namespace fleetmap::store
