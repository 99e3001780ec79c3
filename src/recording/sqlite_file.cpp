#include "sqlite_file.hpp"

#include <map>

#include "database.hpp"
#include "ros_names.hpp"

namespace fleetmap::recording {
namespace {

class SqliteFile : public BagFile {
 public:
  SqliteFile(Database database, Statement order, Statement fetch, std::map<std::int64_t, BagTopic> topics)
      : database_(std::move(database)),
        order_(std::move(order)),
        fetch_(std::move(fetch)),
        topics_(std::move(topics)) {}

  Result<std::vector<BagTopic>> topics() override {
    std::vector<BagTopic> all;
    for (const auto& [id, topic] : topics_) all.push_back(topic);
    return all;
  }

  Result<std::optional<BagMessage>> next() override {
    while (!ended_) {
      const int code = order_.step();
      if (code == SQLITE_DONE) break;
      if (code != SQLITE_ROW) return fail();
      fetch_.reset();
      fetch_.bind(1, order_.integer(0));
      const int found = fetch_.step();
      if (found == SQLITE_DONE) continue;
      if (found != SQLITE_ROW) return fail();
      ++messages_;
      const auto topic = topics_.find(fetch_.integer(0));
      if (topic != topics_.end()) return BagMessage{topic->second.name, fetch_.integer(1), fetch_.blob(2)};
    }
    ended_ = true;
    return std::optional<BagMessage>();
  }

 private:
  tl::unexpected<Error> fail() {
    ended_ = true;
    return tl::unexpected(database_.error("read on after " + std::to_string(messages_) + " messages"));
  }

  Database database_;
  Statement order_;  ///< ids only, so that sorting never holds messages
  Statement fetch_;
  std::map<std::int64_t, BagTopic> topics_;
  std::uint64_t messages_ = 0;
  bool ended_ = false;
};

}  // namespace

Result<std::unique_ptr<BagFile>> open_sqlite_file(const std::filesystem::path& file) {
  auto database = Database::open_for_reading(file);
  if (!database) return tl::unexpected(database.error());
  std::map<std::int64_t, BagTopic> topics;
  auto query = database->prepare("SELECT id, name, type FROM topics");
  if (!query) return tl::unexpected(query.error());
  int code = query->step();
  for (; code == SQLITE_ROW; code = query->step())
    topics.emplace(query->integer(0), BagTopic{query->text(1), ros_type(query->text(2))});
  if (code != SQLITE_DONE) return tl::unexpected(database->error("read topics"));
  auto order = database->prepare("SELECT id FROM messages ORDER BY timestamp, id");
  if (!order) return tl::unexpected(order.error());
  auto fetch = database->prepare("SELECT topic_id, timestamp, data FROM messages WHERE id = ?");
  if (!fetch) return tl::unexpected(fetch.error());
  return std::make_unique<SqliteFile>(std::move(*database), std::move(*order), std::move(*fetch),
                                      std::move(topics));
}

}  // namespace fleetmap::recording
