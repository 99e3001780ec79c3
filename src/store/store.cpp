#include "fleetmap/store/store.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

#include "database.hpp"
#include "fingerprint.hpp"
#include "fingerprint_sums.hpp"
#include "fleetmap/core/file_lock.hpp"
#include "item_codec.hpp"
#include "left_log.hpp"
#include "row_hash.hpp"
#include "salvage.hpp"
#include "schema.hpp"

namespace fleetmap::store {
namespace {

/// Which chunks of one submap are on disk.
struct Partial {
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

NodeId name_of(const AlignmentId& id) { return {id.computed_by, id.seq}; }

ByteView bytes_of(const std::optional<Signature>& signature) {
  return signature ? ByteView(*signature) : ByteView();
}

std::uint32_t chunk_count(const graph::Node& node) {
  return node.submap_bytes / Store::kChunkBytes + (node.submap_bytes % Store::kChunkBytes != 0);
}

std::uint32_t chunk_size(const graph::Node& node, std::uint32_t chunk) {
  return std::min(Store::kChunkBytes, node.submap_bytes - chunk * Store::kChunkBytes);
}

/// Symmetric, without negative eigenvalues, and of a size that a place on Earth can have.
bool is_covariance(const Matrix6d& C) {
  constexpr double kMost = 1e15;  // m^2 or rad^2
  return C.allFinite() && C.cwiseAbs().maxCoeff() <= kMost && C == C.transpose() && C.ldlt().isPositive();
}

/// A rotation, to rounding, and a distance.
bool is_pose(const Pose& T) {
  constexpr double kMost = 1e7;  // m
  return all_finite(T) && T.translation().cwiseAbs().maxCoeff() <= kMost &&
         (T.linear() * T.linear().transpose()).isIdentity(1e-6);
}

bool valid(const graph::AlignmentMode& mode) {
  const auto share = [](double value) { return value >= 0.0 && value <= 1.0; };
  return is_pose(mode.T_i_j) && is_covariance(mode.covariance) && mode.rmse >= 0.0 &&
         std::isfinite(mode.rmse) && share(mode.inlier_fraction) && share(mode.score);
}

bool valid(const GlobalPose& G) {
  return is_valid(G.position) && G.q_enu_base.coeffs().allFinite() && G.covariance.allFinite();
}

bool valid(const graph::Node& node, const StoreConfig& config) {
  return !node.id.agent.empty() && node.id.seq < kEndOfSeqs && (!node.G || valid(*node.G)) &&
         node.up_in_base.allFinite() && node.descriptor.size() <= graph::Node::kMaxDescriptorBytes &&
         is_pose(node.T_odom_base) && is_covariance(node.odom_covariance) &&
         node.submap_bytes <= config.max_submap_bytes;
}

bool valid(const graph::Alignment& a) {
  return !a.computed_by.empty() && !a.i.agent.empty() && !a.j.agent.empty() && a.i != a.j &&
         a.seq < kEndOfSeqs && a.i.seq < kEndOfSeqs && a.j.seq < kEndOfSeqs && !a.modes.empty() &&
         a.modes.size() <= graph::Alignment::kMaxModes &&
         std::ranges::all_of(a.modes, [](const graph::AlignmentMode& mode) { return valid(mode); });
}

SeqRange items_of(const AgentId& agent, std::uint16_t session) {
  return {agent, first_seq(session), first_seq(session) + kItemsPerSession};
}

}  // namespace

Status StoreConfig::validate() const {
  if (max_submap_bytes == 0 || max_submap_bytes > (1u << 30)) {
    return failure("store.max_submap_bytes must be in 1 .. 2^30");
  }
  return {};
}

struct Store::State {
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
  std::map<NodeId, Partial> partials;
  /// Database::changes() at the last sync; none yet: a process that was killed leaves what was not synced.
  std::optional<std::int64_t> synced_changes;
  StoreStats stats;

