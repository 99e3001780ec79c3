#include "sqlite_storage.hpp"

#include <utility>
#include <vector>

#include "database.hpp"

namespace fleetmap::recording {
namespace {

/// Tables of rosbag2_storage_default_plugins in ROS 2 Humble. The write-ahead log keeps what was committed
/// when the writer is killed.
constexpr char kTables[] =
    "PRAGMA journal_mode=WAL; PRAGMA synchronous=NORMAL;"
    "CREATE TABLE schema(schema_version INTEGER PRIMARY KEY,ros_distro TEXT NOT NULL);"
    "CREATE TABLE metadata(id INTEGER PRIMARY KEY,metadata_version INTEGER NOT NULL,metadata TEXT NOT NULL);"
    "CREATE TABLE topics(id INTEGER PRIMARY KEY,name TEXT NOT NULL,type TEXT NOT NULL,"
    "serialization_format TEXT NOT NULL,offered_qos_profiles TEXT NOT NULL);"
    "CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id INTEGER NOT NULL,timestamp INTEGER NOT NULL,"
    "data BLOB NOT NULL);"
    "CREATE INDEX timestamp_idx ON messages (timestamp ASC);"
    "INSERT INTO schema(schema_version, ros_distro) VALUES (3, 'humble');"
    "BEGIN";

class SqliteStorage : public StorageFile {
 public:
  SqliteStorage(Database database, Statement insert_message, Statement insert_topic)
      : database_(std::move(database)),
        insert_message_(std::move(insert_message)),
        insert_topic_(std::move(insert_topic)) {}

  Status add_topic(const WrittenTopic& topic) override {
    insert_topic_.reset();
    insert_topic_.bind(1, topic.name);
    insert_topic_.bind(2, topic.type);
    insert_topic_.bind(3, topic.offered_qos);
    if (insert_topic_.step() != SQLITE_DONE)
      return tl::unexpected(database_.error("write topic " + topic.name));
    ids_.push_back(database_.last_insert_id());
    return {};
  }

  Status write(std::size_t topic, std::int64_t received_ns, ByteView cdr) override {
    insert_message_.reset();
    insert_message_.bind(1, ids_[topic]);
    insert_message_.bind(2, received_ns);
    insert_message_.bind(3, cdr);
    if (insert_message_.step() != SQLITE_DONE) return tl::unexpected(database_.error("write a message"));
    insert_message_.reset();
    return {};
  }

  Status flush() override { return database_.execute("COMMIT; BEGIN"); }

  Status close() override {
    insert_message_.reset();
    insert_topic_.reset();
    return database_.execute("COMMIT; PRAGMA journal_mode=DELETE");
  }

 private:
  Database database_;
  Statement insert_message_;
  Statement insert_topic_;
  std::vector<std::int64_t> ids_;
};

}  // namespace

Result<std::unique_ptr<StorageFile>> create_sqlite_storage(const std::filesystem::path& file) {
  auto database = Database::create(file);
  if (!database) return tl::unexpected(database.error());
  if (auto status = database->execute(kTables); !status) return tl::unexpected(status.error());
  auto message = database->prepare("INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)");
  if (!message) return tl::unexpected(message.error());
  auto topic = database->prepare(
      "INSERT INTO topics(name, type, serialization_format, offered_qos_profiles) VALUES (?, ?, 'cdr', ?)");
  if (!topic) return tl::unexpected(topic.error());
  return std::make_unique<SqliteStorage>(std::move(*database), std::move(*message), std::move(*topic));
}

}  // namespace fleetmap::recording
