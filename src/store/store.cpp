#include "fleetmap/store/store.hpp"

#include <algorithm>
#include <utility>

#include "database.hpp"
#include "fleetmap/core/file_lock.hpp"
#include "item_codec.hpp"
#include "item_puts.hpp"
#include "left_log.hpp"
#include "resign.hpp"
#include "row_hash.hpp"
#include "salvage.hpp"
#include "schema.hpp"
#include "store_load.hpp"
#include "store_state.hpp"
#include "submap_rows.hpp"

namespace fleetmap::store {
namespace {

SeqRange items_of(const AgentId& agent, std::uint16_t session) {
  return {agent, first_seq(session), first_seq(session) + kItemsPerSession};
}

/// Returns whether the content is held under its name, contested or not.
template <class Id, class Item>
bool holds(const std::map<Id, Item>& items, const std::map<Id, Contested<Item>>& contested, const Id& id,
           const Item& item) {
  const Bytes content = encode(item);
  if (const auto held = items.find(id); held != items.end()) return encode(held->second) == content;
  const auto names = contested.find(id);
  return names != contested.end() &&
         (encode(names->second.first.mapped()) == content || encode(names->second.second) == content);
}

}  // namespace

Store::Store(std::unique_ptr<StoreState> state) : state_(std::move(state)) {}
Store::Store(Store&&) noexcept = default;
Store& Store::operator=(Store&&) noexcept = default;
Store::~Store() = default;

Result<Store> Store::open(const std::filesystem::path& path, const AgentId& self, const StoreConfig& config) {
  if (auto status = config.validate(); !status) return tl::unexpected(status.error());
  if (self.empty()) return failure(path.string() + ": a store needs the id of its agent");
  auto state = std::make_unique<StoreState>();
  state->path = path;
  state->self = self;
  state->config = config;
  auto lock = FileLock::try_lock(path.string() + ".lock", FileLock::Kind::kExclusive);
  if (!lock) return tl::unexpected(lock.error());
  if (!*lock) return failure(path.string() + ": another process is writing this store; stop it first");
  state->lock = std::move(**lock);
  if (auto status = finish_salvage(path); !status) return tl::unexpected(status.error());
  if (auto status = write_left_log_again(path, config.file_system); !status)
    return tl::unexpected(status.error());
  const auto damage = find_damage(path, config.file_system);
  if (!damage) return tl::unexpected(damage.error());
  if (*damage) {
    auto salvaged = salvage(path, self, config, **damage);
    if (!salvaged) return tl::unexpected(salvaged.error());
    state->damage.push_back(std::move(*salvaged));
  }
  // The log of a program that was killed, perhaps after a sync that failed, was moved into the file by
  // find_damage(), unless that failed.
  std::error_code none;
  const auto log_bytes = std::filesystem::file_size(path.string() + "-wal", none);
  const bool left_log = !none && log_bytes > 0;
  auto db = Database::open(path, false, config.file_system);
  if (!db) return tl::unexpected(db.error());
  state->db.emplace(std::move(*db));
  if (auto status = prepare_schema(*state->db, path, self); !status) return tl::unexpected(status.error());
  if (auto status = state->db->execute("PRAGMA journal_mode = WAL"); !status)
    return tl::unexpected(status.error());
  if (auto status = state->db->execute("PRAGMA synchronous = NORMAL"); !status)
    return tl::unexpected(status.error());
  if (left_log) state->db->mark_left_log();
  if (auto status = load(*state); !status) return tl::unexpected(status.error());
  Store store(std::move(state));
  // The process may have died between the last chunk of a download and its completion.
  for (const NodeId& id : store.partial_submaps()) {
    if (!store.missing_chunks(id).empty()) continue;
    if (const auto put = store.finish_download(id); !put) return tl::unexpected(put.error());
  }
  return store;
}

Result<Store> Store::open_read_only(const std::filesystem::path& path) {
  auto state = std::make_unique<StoreState>();
  state->path = path;
  state->read_only = true;
  auto db = Database::open(path, true);
  if (!db) return tl::unexpected(db.error());
  state->db.emplace(std::move(*db));
  const auto owner = check_schema(*state->db, path);
  if (!owner) return tl::unexpected(owner.error());
  state->self = *owner;
  if (auto status = load(*state); !status) return tl::unexpected(status.error());
  return Store(std::move(state));
}

const AgentId& Store::self() const { return state_->self; }

Result<Put> Store::put_node(const graph::Node& node) { return store::put_node(*state_, node, nullptr); }
Result<Put> Store::put_node_with_submap(const graph::Node& node, ByteView submap) {
  return store::put_node(*state_, node, &submap);
}
Result<Put> Store::put_alignment(const graph::Alignment& alignment) {
  return store::put_alignment(*state_, alignment);
}
Result<Put> Store::put_submap(const NodeId& id, ByteView encoded) {
  return store::put_submap(*state_, id, encoded);
}
Result<Put> Store::put_submap_chunk(const NodeId& id, std::uint32_t chunk, ByteView bytes) {
  return store::put_submap_chunk(*state_, id, chunk, bytes);
}
Result<Put> Store::finish_download(const NodeId& id) { return store::finish_download(*state_, id); }
Result<Store::Resigned> Store::resign(const SignNode& node, const SignAlignment& alignment) {
  return store::resign(*state_, node, alignment);
}

bool Store::holds(const graph::Node& node) const {
  return store::holds(state_->nodes, state_->contested_nodes, node.id, node);
}

bool Store::holds(const graph::Alignment& alignment) const {
  return store::holds(state_->alignments, state_->contested_alignments,
                      AlignmentId{alignment.computed_by, alignment.seq}, alignment);
}

const graph::Node* Store::node(const NodeId& id) const {
  const auto it = state_->nodes.find(id);
  return it == state_->nodes.end() ? nullptr : &it->second;
}

const graph::Alignment* Store::alignment(const AlignmentId& id) const {
  const auto it = state_->alignments.find(id);
  return it == state_->alignments.end() ? nullptr : &it->second;
}

const std::map<NodeId, graph::Node>& Store::nodes() const { return state_->nodes; }
const std::map<AlignmentId, graph::Alignment>& Store::alignments() const { return state_->alignments; }

std::vector<Store::ContestedNode> Store::contested_nodes(const SeqRange& range) const {
  std::vector<ContestedNode> found;
  const auto& names = state_->contested_nodes;
  for (auto it = names.lower_bound({range.agent, range.first});
       it != names.end() && it->first.agent == range.agent && it->first.seq < range.end; ++it) {
    found.push_back({&it->second.first.mapped(), &it->second.second});
  }
  return found;
}

std::vector<Store::ContestedAlignment> Store::contested_alignments(const SeqRange& range) const {
  std::vector<ContestedAlignment> found;
  const auto& names = state_->contested_alignments;
  for (auto it = names.lower_bound({range.agent, range.first});
       it != names.end() && it->first.computed_by == range.agent && it->first.seq < range.end; ++it) {
    found.push_back({&it->second.first.mapped(), &it->second.second});
  }
  return found;
}

bool Store::is_contested(const NodeId& id) const { return state_->contested_nodes.contains(id); }

std::uint32_t Store::node_print(const SeqRange& range) const { return state_->node_prints.of(range); }
std::uint32_t Store::alignment_print(const SeqRange& range) const {
  return state_->alignment_prints.of(range);
}

std::uint64_t Store::revision() const {
  const StoreState& s = *state_;
  return s.nodes.size() + s.alignments.size() +
         2 * (s.contested_nodes.size() + s.contested_alignments.size());
}

const std::vector<std::string>& Store::damage() const { return state_->damage; }

std::vector<const graph::Node*> Store::nodes_from(const SeqRange& range) const {
  std::vector<const graph::Node*> found;
  const auto& nodes = state_->nodes;
  for (auto it = nodes.lower_bound({range.agent, range.first});
       it != nodes.end() && it->first.agent == range.agent && it->first.seq < range.end; ++it) {
    found.push_back(&it->second);
  }
  return found;
}

bool Store::has_submap(const NodeId& id) const { return state_->has_submap(id); }
Result<Bytes> Store::contested_submap(const NodeId& id) const { return store::contested_submap(*state_, id); }
Result<Bytes> Store::submap(const NodeId& id) { return store::submap(*state_, id); }
Result<Bytes> Store::submap_part(const NodeId& id, std::uint32_t offset, std::uint32_t length) const {
  return store::submap_part(*state_, id, offset, length);
}
std::vector<std::uint32_t> Store::missing_chunks(const NodeId& id) const {
  return store::missing_chunks(*state_, id);
}

std::vector<NodeId> Store::partial_submaps() const {
  std::vector<NodeId> ids;
  for (const auto& [id, partial] : state_->partials) ids.push_back(id);
  return ids;
}

const SeqSet& Store::node_set() const { return state_->node_set; }
const SeqSet& Store::alignment_set() const { return state_->alignment_set; }
const SeqSet& Store::submap_set() const { return state_->submap_set; }
std::uint32_t Store::next_node_seq(std::uint16_t session) const {
  return state_->node_set.end_within(items_of(state_->self, session));
}
std::uint32_t Store::next_alignment_seq(std::uint16_t session) const {
  return state_->alignment_set.end_within(items_of(state_->self, session));
}

Status Store::sync() {
  StoreState& s = *state_;
  const std::int64_t changes = s.db->changes();
  if (!s.config.power_safe || s.read_only) return {};
  if (s.synced_changes == changes && !s.db->log_is_uncertain()) return {};
  if (auto status = s.db->sync_log(); !status) return status;
  s.synced_changes = changes;
  return {};
}

Result<std::optional<Bytes>> Store::meta(std::string_view key) const {
  auto rows = state_->db->prepare("SELECT value FROM meta WHERE key = ?");
  if (!rows) return tl::unexpected(rows.error());
  const auto row = rows->bind(1, key).step();
  if (!row) return tl::unexpected(row.error());
  if (!*row) return std::optional<Bytes>();
  const ByteView value = rows->blob(0);
  return std::optional<Bytes>(Bytes(value.begin(), value.end()));
}

Status Store::set_meta(std::string_view key, ByteView value) {
  if (key == kOwnerKey) return failure("store: the owner of a store cannot be changed");
  auto statement = state_->db->prepare("INSERT OR REPLACE INTO meta VALUES(?, ?, ?)");
  if (!statement) return tl::unexpected(statement.error());
  const ContentHash hash = value_hash(key, value);
  statement->bind(1, key).bind(2, value).bind(3, ByteView(hash));
  return state_->commit(true, [&] { return statement->run(); });
}

const StoreStats& Store::stats() const { return state_->stats; }
const std::filesystem::path& Store::path() const { return state_->path; }

}  // namespace fleetmap::store
