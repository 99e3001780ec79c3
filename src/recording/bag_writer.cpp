#include "fleetmap/recording/bag_writer.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "bag_metadata.hpp"
#include "database.hpp"
#include "fleetmap/core/paths.hpp"
#include "ros_names.hpp"

namespace fleetmap::recording {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kCommitBytes = 4'000'000;
constexpr std::int64_t kCommitNs = 1'000'000'000;

/// Tables of rosbag2_storage_default_plugins in ROS 2 Humble. The write-ahead log keeps what was committed
/// when the writer is killed.
constexpr char kSchema[] =
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

}  // namespace

struct BagWriter::Impl {
  fs::path dir;
  Database database;
  Statement insert_message;
  Statement insert_topic;
  BagMetadata metadata;
  std::map<std::string, std::pair<std::int64_t, std::size_t>, std::less<>>
      topics;  ///< id and place in metadata
  std::size_t pending_bytes = 0;
  std::optional<std::int64_t> pending_since;
  bool any = false;
  bool closed = false;

  Result<std::pair<std::int64_t, std::size_t>> topic(std::string_view name, std::string_view type);
  Status commit();
  Status close();
};

Result<std::pair<std::int64_t, std::size_t>> BagWriter::Impl::topic(std::string_view name,
                                                                    std::string_view type) {
  const std::string ros_name = ros_topic(name);
  if (const auto known = topics.find(ros_name); known != topics.end()) return known->second;
  insert_topic.reset();
  insert_topic.bind(1, ros_name);
  insert_topic.bind(2, ros_type(type));
  if (insert_topic.step() != SQLITE_DONE) return tl::unexpected(database.error("write topic " + ros_name));
  metadata.topics.push_back({ros_name, ros_type(type), 0});
  return topics.emplace(ros_name, std::make_pair(database.last_insert_id(), metadata.topics.size() - 1))
      .first->second;
}

Status BagWriter::Impl::commit() {
  pending_bytes = 0;
  pending_since.reset();
  return database.execute("COMMIT; BEGIN");
}

Status BagWriter::Impl::close() {
  if (closed) return {};
  closed = true;
  insert_message.reset();
  insert_topic.reset();
  if (auto status = database.execute("COMMIT; PRAGMA journal_mode=DELETE"); !status) return status;
  return write_metadata(dir, metadata);
}

Result<BagWriter> BagWriter::create(const fs::path& dir) {
  std::error_code error;
  const fs::path absolute = fs::weakly_canonical(dir, error);
  fs::create_directories(absolute, error);
  if (error) return failure(dir.string() + ": cannot be made: " + error.message());
  const std::string name = absolute.filename().string() + "_0.db3";
  if (is_there(absolute / kMetadataFile) || is_there(absolute / name)) {
    return failure(dir.string() + ": holds a bag already; record to another folder");
  }
  auto database = Database::create(absolute / name);
  if (!database) return tl::unexpected(database.error());
  if (auto status = database->execute(kSchema); !status) return tl::unexpected(status.error());
  auto message = database->prepare("INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)");
  if (!message) return tl::unexpected(message.error());
  auto topic = database->prepare(
      "INSERT INTO topics(name, type, serialization_format, offered_qos_profiles) VALUES (?, ?, 'cdr', '')");
  if (!topic) return tl::unexpected(topic.error());
  auto impl = std::make_unique<Impl>(Impl{
      absolute, std::move(*database), std::move(*message), std::move(*topic), {}, {}, 0, {}, false, false});
  impl->metadata.files = {name};
  return BagWriter(std::move(impl));
}

BagWriter::BagWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
BagWriter::BagWriter(BagWriter&&) noexcept = default;
BagWriter& BagWriter::operator=(BagWriter&& other) noexcept {
  std::swap(impl_, other.impl_);  // `other` closes the bag that this one wrote
  return *this;
}
BagWriter::~BagWriter() {
  if (!impl_) return;
  if (const auto status = impl_->close(); !status) spdlog::error("recording: {}", status.error().message);
}

Status BagWriter::write(std::string_view topic, std::string_view type, Stamp received, ByteView cdr) {
  if (impl_->closed) return failure(impl_->dir.string() + ": the bag is closed");
  const auto id = impl_->topic(topic, type);
  if (!id) return tl::unexpected(id.error());
  const std::int64_t ns = to_ns(received);
  Statement& insert = impl_->insert_message;
  insert.reset();
  insert.bind(1, id->first);
  insert.bind(2, ns);
  insert.bind(3, cdr);
  if (insert.step() != SQLITE_DONE) return tl::unexpected(impl_->database.error("write a message"));
  insert.reset();
  BagMetadata& metadata = impl_->metadata;
  ++metadata.topics[id->second].messages;
  metadata.first_ns = impl_->any ? std::min(metadata.first_ns, ns) : ns;
  metadata.last_ns = impl_->any ? std::max(metadata.last_ns, ns) : ns;
  impl_->any = true;
  impl_->pending_bytes += cdr.size();
  if (!impl_->pending_since) impl_->pending_since = ns;
  if (impl_->pending_bytes >= kCommitBytes || ns - *impl_->pending_since >= kCommitNs) return impl_->commit();
  return {};
}

Status BagWriter::flush() {
  if (impl_->closed) return {};
  return impl_->commit();
}

Status BagWriter::close() { return impl_->close(); }

}  // namespace fleetmap::recording
