#include "schema.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "fleetmap/store/store.hpp"
#include "row_hash.hpp"

namespace fleetmap::store {
namespace {

constexpr std::int64_t kApplicationId = 0x464c4d50;  // "FLMP", in the file's header
constexpr std::int64_t kSchemaVersion = Store::kSchemaVersion;

// WITHOUT ROWID keeps an item in its index; large blobs need the ordinary layout.
constexpr const char* kTables = R"sql(
  CREATE TABLE meta(key TEXT PRIMARY KEY, value BLOB NOT NULL) WITHOUT ROWID;
  CREATE TABLE node(agent TEXT, seq INTEGER, item BLOB NOT NULL, hash BLOB NOT NULL DEFAULT x'',
                    PRIMARY KEY(agent, seq)) WITHOUT ROWID;
  CREATE TABLE alignment(agent TEXT, seq INTEGER, item BLOB NOT NULL, hash BLOB NOT NULL DEFAULT x'',
                         PRIMARY KEY(agent, seq)) WITHOUT ROWID;
  CREATE TABLE submap(agent TEXT, seq INTEGER, bytes BLOB NOT NULL, PRIMARY KEY(agent, seq));
  CREATE TABLE submap_chunk(agent TEXT, seq INTEGER, chunk INTEGER, bytes BLOB NOT NULL,
                            PRIMARY KEY(agent, seq, chunk));
)sql";

// The second content of names that have two.
constexpr const char* kContestedTables = R"sql(
  CREATE TABLE contested_node(agent TEXT, seq INTEGER, item BLOB NOT NULL, hash BLOB NOT NULL DEFAULT x'',
                              PRIMARY KEY(agent, seq)) WITHOUT ROWID;
  CREATE TABLE contested_alignment(agent TEXT, seq INTEGER, item BLOB NOT NULL, hash BLOB NOT NULL DEFAULT x'',
                                   PRIMARY KEY(agent, seq)) WITHOUT ROWID;
)sql";

// The maker's signature; empty in a fleet without keys.
constexpr const char* kSignatureColumns = R"sql(
  ALTER TABLE node ADD COLUMN signature BLOB NOT NULL DEFAULT x'';
  ALTER TABLE alignment ADD COLUMN signature BLOB NOT NULL DEFAULT x'';
  ALTER TABLE contested_node ADD COLUMN signature BLOB NOT NULL DEFAULT x'';
  ALTER TABLE contested_alignment ADD COLUMN signature BLOB NOT NULL DEFAULT x'';
)sql";

// Hash of key and value.
constexpr const char* kHashOfValues = "ALTER TABLE meta ADD COLUMN hash BLOB NOT NULL DEFAULT x''";
constexpr std::int64_t kFirstWithHashOfValues = 6;

Status set_version(Database& db, std::int64_t version) {
  return db.execute(("PRAGMA user_version = " + std::to_string(version)).c_str());
}

/// Fills in the hash of each item of `table`.
Status add_hashes(Database& db, const std::string& table) {
  if (auto status =
          db.execute(("ALTER TABLE " + table + " ADD COLUMN hash BLOB NOT NULL DEFAULT x''").c_str());
      !status)
    return status;
  struct Row {
    std::string agent;
    std::int64_t seq;
    ContentHash hash;
  };
  std::vector<Row> hashed;
  {
    auto rows = db.prepare("SELECT agent, seq, item FROM " + table);
    if (!rows) return tl::unexpected(rows.error());
    for (auto row = rows->step();; row = rows->step()) {
      if (!row) return tl::unexpected(row.error());
      if (!*row) break;
      hashed.push_back({std::string(rows->text(0)), rows->integer(1), content_hash(rows->blob(2))});
    }
  }
  for (const Row& row : hashed) {
    auto update = db.prepare("UPDATE " + table + " SET hash = ? WHERE agent = ? AND seq = ?");
    if (!update) return tl::unexpected(update.error());
    update->bind(1, ByteView(row.hash)).bind(2, std::string_view(row.agent)).bind(3, row.seq);
    if (auto status = update->run(); !status) return status;
  }
  return {};
}

/// 3 to 4: rows carry the hash of their item, and contested names have tables.
Status to_version_4(Database& db) {
  for (const char* table : {"node", "alignment"}) {
    if (auto status = add_hashes(db, table); !status) return status;
  }
  return db.execute(kContestedTables);
}

/// 4 to 5: rows carry the signature of their item. The hash of a row covers it, too, and that of a row
/// without stays what it was.
Status to_version_5(Database& db) { return db.execute(kSignatureColumns); }

/// 5 to 6: named values carry a hash, too.
Status to_version_6(Database& db) {
  if (auto status = db.execute(kHashOfValues); !status) return status;
  std::vector<std::pair<std::string, ContentHash>> hashed;
  {
    auto rows = db.prepare("SELECT key, value FROM meta");
    if (!rows) return tl::unexpected(rows.error());
    for (auto row = rows->step();; row = rows->step()) {
      if (!row) return tl::unexpected(row.error());
      if (!*row) break;
      hashed.emplace_back(rows->text(0), value_hash(rows->text(0), rows->blob(1)));
    }
  }
  for (const auto& [key, hash] : hashed) {
    auto update = db.prepare("UPDATE meta SET hash = ? WHERE key = ?");
    if (!update) return tl::unexpected(update.error());
    if (auto status = update->bind(1, ByteView(hash)).bind(2, std::string_view(key)).run(); !status)
      return status;
  }
  return {};
}

