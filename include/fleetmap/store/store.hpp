#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/graph/alignment.hpp"
#include "fleetmap/graph/node.hpp"
#include "fleetmap/store/seq_set.hpp"
#include "fleetmap/store/store_config.hpp"

namespace fleetmap::store {

/// (computed_by, seq) of an alignment.
struct AlignmentId {
  AgentId computed_by;
  std::uint32_t seq = 0;
  auto operator<=>(const AlignmentId&) const = default;
};

/// The outcome of putting an item.
enum class Put : std::uint8_t {
  kAdded,     ///< committed: a kill -9 from now on does not lose it
  kKnown,     ///< held already, the same; nothing changed
  kConflict,  ///< another item is held under this name, which is contested from now on (Store)
  kInvalid    ///< breaks a rule of its type (not finite, too large, unknown node, wrong hash); refused and
              ///< counted
};

/// Counters of a store since it was opened.
struct StoreStats {
  std::uint64_t added = 0;
  std::uint64_t known = 0;
  std::uint64_t conflicts = 0;  ///< names that became contested, and own new items whose name was taken
  std::uint64_t invalid = 0;
  std::uint64_t bad_submaps = 0;  ///< complete downloads whose content hash was wrong; dropped
  std::uint64_t lost_submaps =
      0;  ///< submaps that were damaged on disk; dropped, so that they are fetched again
};

struct StoreState;

/// The agent's durable set of immutable items (nodes, alignments, encoded submaps), the chunks of submaps
/// under download, and named values of the agent (site origin, counters). One SQLite file in WAL mode.
///
/// Contested names: an honest maker uses each name once, so two contents under one name prove that one is
/// forged, or that the maker equivocates; the store cannot decide which. Such a name keeps both contents as
/// evidence, stays in node_set() or alignment_set(), and has no item. A name only moves from unknown to one
/// content to contested, in any order of arrival: a join-semilattice (CvRDT, Shapiro et al. 2011), so robots
/// that exchange their items end with the same set.
///
/// Signatures are stored with their items and do not count when contents are compared. The caller verifies an
/// item before it puts it.
///
/// Durability: a put is committed before the call returns, so a killed process loses nothing. Own items and
/// named values are also synced to the disk, because after a power cut the agent must not reuse a name that
/// it has announced. Items of other agents are synced by sync(), which therefore precedes every announcement
/// (Exchange::tick).
///
/// Nodes and alignments are held in memory as well; submaps stay on disk. One thread at a time. A Result that
/// fails means that the file failed (disk full, I/O error, corrupt); the set in memory is then unchanged.
class Store {
 public:
  /// Bytes of one piece of a download; the last of a submap may be shorter.
  static constexpr std::uint32_t kChunkBytes = 8192;
  /// Version of the file. A higher one needs a step in schema.cpp and a file in tests/store/versions.
  static constexpr std::int64_t kSchemaVersion = 6;

  /// Opens or creates the store of `self`. A store of schema version 3 or later is migrated to the present
  /// one. Reads the whole file: damaged rows and submaps are dropped, and a file with damaged pages is moved
  /// aside and replaced by a store of its sound items; damage() lists all of this. Fails, with the remedy,
  /// when the file is no store, is of a newer version, belongs to another agent, is open in another process
  /// for writing, or cannot be written.
  static Result<Store> open(const std::filesystem::path& path, const AgentId& self,
                            const StoreConfig& config = {});
  /// Opens any agent's store for reading, also while its agent runs, and where nothing can be written beside
  /// it (read-only media, folders of others), unless a log with content lies there. Puts fail.
  static Result<Store> open_read_only(const std::filesystem::path& path);

  Store(Store&&) noexcept;
  Store& operator=(Store&&) noexcept;
  ~Store();

  const AgentId& self() const;

  /// Not for own nodes: those come with their submap.
  Result<Put> put_node(const graph::Node& node);
  /// An own node and its submap, both or none. kInvalid unless the node's hash and size name `submap`.
  Result<Put> put_node_with_submap(const graph::Node& node, ByteView submap);
  Result<Put> put_alignment(const graph::Alignment& alignment);
  /// A whole submap of a held node. kInvalid when its size or hash is not the node's.
  Result<Put> put_submap(const NodeId& id, ByteView encoded);
  /// Puts bytes [chunk * kChunkBytes, ...) of a held node's submap; they survive a restart. The last missing
  /// chunk completes the submap or, if the hash is then wrong, drops all chunks and returns kInvalid.
  Result<Put> put_submap_chunk(const NodeId& id, std::uint32_t chunk, ByteView bytes);

