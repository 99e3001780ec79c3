#include "schema.hpp"

#include <string>

namespace fleetmap::store {
namespace {

constexpr std::int64_t kApplicationId = 0x464c4d50;  // "FLMP", in the file's header
constexpr std::int64_t kSchemaVersion = 3;

// WITHOUT ROWID keeps an item in its index; large blobs want the ordinary layout instead.
constexpr const char* kTables = R"sql(
  CREATE TABLE meta(key TEXT PRIMARY KEY, value BLOB NOT NULL) WITHOUT ROWID;
  CREATE TABLE node(agent TEXT, seq INTEGER, item BLOB NOT NULL, PRIMARY KEY(agent, seq)) WITHOUT ROWID;
  CREATE TABLE alignment(agent TEXT, seq INTEGER, item BLOB NOT NULL, PRIMARY KEY(agent, seq)) WITHOUT ROWID;
  CREATE TABLE submap(agent TEXT, seq INTEGER, bytes BLOB NOT NULL, PRIMARY KEY(agent, seq));
  CREATE TABLE submap_chunk(agent TEXT, seq INTEGER, chunk INTEGER, bytes BLOB NOT NULL,
                            PRIMARY KEY(agent, seq, chunk));
)sql";

Status make_tables(Database& db, const AgentId& self) {
  auto transaction = Transaction::begin(db);
  if (!transaction) return tl::unexpected(transaction.error());
  if (auto status = db.execute(kTables); !status) return status;
  const std::string pragmas = "PRAGMA application_id = " + std::to_string(kApplicationId) +
                              "; PRAGMA user_version = " + std::to_string(kSchemaVersion);
  if (auto status = db.execute(pragmas.c_str()); !status) return status;
  auto owner = db.prepare("INSERT INTO meta VALUES('self', ?)");
  if (!owner) return tl::unexpected(owner.error());
  const Bytes name(self.str().begin(), self.str().end());
  if (auto status = owner->bind(1, ByteView(name)).run(); !status) return status;
  return transaction->commit();
}

}  // namespace

Result<AgentId> check_schema(const Database& db, const std::filesystem::path& path) {
  const auto application = db.integer("PRAGMA application_id");
  if (!application) return tl::unexpected(application.error());
  if (*application != kApplicationId) {
    return failure(path.string() + ": a SQLite database, but not a fleetmap store; give another path");
  }
  const auto version = db.integer("PRAGMA user_version");
  if (!version) return tl::unexpected(version.error());
  if (*version != kSchemaVersion) {
    return failure(path.string() + ": store of schema version " + std::to_string(*version) +
                   ", this program reads version " + std::to_string(kSchemaVersion) +
                   "; use the program that wrote it, or move the file away to start an empty store");
  }
  auto owner = db.prepare("SELECT value FROM meta WHERE key = 'self'");
  if (!owner) return tl::unexpected(owner.error());
  const auto row = owner->step();
  if (!row) return tl::unexpected(row.error());
  const ByteView name = *row ? owner->blob(0) : ByteView();
  auto self = AgentId::parse(std::string(name.begin(), name.end()));
  if (!self) return failure(path.string() + ": the store names no owner; the file is damaged");
  return self;
}

Status prepare_schema(Database& db, const std::filesystem::path& path, const AgentId& self) {
  const auto objects = db.integer("SELECT count(*) FROM sqlite_master");
  if (!objects) return tl::unexpected(objects.error());
  const auto application = db.integer("PRAGMA application_id");
  if (!application) return tl::unexpected(application.error());
  if (*objects == 0 && *application == 0) {
    if (auto status = make_tables(db, self); !status) return status;
  }
  const auto owner = check_schema(db, path);
  if (!owner) return tl::unexpected(owner.error());
  if (*owner != self) {
    return failure(path.string() + ": store of agent '" + owner->str() + "', not of '" + self.str() +
                   "'; every agent needs its own");
  }
  return {};
}

}  // namespace fleetmap::store
