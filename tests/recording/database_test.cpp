#include "database.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "support/temporary_folder.hpp"

namespace fleetmap::recording {
namespace {

using fleetmap::testing::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

void fill(const fs::path& file) {
  auto database = Database::create(file);
  ASSERT_TRUE(database) << database.error().message;
  ASSERT_TRUE(database->execute("CREATE TABLE t(id INTEGER PRIMARY KEY, number, word, bytes)"));
  auto insert = database->prepare("INSERT INTO t(number, word, bytes) VALUES(?, ?, ?)");
  ASSERT_TRUE(insert) << insert.error().message;
  const Bytes bytes{0, 255, 0, 1};
  insert->bind(1, std::numeric_limits<std::int64_t>::min());
  insert->bind(2, std::string("zwölf"));
  insert->bind(3, ByteView(bytes));
  ASSERT_EQ(insert->step(), SQLITE_DONE);
  EXPECT_EQ(database->last_insert_id(), 1);
  insert->reset();
  insert->bind(1, std::int64_t{7});
  insert->bind(2, std::string());
  insert->bind(3, ByteView());
  ASSERT_EQ(insert->step(), SQLITE_DONE);
  EXPECT_EQ(database->last_insert_id(), 2);
}

TEST(RecordingDatabase, BoundValuesAreReadBack) {
  const TemporaryFolder folder;
  // Characters that mean something in SQLite's URIs.
  const fs::path file = folder.path() / "drive 50%20?#1.db3";
  fill(file);
  ASSERT_TRUE(fs::exists(file));
  const auto database = Database::open_for_reading(file);
  ASSERT_TRUE(database) << database.error().message;
  auto rows = database->prepare("SELECT number, word, bytes, bytes IS NULL, NULL FROM t ORDER BY id");
  ASSERT_TRUE(rows);
  ASSERT_EQ(rows->step(), SQLITE_ROW);
  EXPECT_EQ(rows->integer(0), std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(rows->text(1), "zwölf");
  EXPECT_THAT(rows->blob(2), ::testing::ElementsAre(0, 255, 0, 1));
  ASSERT_EQ(rows->step(), SQLITE_ROW);
  EXPECT_EQ(rows->integer(0), 7);
  EXPECT_EQ(rows->text(1), "");
  EXPECT_TRUE(rows->blob(2).empty());
  EXPECT_EQ(rows->integer(3), 0) << "no bytes are not NULL";
  EXPECT_EQ(rows->text(4), "");
  EXPECT_TRUE(rows->blob(4).empty());
  EXPECT_EQ(rows->step(), SQLITE_DONE);
}

TEST(RecordingDatabase, OpenForReadingNeitherMakesNorChangesAFile) {
  const TemporaryFolder folder;
  const fs::path none = folder.path() / "none.db3";
  const auto absent = Database::open_for_reading(none);
  ASSERT_FALSE(absent);
  EXPECT_THAT(absent.error().message, HasSubstr(none.string() + ": cannot open: "));
  EXPECT_FALSE(fs::exists(none));
  const fs::path file = folder.path() / "a.db3";
  fill(file);
  const Status written = Database::open_for_reading(file).value().execute("DELETE FROM t");
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().message, HasSubstr("a.db3: cannot write: "));
}

TEST(RecordingDatabase, ErrorsNameTheFileAndWhatToDo) {
  const TemporaryFolder folder;
  const auto text = Database::open_for_reading(folder.write("text.db3", std::string(5000, 'a')));
  ASSERT_FALSE(text);
  EXPECT_THAT(text.error().message,
              AllOf(HasSubstr("text.db3: cannot read: "), HasSubstr("; this is no rosbag2 sqlite3 file")));
  const fs::path file = folder.path() / "a.db3";
  fill(file);
  const auto database = Database::open_for_reading(file);
  ASSERT_TRUE(database);
  const auto query = database->prepare("SELECT x FROM y");
  ASSERT_FALSE(query);
  EXPECT_THAT(query.error().message, HasSubstr("a.db3: cannot query: no such table: y"));
  const auto nowhere = Database::create(folder.path() / "none" / "a.db3");
  ASSERT_FALSE(nowhere);
  EXPECT_THAT(nowhere.error().message, HasSubstr("cannot open: "));
}

TEST(RecordingDatabase, ADamagedFileSaysHowToSaveWhatIsLeft) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "a.db3";
  fill(file);
  {
    // The header and the root page of the schema stay, the page of the table is overwritten.
    std::fstream damage(file, std::ios::binary | std::ios::in | std::ios::out);
    damage.seekp(4096);
    damage << std::string(4096, '\x55');
  }
  const auto database = Database::open_for_reading(file);
  ASSERT_TRUE(database) << database.error().message;
  auto rows = database->prepare("SELECT number FROM t");
  ASSERT_TRUE(rows) << rows.error().message;
  EXPECT_EQ(rows->step(), SQLITE_CORRUPT);
  EXPECT_THAT(
      database->error("read").message,
      HasSubstr("; the file is damaged or truncated, `sqlite3 a.db3 .recover | sqlite3 rescued.db3`"));
}

}  // namespace
}  // namespace fleetmap::recording
