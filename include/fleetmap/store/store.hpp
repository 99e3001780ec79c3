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

namespace fleetmap::store {

/// (computed_by, seq) of an alignment.
struct AlignmentId {
  AgentId computed_by;
  std::uint32_t seq = 0;
  auto operator<=>(const AlignmentId&) const = default;
};

struct StoreConfig {
  std::uint32_t max_submap_bytes = 8u << 20;  ///< bytes, nodes that announce a larger submap are refused
  /// Own items and named values survive a power cut as soon as they are put (one disk sync each), and all
  /// else after Store::sync(). Without it SQLite syncs its checkpoints alone.
  bool power_safe = true;
  std::string file_system;  ///< name of the SQLite VFS that holds the file; empty: the system's own
  Status validate() const;
};

/// What became of an item that was put.
enum class Put : std::uint8_t {
  kAdded,     ///< committed: a kill -9 from now on does not lose it
  kKnown,     ///< held already, the same; nothing changed
  kConflict,  ///< another item is held under this name, which is contested from now on (Store)
  kInvalid    ///< breaks a rule of its type (not finite, too large, unknown node, wrong hash); refused and
              ///< counted
};

struct StoreStats {
  std::uint64_t added = 0;
  std::uint64_t known = 0;
  std::uint64_t conflicts = 0;  ///< names that became contested, and own new items whose name was taken
  std::uint64_t invalid = 0;
  std::uint64_t bad_submaps = 0;  ///< complete downloads whose content hash was wrong; dropped
  std::uint64_t lost_submaps =
      0;  ///< submaps that were damaged on disk; dropped, so that they are fetched again
};

/// The agent's durable set of immutable items: nodes, alignments, encoded submaps; also submaps that are half
/// downloaded, and named values of the agent (site origin, counters). One SQLite file in WAL mode.
///
/// Contested names: an honest maker gives each name once, so two contents under one name prove that one is
/// forged (or that the maker equivocates), and nothing here tells which. Such a name keeps both contents as
/// the evidence, stays in node_set() or alignment_set(), and has no item. A name therefore only moves up from
/// unknown to one content to contested, whatever comes first: a join-semilattice (CvRDT, Shapiro et al.
/// 2011), so robots that exchange what they hold end with the same set.
///
/// Signatures are stored with their items and are no part of what makes two contents equal. Whoever puts an
/// item has verified it.
///
/// Durability: what was put is committed before the call returns, so killing the process loses nothing. Own
/// items and named values are also synced to the disk: after a power cut the agent must not give a second
/// item a name that it has already told the others. Items of others are not; a power cut may lose those that
/// came since the last sync(), which therefore comes before others are told what is held (Exchange::tick).
///
/// Nodes and alignments are held in memory as well; submaps stay on disk. One thread at a time. A Result that
/// fails means that the file failed (disk full, I/O error, corrupt); the set in memory is then unchanged.
class Store {
 public:
  /// Bytes of one piece of a download; the last of a submap may be shorter.
  static constexpr std::uint32_t kChunkBytes = 8192;
  /// Of the file. Whoever raises it adds a step to schema.cpp and a file to tests/store/versions.
  static constexpr std::int64_t kSchemaVersion = 6;

  /// Opens or makes the store of `self`. A store of schema version 3 or later is brought to the present one.
  /// Reads the whole file: rows and submaps that are damaged are dropped, and a file whose pages are is moved
  /// aside and replaced by a store of what is whole in it; damage() says so. Fails with what to do when the
  /// file is no store, is of a newer version, belongs to another agent, is open in another process for
  /// writing, or cannot be written.
  static Result<Store> open(const std::filesystem::path& path, const AgentId& self,
                            const StoreConfig& config = {});
  /// Opens any agent's store to look at it; a running agent does not mind. Puts fail.
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
  /// Bytes [chunk * kChunkBytes, ...) of a held node's submap; they survive a restart. The last missing one
  /// completes the submap, or, if its hash is then wrong, drops all chunks and gives kInvalid.
  Result<Put> put_submap_chunk(const NodeId& id, std::uint32_t chunk, ByteView bytes);

  /// Completes a submap of which all chunks are held, though the disk had no room for the whole. kInvalid as
  /// from put_submap_chunk(), or when a chunk is missing.
  Result<Put> finish_download(const NodeId& id);

  /// What resign() did.
  struct Resigned {
    std::size_t dropped_nodes = 0;       ///< contents
    std::size_t dropped_alignments = 0;  ///< contents
  };
  using SignNode = std::function<std::optional<Signature>(const graph::Node&)>;
  using SignAlignment = std::function<std::optional<Signature>(const graph::Alignment&)>;
  /// Gives each content the signature that the functions return for it and drops those for which they return
  /// none, with their submaps. A contested name of which one content is left has this as its item again. All
  /// or nothing on the disk. Pointers to items become invalid, and revision() may fall: to be called before
  /// anything else uses the store.
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
  /// What open() found damaged and where the damaged file lies, a sentence each.
  const std::vector<std::string>& damage() const;
  /// The nodes held of `range`, in order.
  std::vector<const graph::Node*> nodes_from(const SeqRange& range) const;
  /// A submap of no bytes is held as soon as its node is.
  bool has_submap(const NodeId& id) const;
  /// Reads from disk and checks the hash. A damaged submap is dropped, counted and gives an Error.
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
  struct State;
  explicit Store(std::unique_ptr<State> state);
  Result<Put> insert_node(const graph::Node& node, const ByteView* submap);
  Status contest_node(const graph::Node& node, ByteView item);
  Status contest_alignment(const graph::Alignment& alignment, ByteView item);
  Status complete_submap(const graph::Node& node, ByteView encoded);
  std::unique_ptr<State> state_;
};

}  // namespace fleetmap::store