  Status load();
  Status load_values();
  Status load_items();
  Status load_contested();
  /// Gives (agent, seq, item, signature) of each row to `use`; those whose hash differs or that it refuses
  /// are dropped.
  template <class Use>
  Status load_rows(const char* table, const Use& use);
  /// Moves the name of a held item to the contested ones.
  void contest(const graph::Node& second);
  void contest(const graph::Alignment& second);
  Status load_submaps();
  Status load_chunk_names();
  /// The held node that the first two columns name; null when there is none.
  const graph::Node* node_of_row(const Statement& row) const;
  Partial& partial(const graph::Node& node);
  /// Runs one statement whose first two parameters are agent and seq.
  Status run(std::string_view sql, const AgentId& agent, std::uint32_t seq, const ByteView* blob = nullptr);
  /// Puts an encoded item, its signature and the hash of both into `table`.
  Status insert(const char* table, const NodeId& name, ByteView item,
                const std::optional<Signature>& signature);
  Status remove(const char* table, const NodeId& name);
  /// The content is held under its name, be the name contested or not.
  template <class Id, class Item>
  static bool holds(const std::map<Id, Item>& items, const std::map<Id, Contested<Item>>& contested,
                    const Id& id, const Item& item);
  struct Tables {
    const char* items;
    const char* contested;
  };
  /// Writes the contents of one name that `sign` signs, counts the others, and returns whether the first
  /// stays.
  template <class Item, class Sign>
  Result<bool> resign_name(const Tables& tables, const NodeId& name, const Item& first, const Item* second,
                           const Sign& sign, std::size_t& dropped);
  Status resign_nodes(const SignNode& sign, std::size_t& dropped);
  Status resign_alignments(const SignAlignment& sign, std::size_t& dropped);
  /// Removes the submap of a node, and what there is of one.
  Status remove_submap(const NodeId& name);
  /// Runs `write`, which commits. What it wrote survives a power cut if `durable`, or nothing is written.
  template <class Write>
  Status commit(bool durable, const Write& write);
  Put count(Put put);
};

Put Store::State::count(Put put) {
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

Status Store::State::run(std::string_view sql, const AgentId& agent, std::uint32_t seq,
                         const ByteView* blob) {
  auto statement = db->prepare(sql);
  if (!statement) return tl::unexpected(statement.error());
  statement->bind(1, agent.str()).bind(2, std::int64_t{seq});
  if (blob) statement->bind(3, *blob);
  return statement->run();
}

Status Store::State::insert(const char* table, const NodeId& name, ByteView item,
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

Status Store::State::remove(const char* table, const NodeId& name) {
  return run("DELETE FROM " + std::string(table) + " WHERE agent = ? AND seq = ?", name.agent, name.seq);
}

Status Store::State::remove_submap(const NodeId& name) {
  if (auto status = remove("submap", name); !status) return status;
  return remove("submap_chunk", name);
}

template <class Write>
Status Store::State::commit(bool durable, const Write& write) {
  if (!durable || !config.power_safe) return write();
  // Frames behind a hole in the log are lost with it.
  if (db->log_is_doubtful()) {
    if (auto status = db->sync_log(); !status) return status;
  }
  if (auto status = db->execute("PRAGMA synchronous = FULL"); !status) return status;
  const Status written = write();
  if (auto status = db->execute("PRAGMA synchronous = NORMAL"); !status) return status;
  if (written) {
    db->note_log_synced();  // as a whole
    synced_changes = db->changes();
  }
  return written;
}

template <class Use>
Status Store::State::load_rows(const char* table, const Use& use) {
  struct Name {
    std::string agent;
    std::int64_t seq;
  };
  std::vector<Name> damaged;
  {
    auto rows = db->prepare("SELECT agent, seq, item, hash, signature FROM " + std::string(table));
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
    damage.push_back(path.string() + ": the row of " + table + " " + name.agent + "/" +
                     std::to_string(name.seq) +
                     " is damaged; it was dropped and is fetched from other robots");
    if (read_only) continue;
    auto drop = db->prepare("DELETE FROM " + std::string(table) + " WHERE agent = ? AND seq = ?");
    if (!drop) return tl::unexpected(drop.error());
    if (auto status = drop->bind(1, std::string_view(name.agent)).bind(2, name.seq).run(); !status)
      return status;
  }
  return {};
}

Status Store::State::load_values() {
  std::vector<std::string> damaged;
  {
    auto rows = db->prepare("SELECT key, value, hash FROM meta");
    if (!rows) return tl::unexpected(rows.error());
    for (auto row = rows->step();; row = rows->step()) {
      if (!row) return tl::unexpected(row.error());
      if (!*row) break;
      if (!std::ranges::equal(rows->blob(2), value_hash(rows->text(0), rows->blob(1))))
        damaged.emplace_back(rows->text(0));
    }
  }
  for (const std::string& key : damaged) {
    damage.push_back(path.string() + ": the value of '" + key + "' is damaged; it was dropped");
    if (read_only) continue;
    auto drop = db->prepare("DELETE FROM meta WHERE key = ?");
    if (!drop) return tl::unexpected(drop.error());
    if (auto status = drop->bind(1, std::string_view(key)).run(); !status) return status;
  }
  return {};
}

Status Store::State::load_items() {
  // A limit that was lowered since concerns what is to come.
  StoreConfig unlimited;
  unlimited.max_submap_bytes = 1u << 30;
  using Signed = std::optional<Signature>;
  const auto add_node = [&](std::string_view agent, std::int64_t seq, ByteView item, const Signed& by) {
    auto node = decode_node(item);
    if (!node || node->id.agent.str() != agent || node->id.seq != seq || !valid(*node, unlimited))
      return false;
    node_set.insert(node->id.agent, node->id.seq);
    if (node->submap_bytes == 0) submap_set.insert(node->id.agent, node->id.seq);
    node_prints.set(node->id, fingerprint(*node));
    node->signature = by;
    nodes.emplace(node->id, *node);
    return true;
  };
  if (auto status = load_rows("node", add_node); !status) return status;
  const auto add_alignment = [this](std::string_view agent, std::int64_t seq, ByteView item,
                                    const Signed& by) {
    auto alignment = decode_alignment(item);
    if (!alignment || alignment->computed_by.str() != agent || alignment->seq != seq || !valid(*alignment))
      return false;
    const AlignmentId id{alignment->computed_by, alignment->seq};
    alignment_set.insert(id.computed_by, id.seq);
    alignment_prints.set(name_of(id), fingerprint(*alignment));
    alignment->signature = by;
    alignments.emplace(id, *alignment);
    return true;
  };
  if (auto status = load_rows("alignment", add_alignment); !status) return status;
  return load_contested();
}

/// A second content whose first was damaged is held alone, until others show the evidence again.
Status Store::State::load_contested() {
  using Signed = std::optional<Signature>;
  const auto contest_node = [this](std::string_view, std::int64_t, ByteView item, const Signed& by) {
    auto node = decode_node(item);
    if (!node || !nodes.contains(node->id)) return false;
    node->signature = by;
    contest(*node);
    return true;
  };
  if (auto status = load_rows("contested_node", contest_node); !status) return status;
  const auto contest_alignment = [this](std::string_view, std::int64_t, ByteView item, const Signed& by) {
    auto alignment = decode_alignment(item);
    if (!alignment || !alignments.contains({alignment->computed_by, alignment->seq})) return false;
    alignment->signature = by;
    contest(*alignment);
    return true;
  };
  return load_rows("contested_alignment", contest_alignment);
}

void Store::State::contest(const graph::Node& second) {
  contested_nodes.emplace(second.id, Contested<graph::Node>{nodes.extract(second.id), second});
  node_prints.set(second.id, fingerprint_of_contested(second.id));
  submap_set.erase(second.id.agent, second.id.seq);
  partials.erase(second.id);
}

void Store::State::contest(const graph::Alignment& second) {
  const AlignmentId id{second.computed_by, second.seq};
  contested_alignments.emplace(id, Contested<graph::Alignment>{alignments.extract(id), second});
  alignment_prints.set(name_of(id), fingerprint_of_contested(name_of(id)));
}

Status Store::State::load_submaps() {
  std::vector<NodeId> damaged;
  {
    // Whoever only looks at the store need not read all of it.
    auto rows =
        db->prepare(read_only ? "SELECT agent, seq FROM submap" : "SELECT agent, seq, bytes FROM submap");
    if (!rows) return tl::unexpected(rows.error());
    for (auto row = rows->step();; row = rows->step()) {
      if (!row) return tl::unexpected(row.error());
      if (!*row) break;
      const graph::Node* node = node_of_row(*rows);
      if (!node) continue;
      if (read_only || content_hash(rows->blob(2)) == node->submap_hash) {
        submap_set.insert(node->id.agent, node->id.seq);
      } else {
        damaged.push_back(node->id);
      }
    }
  }
  for (const NodeId& id : damaged) {
    damage.push_back(path.string() + ": the submap of node " + to_string(id) +
                     " is damaged; it was dropped and is fetched from other robots");
    if (auto status = remove("submap", id); !status) return status;
  }
  return {};
}

Status Store::State::load_chunk_names() {
  auto rows = db->prepare("SELECT agent, seq, chunk FROM submap_chunk");
  if (!rows) return tl::unexpected(rows.error());
  for (auto row = rows->step();; row = rows->step()) {
    if (!row) return tl::unexpected(row.error());
    if (!*row) return {};
    const graph::Node* node = node_of_row(*rows);
    const auto chunk = rows->integer(2);
    if (!node || submap_set.contains(node->id.agent, node->id.seq) || chunk < 0 ||
        chunk >= chunk_count(*node))
      continue;
    Partial& held = partial(*node);
    if (!held.held[static_cast<std::size_t>(chunk)]) --held.missing;
    held.held[static_cast<std::size_t>(chunk)] = true;
  }
}

const graph::Node* Store::State::node_of_row(const Statement& row) const {
  const auto agent = AgentId::parse(row.text(0));
  const auto seq = row.integer(1);
  if (!agent || seq < 0 || seq >= kEndOfSeqs) return nullptr;
  const auto node = nodes.find({*agent, static_cast<std::uint32_t>(seq)});
  return node == nodes.end() ? nullptr : &node->second;
}

Status Store::State::load() {
  for (auto* names : {&node_prints, &alignment_prints}) *names = {};
  for (auto* set : {&node_set, &alignment_set, &submap_set}) *set = {};
  nodes.clear();
  alignments.clear();
  contested_nodes.clear();
  contested_alignments.clear();
  partials.clear();
  if (auto status = load_values(); !status) return status;
  if (auto status = load_items(); !status) return status;
  if (auto status = load_submaps(); !status) return status;
  return load_chunk_names();
}

Partial& Store::State::partial(const graph::Node& node) {
  const auto [it, fresh] = partials.try_emplace(node.id);
  if (fresh) {
    it->second.missing = chunk_count(node);
    it->second.held.assign(it->second.missing, false);
  }
  return it->second;
}

Store::Store(std::unique_ptr<State> state) : state_(std::move(state)) {}
Store::Store(Store&&) noexcept = default;
Store& Store::operator=(Store&&) noexcept = default;
Store::~Store() = default;

Result<Store> Store::open(const std::filesystem::path& path, const AgentId& self, const StoreConfig& config) {
  if (auto status = config.validate(); !status) return tl::unexpected(status.error());
  if (self.empty()) return failure(path.string() + ": a store needs the id of its agent");
  auto state = std::make_unique<State>();
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
  if (left_log) state->db->doubt_left_log();
  if (auto status = state->load(); !status) return tl::unexpected(status.error());
  Store store(std::move(state));
  // The process may have died between the last chunk of a download and its completion.
  for (const NodeId& id : store.partial_submaps()) {
    if (!store.missing_chunks(id).empty()) continue;
    if (const auto put = store.finish_download(id); !put) return tl::unexpected(put.error());
  }
  return store;
}

Result<Store> Store::open_read_only(const std::filesystem::path& path) {
  auto state = std::make_unique<State>();
  state->path = path;
  state->read_only = true;
  auto db = Database::open(path, true);
  if (!db) return tl::unexpected(db.error());
  state->db.emplace(std::move(*db));
  const auto owner = check_schema(*state->db, path);
  if (!owner) return tl::unexpected(owner.error());
  state->self = *owner;
  if (auto status = state->load(); !status) return tl::unexpected(status.error());
  return Store(std::move(state));
}

const AgentId& Store::self() const { return state_->self; }

Result<Put> Store::insert_node(const graph::Node& node, const ByteView* submap) {
  State& s = *state_;
  const bool submap_fits =
      !submap || (submap->size() == node.submap_bytes && content_hash(*submap) == node.submap_hash);
  if (!valid(node, s.config) || !submap_fits) return s.count(Put::kInvalid);
  const Bytes item = encode(node);
  if (s.contested_nodes.contains(node.id)) return s.count(submap ? Put::kConflict : Put::kKnown);
  if (const auto held = s.nodes.find(node.id); held != s.nodes.end()) {
    if (encode(held->second) == item) return s.count(Put::kKnown);
    // What this agent only now wants to name contests nothing: nobody has heard of it.
    if (submap) return s.count(Put::kConflict);
    if (auto status = contest_node(node, item); !status) return tl::unexpected(status.error());
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

Status Store::contest_node(const graph::Node& node, ByteView item) {
  State& s = *state_;
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

Status Store::contest_alignment(const graph::Alignment& alignment, ByteView item) {
  const NodeId name{alignment.computed_by, alignment.seq};
  if (auto status = state_->insert("contested_alignment", name, item, alignment.signature); !status)
    return status;
  state_->contest(alignment);
  return {};
}

Result<Put> Store::put_node(const graph::Node& node) { return insert_node(node, nullptr); }

Result<Put> Store::put_node_with_submap(const graph::Node& node, ByteView submap) {
  return insert_node(node, &submap);
}

Result<Put> Store::put_alignment(const graph::Alignment& alignment) {
  State& s = *state_;
  if (!valid(alignment)) return s.count(Put::kInvalid);
  const AlignmentId id{alignment.computed_by, alignment.seq};
  const Bytes item = encode(alignment);
  if (s.contested_alignments.contains(id)) return s.count(Put::kKnown);
  if (const auto held = s.alignments.find(id); held != s.alignments.end()) {
    if (encode(held->second) == item) return s.count(Put::kKnown);
    if (auto status = contest_alignment(alignment, item); !status) return tl::unexpected(status.error());
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

Status Store::complete_submap(const graph::Node& node, ByteView encoded) {
  State& s = *state_;
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

Result<Put> Store::put_submap(const NodeId& id, ByteView encoded) {
  State& s = *state_;
  const graph::Node* held = node(id);
  if (!held || encoded.size() != held->submap_bytes || content_hash(encoded) != held->submap_hash) {
    return s.count(Put::kInvalid);
  }
  if (has_submap(id)) return s.count(Put::kKnown);
  if (auto status = complete_submap(*held, encoded); !status) return tl::unexpected(status.error());
  return s.count(Put::kAdded);
}

Result<Put> Store::put_submap_chunk(const NodeId& id, std::uint32_t chunk, ByteView bytes) {
  State& s = *state_;
  const graph::Node* held = node(id);
  if (!held || chunk >= chunk_count(*held) || bytes.size() != chunk_size(*held, chunk))
    return s.count(Put::kInvalid);
  if (has_submap(id)) return s.count(Put::kKnown);
  if (const auto it = s.partials.find(id); it != s.partials.end() && it->second.held[chunk]) {
    return s.count(Put::kKnown);
  }
  auto insert = s.db->prepare("INSERT OR REPLACE INTO submap_chunk VALUES(?, ?, ?, ?)");
  if (!insert) return tl::unexpected(insert.error());
  insert->bind(1, id.agent.str()).bind(2, std::int64_t{id.seq}).bind(3, std::int64_t{chunk}).bind(4, bytes);
  if (auto status = insert->run(); !status) return tl::unexpected(status.error());
  Partial& partial = s.partial(*held);
  partial.held[chunk] = true;
  if (--partial.missing == 0) return finish_download(id);
  return s.count(Put::kAdded);
}

Result<Put> Store::finish_download(const NodeId& id) {
  State& s = *state_;
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
    if (auto status = complete_submap(node, encoded); !status) return tl::unexpected(status.error());
    return s.count(Put::kAdded);
  }
  auto status = s.run("DELETE FROM submap_chunk WHERE agent = ? AND seq = ?", node.id.agent, node.id.seq);
  if (!status) return tl::unexpected(status.error());
  s.partials.erase(node.id);
  ++s.stats.bad_submaps;
  return s.count(Put::kInvalid);
}

template <class Item, class Sign>
Result<bool> Store::State::resign_name(const Tables& tables, const NodeId& name, const Item& first,
                                       const Item* second, const Sign& sign, std::size_t& dropped) {
  const std::optional<Signature> of_first = sign(first);
  const std::optional<Signature> of_second = second ? sign(*second) : std::nullopt;
  dropped += (of_first ? 0 : 1) + (second && !of_second ? 1 : 0);
  if (!second && of_first && of_first == first.signature) return true;
  for (const char* table : {tables.items, tables.contested}) {
    if (auto status = remove(table, name); !status) return tl::unexpected(status.error());
  }
  if (of_first || of_second) {
    const Item& left = of_first ? first : *second;
    const Status kept = insert(tables.items, name, encode(left), of_first ? of_first : of_second);
    if (!kept) return tl::unexpected(kept.error());
  }
  if (of_first && of_second) {
    const Status kept = insert(tables.contested, name, encode(*second), of_second);
    if (!kept) return tl::unexpected(kept.error());
  }
  return of_first.has_value();
}

Status Store::State::resign_nodes(const SignNode& sign, std::size_t& dropped) {
  const auto resign = [&](const graph::Node& first, const graph::Node* second) -> Status {
    const auto stays = resign_name({"node", "contested_node"}, first.id, first, second, sign, dropped);
    if (!stays) return tl::unexpected(stays.error());
    return *stays ? Status{} : remove_submap(first.id);
  };
  for (const auto& [id, node] : nodes) {
    if (auto status = resign(node, nullptr); !status) return status;
  }
  for (const auto& [id, contents] : contested_nodes) {
    if (auto status = resign(contents.first.mapped(), &contents.second); !status) return status;
  }
  return {};
}

Status Store::State::resign_alignments(const SignAlignment& sign, std::size_t& dropped) {
  const auto resign = [&](const graph::Alignment& first, const graph::Alignment* second) -> Status {
    const auto stays = resign_name({"alignment", "contested_alignment"}, {first.computed_by, first.seq},
                                   first, second, sign, dropped);
    return stays ? Status{} : tl::unexpected(stays.error());
  };
  for (const auto& [id, alignment] : alignments) {
    if (auto status = resign(alignment, nullptr); !status) return status;
  }
  for (const auto& [id, contents] : contested_alignments) {
    if (auto status = resign(contents.first.mapped(), &contents.second); !status) return status;
  }
  return {};
}

Result<Store::Resigned> Store::resign(const SignNode& node, const SignAlignment& alignment) {
  State& s = *state_;
  Resigned done;
  // What is dropped must not be found again when a damaged file is searched for whole rows.
  if (auto status = s.db->execute("PRAGMA secure_delete = ON"); !status)
    return tl::unexpected(status.error());
  auto transaction = Transaction::begin(*s.db);
  if (!transaction) return tl::unexpected(transaction.error());
  if (auto status = s.resign_nodes(node, done.dropped_nodes); !status) return tl::unexpected(status.error());
  if (auto status = s.resign_alignments(alignment, done.dropped_alignments); !status)
    return tl::unexpected(status.error());
  if (auto status = transaction->commit(); !status) return tl::unexpected(status.error());
  if (auto status = s.db->execute("PRAGMA secure_delete = OFF"); !status)
    return tl::unexpected(status.error());
  if (auto status = s.load(); !status) return tl::unexpected(status.error());
  return done;
}

template <class Id, class Item>
bool Store::State::holds(const std::map<Id, Item>& items, const std::map<Id, Contested<Item>>& contested,
                         const Id& id, const Item& item) {
  const Bytes content = encode(item);
  if (const auto held = items.find(id); held != items.end()) return encode(held->second) == content;
  const auto names = contested.find(id);
  return names != contested.end() &&
         (encode(names->second.first.mapped()) == content || encode(names->second.second) == content);
}

bool Store::holds(const graph::Node& node) const {
  return State::holds(state_->nodes, state_->contested_nodes, node.id, node);
}

bool Store::holds(const graph::Alignment& alignment) const {
  return State::holds(state_->alignments, state_->contested_alignments,
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

Result<Bytes> Store::contested_submap(const NodeId& id) const {
  const auto held = state_->contested_nodes.find(id);
  if (held == state_->contested_nodes.end()) return failure("node " + to_string(id) + " is not contested");
  const graph::Node& first = held->second.first.mapped();
  if (first.submap_bytes == 0) return Bytes{};
  auto rows = state_->db->prepare("SELECT bytes FROM submap WHERE agent = ? AND seq = ?");
  if (!rows) return tl::unexpected(rows.error());
  const auto row = rows->bind(1, id.agent.str()).bind(2, std::int64_t{id.seq}).step();
  if (!row) return tl::unexpected(row.error());
  const ByteView bytes = *row ? rows->blob(0) : ByteView();
  if (content_hash(bytes) != first.submap_hash) {
    return failure(state_->path.string() + ": the submap of contested node " + to_string(id) +
                   " is not held");
  }
  return Bytes(bytes.begin(), bytes.end());
}

std::uint32_t Store::node_print(const SeqRange& range) const { return state_->node_prints.of(range); }
std::uint32_t Store::alignment_print(const SeqRange& range) const {
  return state_->alignment_prints.of(range);
}

std::uint64_t Store::revision() const {
  const State& s = *state_;
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

bool Store::has_submap(const NodeId& id) const { return state_->submap_set.contains(id.agent, id.seq); }

Result<Bytes> Store::submap(const NodeId& id) {
  const graph::Node* held = node(id);
  if (!held || !has_submap(id)) return failure("submap of node " + to_string(id) + " is not held");
  State& s = *state_;
  auto bytes = submap_part(id, 0, held->submap_bytes);
  if (bytes && bytes->size() == held->submap_bytes && content_hash(*bytes) == held->submap_hash) return bytes;
  if (!bytes && !s.db->is_damaged()) return bytes;
  // Where its pages are damaged it may stay in the file, until the next start replaces that.
  if (!s.read_only) static_cast<void>(s.remove("submap", id));
  s.submap_set.erase(id.agent, id.seq);
  ++s.stats.lost_submaps;
  return failure(s.path.string() + ": submap of node " + to_string(id) +
                 " is damaged on disk; it was dropped");
}

Result<Bytes> Store::submap_part(const NodeId& id, std::uint32_t offset, std::uint32_t length) const {
  const graph::Node* held = node(id);
  if (!held || !has_submap(id)) return failure("submap of node " + to_string(id) + " is not held");
  if (offset >= held->submap_bytes) return Bytes{};
  auto rows = state_->db->prepare("SELECT substr(bytes, ?3, ?4) FROM submap WHERE agent = ?1 AND seq = ?2");
  if (!rows) return tl::unexpected(rows.error());
  rows->bind(1, id.agent.str()).bind(2, std::int64_t{id.seq});
  rows->bind(3, std::int64_t{offset} + 1).bind(4, std::int64_t{length});
  const auto row = rows->step();
  if (!row) return tl::unexpected(row.error());
  const ByteView bytes = *row ? rows->blob(0) : ByteView();
  return Bytes(bytes.begin(), bytes.end());
}

std::vector<std::uint32_t> Store::missing_chunks(const NodeId& id) const {
  std::vector<std::uint32_t> missing;
  const graph::Node* held = node(id);
  if (!held || has_submap(id)) return missing;
  const auto partial = state_->partials.find(id);
  for (std::uint32_t chunk = 0; chunk < chunk_count(*held); ++chunk) {
    if (partial == state_->partials.end() || !partial->second.held[chunk]) missing.push_back(chunk);
  }
  return missing;
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
  State& s = *state_;
  const std::int64_t changes = s.db->changes();
  if (!s.config.power_safe || s.read_only) return {};
  if (s.synced_changes == changes && !s.db->log_is_doubtful()) return {};
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
