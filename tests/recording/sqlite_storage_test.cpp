#include "recording/sqlite_storage.hpp"

#include <gmock/gmock.h>

#include "recording/database.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::recording {
namespace {

TEST(SqliteStorage, WritesTopicsWithTheirProfilesAndMessages) {
  const fleetmap::testing::TemporaryFolder folder;
  const auto file = folder.path() / "a.db3";
  auto storage = create_sqlite_storage(file);
  ASSERT_TRUE(storage) << storage.error().message;
  ASSERT_TRUE((*storage)->add_topic({"/a", "x/msg/A", "- depth: 1"}));
  ASSERT_TRUE((*storage)->add_topic({"/b", "x/msg/B", "- depth: 2"}));
  ASSERT_TRUE((*storage)->write(1, 12, Bytes{1, 2}));
  ASSERT_TRUE((*storage)->close());
  auto database = Database::open_for_reading(file).value();
  auto topics = database.prepare("SELECT name, type, offered_qos_profiles FROM topics ORDER BY id").value();
  for (const char* letter : {"a", "b"}) {
    ASSERT_EQ(topics.step(), SQLITE_ROW);
    EXPECT_EQ(topics.text(0), std::string("/") + letter);
    EXPECT_EQ(topics.text(2), *letter == 'a' ? "- depth: 1" : "- depth: 2");
  }
  auto messages =
      database.prepare("SELECT name, timestamp FROM messages JOIN topics ON topics.id = topic_id").value();
  ASSERT_EQ(messages.step(), SQLITE_ROW);
  EXPECT_EQ(messages.text(0), "/b");
  EXPECT_EQ(messages.integer(1), 12);
  EXPECT_EQ(messages.step(), SQLITE_DONE);
}

TEST(SqliteStorage, NamesAFolderThatIsNotThere) {
  const fleetmap::testing::TemporaryFolder folder;
  EXPECT_THAT(create_sqlite_storage(folder.path() / "none/a.db3").error().message,
              ::testing::HasSubstr("none/a.db3"));
}

}  // namespace
}  // namespace fleetmap::recording