  /// Completes a submap of which all chunks are held, though the disk had no room for the whole. kInvalid as
  /// from put_submap_chunk(), or when a chunk is missing.
  Result<Put> finish_download(const NodeId& id);

  /// Counts of resign().
  struct Resigned {
    std::size_t dropped_nodes = 0;       ///< contents
    std::size_t dropped_alignments = 0;  ///< contents
  };
  using SignNode = std::function<std::optional<Signature>(const graph::Node&)>;
  using SignAlignment = std::function<std::optional<Signature>(const graph::Alignment&)>;
  /// Stores for each content the signature that the functions return for it, and drops contents without one,
  /// with their submaps. A contested name of which one content is left has this as its item again. All or
  /// nothing on the disk. Pointers to items become invalid and revision() may fall, so this comes before any
  /// other use of the store.
  Result<Resigned> resign(const SignNode& node, const SignAlignment& alignment);

  /// This content is held under its name, be the name contested or not. Signatures are not compared.
  bool holds(const graph::Node& node) const;
  bool holds(const graph::Alignment& alignment) const;
  const graph::Node* node(const NodeId& id) const;  ///< null when not held
  const graph::Alignment* alignment(const AlignmentId& id) const;
  const std::map<NodeId, graph::Node>& nodes() const;
  const std::map<AlignmentId, graph::Alignment>& alignments() const;
  /// Both contents of each contested name.
  struct ContestedNode {
    const graph::Node* first = nullptr;  ///< the one held before
    const graph::Node* second = nullptr;
  };
  struct ContestedAlignment {
    const graph::Alignment* first = nullptr;
    const graph::Alignment* second = nullptr;
  };
  std::vector<ContestedNode> contested_nodes(const SeqRange& range) const;
  std::vector<ContestedAlignment> contested_alignments(const SeqRange& range) const;
  bool is_contested(const NodeId& id) const;
  /// Reads the submap of a contested own node, as far as it was held.
  Result<Bytes> contested_submap(const NodeId& id) const;
  /// Fingerprint of the contents held in `range`: the sum of those of the items, the same on every machine.
  std::uint32_t node_print(const SeqRange& range) const;
  std::uint32_t alignment_print(const SeqRange& range) const;
  /// Grows with each change of nodes() and alignments().
  std::uint64_t revision() const;
  /// Sentences about the damage that open() found and the place of the damaged file.
  const std::vector<std::string>& damage() const;
  /// The nodes held of `range`, in order.
  std::vector<const graph::Node*> nodes_from(const SeqRange& range) const;
  /// A submap of no bytes is held as soon as its node is.
  bool has_submap(const NodeId& id) const;
  /// Reads from disk and checks the hash. A damaged submap is dropped and counted, and the call fails.
  Result<Bytes> submap(const NodeId& id);
  /// Bytes [offset, offset + length) of a held submap, cut at its end; the hash is not checked.
  Result<Bytes> submap_part(const NodeId& id, std::uint32_t offset, std::uint32_t length) const;
  /// Chunks of a node's submap that are not held, in order; empty when all are or the node is unknown.
  std::vector<std::uint32_t> missing_chunks(const NodeId& id) const;
  /// Nodes whose submap is held in part.
  std::vector<NodeId> partial_submaps() const;

  const SeqSet& node_set() const;
  const SeqSet& alignment_set() const;
  const SeqSet& submap_set() const;
  /// Sequence number of the next own node and alignment of a session.
  std::uint32_t next_node_seq(std::uint16_t session) const;
  std::uint32_t next_alignment_seq(std::uint16_t session) const;

  /// All that was put survives a power cut from now on. Costs a disk sync if something was put since the last
  /// one, else nothing. Fails when the disk does, and nothing may then be promised to others: a sync that
  /// failed is never made up for by another one alone. The log is written again first; where it can no more
  /// be read as it was written, this and all puts of own items fail until the store is opened again.
  Status sync();

  Result<std::optional<Bytes>> meta(std::string_view key) const;
  Status set_meta(std::string_view key, ByteView value);

  const StoreStats& stats() const;
  const std::filesystem::path& path() const;

 private:
  explicit Store(std::unique_ptr<StoreState> state);
  std::unique_ptr<StoreState> state_;
};

}  // namespace fleetmap::store
