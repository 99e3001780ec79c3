#include "fleetmap/core/whole_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <iterator>
#include <string>

#include "support/file_content.hpp"
#include "support/full_disk.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class WholeFileTest : public ::testing::Test {
 protected:
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_.path()), {}));
  }
  testing::TemporaryFolder folder_;
  const fs::path file_ = folder_.path() / "map.las";
};

TEST_F(WholeFileTest, AppearsWithItsPiecesWhenItIsFinished) {
  auto file = WholeFile::create(file_);
  ASSERT_TRUE(file) << file.error().message;
  ASSERT_TRUE(file->append("0 points: "));
  ASSERT_TRUE(file->append(Bytes{'a', 'b', '\0', 'c'}));
  WholeFile moved = std::move(*file);
  ASSERT_TRUE(moved.append("d"));
  ASSERT_TRUE(moved.overwrite("5"));
  EXPECT_FALSE(fs::exists(file_));
  ASSERT_TRUE(moved.finish());
  EXPECT_EQ(testing::file_text(file_), std::string("5 points: ab\0cd", 15));
  EXPECT_EQ(files(), 1u);
}

TEST_F(WholeFileTest, ReplacesAnotherAsAWholeOrNotAtAll) {
  folder_.write("map.las", "old and longer");
  folder_.write("map.las.part", "of a process that was killed");
  {
    auto file = WholeFile::create(file_);
    ASSERT_TRUE(file && file->append("new"));
    EXPECT_EQ(testing::file_text(file_), "old and longer");
  }
  EXPECT_EQ(testing::file_text(file_), "old and longer");
  EXPECT_EQ(files(), 1u) << "what was not finished is gone";
  ASSERT_TRUE(write_whole_file(file_, "new"));
  EXPECT_EQ(testing::file_text(file_), "new");
}

TEST_F(WholeFileTest, FileThatLacksBytesIsNotFinishedThoughThereIsRoomAgain) {
  auto file = WholeFile::create(file_);
  ASSERT_TRUE(file && file->append("header"));
  {
    const testing::FullDisk full(4'096);
    const Status written = file->append(std::string(100'000, 'x'));
    ASSERT_FALSE(written);
    EXPECT_THAT(written.error().message, HasSubstr(file_.string() + ": cannot be written: "));
  }
  ASSERT_TRUE(file->append("more"));
  EXPECT_FALSE(file->finish());
  EXPECT_FALSE(fs::exists(file_));
}

TEST_F(WholeFileTest, AFullDiskIsNamed) {
  fs::create_symlink("/dev/full", folder_.path() / "map.las.part");
  EXPECT_EQ(write_whole_file(file_, "x").error().message,
            file_.string() + ": cannot be written: No space left on device");
}

TEST_F(WholeFileTest, APlaceThatCannotBeWrittenIsNamed) {
  const fs::path none = folder_.path() / "none" / "a.json";
  EXPECT_EQ(write_whole_file(none, "x").error().message,
            none.string() + ": cannot be written: No such file or directory");
  folder_.write("folder/file", "");
  EXPECT_THAT(write_whole_file(folder_.path() / "folder", "x").error().message, HasSubstr("folder: cannot"));
  EXPECT_FALSE(fs::exists(folder_.path() / "folder.part"));
}

/// --out /dev/stdout
TEST_F(WholeFileTest, SpecialFileIsWrittenInPlace) {
  EXPECT_TRUE(write_whole_file("/dev/null", "x"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  auto stream = WholeFile::create("/dev/null");
  ASSERT_TRUE(stream && stream->append("0 points"));
  EXPECT_FALSE(stream->overwrite("5")) << "a reader would find both headers";
  EXPECT_FALSE(stream->finish());
  EXPECT_THAT(write_whole_file("/dev/full", "x").error().message, HasSubstr("/dev/full: cannot be written"));
}

}  // namespace
}  // namespace fleetmap