/// A step brings a store of version `from` to the next one.
struct Step {
  std::int64_t from;
  Status (*apply)(Database&);
};
constexpr std::array kSteps{Step{3, to_version_4}, Step{4, to_version_5}, Step{5, to_version_6}};
static_assert(kSteps.back().from + 1 == kSchemaVersion);

/// All steps or none: a store that fails half way stays what it was.
Status migrate(Database& db) {
  const auto version = db.integer("PRAGMA user_version");
  if (!version) return tl::unexpected(version.error());
  if (*version < kSteps.front().from || *version >= kSchemaVersion) return {};
  auto transaction = Transaction::begin(db);
  if (!transaction) return tl::unexpected(transaction.error());
  for (const Step& step : kSteps) {
    if (step.from < *version) continue;
    if (auto status = step.apply(db); !status) return status;
    if (auto status = set_version(db, step.from + 1); !status) return status;
  }
  return transaction->commit();
}

Status wrong_version(const std::filesystem::path& path, std::int64_t version) {
  const std::string which = path.string() + ": store of schema version " + std::to_string(version) +
                            ", this program reads version " + std::to_string(kSchemaVersion);
  if (version > kSchemaVersion) {
    return failure(which +
                   "; a newer program wrote it: update this one, or move the file away to start an "
                   "empty store");
  }
  if (version >= kSteps.front().from) {
    return failure(which + "; start the robot's program once with it, which brings it to that version");
  }
  return failure(which + "; use the program that wrote it, or move the file away to start an empty store");
}

Status make_tables(Database& db, const AgentId& self) {
  auto transaction = Transaction::begin(db);
  if (!transaction) return tl::unexpected(transaction.error());
  for (const char* sql : {kTables, kContestedTables, kSignatureColumns, kHashOfValues}) {
    if (auto status = db.execute(sql); !status) return status;
  }
  const std::string application = "PRAGMA application_id = " + std::to_string(kApplicationId);
  if (auto status = db.execute(application.c_str()); !status) return status;
  if (auto status = set_version(db, kSchemaVersion); !status) return status;
  auto owner = db.prepare("INSERT INTO meta VALUES(?, ?, ?)");
  if (!owner) return tl::unexpected(owner.error());
  const Bytes name(self.str().begin(), self.str().end());
  const ContentHash hash = value_hash(kOwnerKey, name);
  owner->bind(1, std::string_view(kOwnerKey)).bind(2, ByteView(name)).bind(3, ByteView(hash));
  if (auto status = owner->run(); !status) return status;
  return transaction->commit();
}

}  // namespace

Result<Recognised> recognise(const Database& db) {
  const auto application = db.integer("PRAGMA application_id");
  if (!application) return tl::unexpected(application.error());
  const auto version = db.integer("PRAGMA user_version");
  if (!version) return tl::unexpected(version.error());
  const auto tables = db.integer("SELECT count(*) FROM sqlite_master WHERE name = 'submap_chunk'");
  if (!tables) return tl::unexpected(tables.error());
  if (*application != kApplicationId) return *tables > 0 ? Recognised::kStoreWithoutMark : Recognised::kOther;
  const bool read_here = *version >= kSteps.front().from && *version <= kSchemaVersion;
  return read_here ? Recognised::kStore : Recognised::kOther;
}

Result<AgentId> owner_of(const Database& db, const std::filesystem::path& path) {
  const auto version = db.integer("PRAGMA user_version");
  if (!version) return tl::unexpected(version.error());
  const bool hashed = *version >= kFirstWithHashOfValues;
  auto owner = db.prepare(hashed ? "SELECT value, hash FROM meta WHERE key = ?"
                                 : "SELECT value FROM meta WHERE key = ?");
  if (!owner) return tl::unexpected(owner.error());
  const auto row = owner->bind(1, std::string_view(kOwnerKey)).step();
  if (!row) return tl::unexpected(row.error());
  const ByteView name = *row ? owner->blob(0) : ByteView();
  auto self = AgentId::parse(std::string(name.begin(), name.end()));
  const bool whole = !hashed || (*row && std::ranges::equal(owner->blob(1), value_hash(kOwnerKey, name)));
  if (!self || !whole) return failure(path.string() + ": the store names no owner; the file is damaged");
  return self;
}

Result<AgentId> check_schema(const Database& db, const std::filesystem::path& path) {
  const auto application = db.integer("PRAGMA application_id");
  if (!application) return tl::unexpected(application.error());
  if (*application != kApplicationId) {
    return failure(path.string() + ": a SQLite database, but not a fleetmap store; give another path");
  }
  const auto version = db.integer("PRAGMA user_version");
  if (!version) return tl::unexpected(version.error());
  if (*version != kSchemaVersion) return tl::unexpected(wrong_version(path, *version).error());
  return owner_of(db, path);
}

Status prepare_schema(Database& db, const std::filesystem::path& path, const AgentId& self) {
  const auto objects = db.integer("SELECT count(*) FROM sqlite_master");
  if (!objects) return tl::unexpected(objects.error());
  const auto application = db.integer("PRAGMA application_id");
  if (!application) return tl::unexpected(application.error());
  if (*objects == 0 && *application == 0) {
    if (auto status = make_tables(db, self); !status) return status;
  }
  if (*application == kApplicationId) {
    const auto owner = owner_of(db, path);
    if (!owner) return tl::unexpected(owner.error());
    if (*owner != self) {
      return failure(path.string() + ": store of agent '" + owner->str() + "', not of '" + self.str() +
                     "'; every agent needs its own");
    }
    if (auto status = migrate(db); !status) return status;
  }
  const auto owner = check_schema(db, path);
  if (!owner) return tl::unexpected(owner.error());
  return {};
}

}  // namespace fleetmap::store
