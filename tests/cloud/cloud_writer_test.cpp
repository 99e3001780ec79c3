#include "fleetmap/cloud/cloud_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "cloud/scenes.hpp"
#include "fleetmap/cloud/file_io.hpp"
#include "support/file_content.hpp"
#include "support/full_disk.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::cloud {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::size_t files_in(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator{}));
}

PointCloud piece(const PointCloud& cloud, std::size_t begin, std::size_t end) {
  std::vector<std::size_t> indices;
  for (std::size_t i = begin; i < end; ++i) indices.push_back(i);
  return select(cloud, indices);
}

TEST(CloudWriter, PiecesMakeTheFileOfTheWhole) {
  const fleetmap::testing::TemporaryFolder folder;
  for (const bool intensities : {false, true}) {
    PointCloud cloud = testing::street_scene(70'000, 1);  // more than one block
    if (!intensities) cloud.intensities.clear();
    for (const std::string extension : {".ply", ".pcd"}) {
      const fs::path streamed = folder.path() / ("streamed" + extension);
      auto writer = CloudWriter::create(streamed, intensities);
      ASSERT_TRUE(writer) << writer.error().message;
      for (const auto& [begin, end] : {std::pair{0, 9}, {9, 9}, {9, 69'000}, {69'000, 70'000}})
        ASSERT_TRUE(
            writer->add(piece(cloud, static_cast<std::size_t>(begin), static_cast<std::size_t>(end))));
      EXPECT_FALSE(fs::exists(streamed)) << "before it is whole";
      ASSERT_TRUE(writer->finish());
      const auto back = read_cloud(streamed);
      ASSERT_TRUE(back) << back.error().message;
      EXPECT_EQ(back->points, cloud.points);
      EXPECT_EQ(back->intensities, cloud.intensities);
      const fs::path whole = folder.path() / ("whole" + extension);
      ASSERT_TRUE(write_cloud(whole, cloud));
      EXPECT_TRUE(fleetmap::testing::file_text(streamed) == fleetmap::testing::file_text(whole)) << extension;
      const std::string count = extension == ".ply" ? "\nelement vertex 70000\n" : "\nPOINTS 70000\n";
      EXPECT_THAT(fleetmap::testing::file_text(streamed).substr(0, 400), HasSubstr(count));
      fs::remove(streamed);
      fs::remove(whole);
    }
  }
  EXPECT_EQ(files_in(folder.path()), 0u) << "nothing else is left";
}

TEST(CloudWriter, CommentsAreLinesOfTheHeaderThatReadersSkip) {
  const fleetmap::testing::TemporaryFolder folder;
  const PointCloud cloud = testing::street_scene(100, 7);
  for (const std::string name : {"map.ply", "map.pcd"}) {
    auto writer = CloudWriter::create(folder.path() / name, true, {"DATA of one place", "element 2"});
    ASSERT_TRUE(writer && writer->add(cloud) && writer->finish());
    const std::string mark = name == "map.ply" ? "\ncomment " : "\n# ";
    EXPECT_THAT(fleetmap::testing::file_text(folder.path() / name),
                HasSubstr(mark + "DATA of one place" + mark + "element 2\n"));
    const auto back = read_cloud(folder.path() / name);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->points, cloud.points);
  }
}

TEST(CloudWriter, AFullDiskIsAnErrorThatNamesTheFile) {
  const fleetmap::testing::TemporaryFolder folder;
  const fs::path file = folder.path() / "map.ply";
  ASSERT_TRUE(write_cloud(file, testing::street_scene(10, 2)));
  const std::string before = fleetmap::testing::file_text(file);
  for (const int points : {10, 100'000}) {  // fails in finish(), and in add()
    fs::create_symlink("/dev/full", folder.path() / "map.ply.part");
    const Status written = write_cloud(file, testing::street_scene(points, 3));
    ASSERT_FALSE(written);
    EXPECT_THAT(written.error().message, AllOf(HasSubstr("map.ply"), HasSubstr("No space left")));
    EXPECT_TRUE(fleetmap::testing::file_text(file) == before);
    EXPECT_EQ(files_in(folder.path()), 1u);
  }
}

TEST(CloudWriter, CannotFinishAFileThatLacksPointsThoughThereIsRoomAgain) {
  const fleetmap::testing::TemporaryFolder folder;
  auto writer = CloudWriter::create(folder.path() / "map.pcd", true);
  ASSERT_TRUE(writer);
  {
    const fleetmap::testing::FullDisk full(4'096);
    EXPECT_FALSE(writer->add(testing::street_scene(100'000, 4)));
  }
  EXPECT_FALSE(writer->finish());
  EXPECT_FALSE(fs::exists(folder.path() / "map.pcd"));
}

TEST(CloudWriter, UnfinishedFileLeavesNothing) {
  const fleetmap::testing::TemporaryFolder folder;
  {
    auto writer = CloudWriter::create(folder.path() / "map.pcd", true);
    ASSERT_TRUE(writer);
    ASSERT_TRUE(writer->add(testing::street_scene(10, 5)));
    EXPECT_EQ(files_in(folder.path()), 1u);
  }
  EXPECT_EQ(files_in(folder.path()), 0u);
}

TEST(CloudWriter, RefusesWhatItCannotWrite) {
  const fleetmap::testing::TemporaryFolder folder;
  EXPECT_THAT(CloudWriter::create(folder.path() / "map.xyz", true).error().message, HasSubstr("map.xyz"));
  EXPECT_THAT(CloudWriter::create(folder.path() / "none" / "map.ply", true).error().message,
              AllOf(HasSubstr("map.ply"), HasSubstr("No such file")));
  auto writer = CloudWriter::create(folder.path() / "map.ply", true);
  PointCloud without = testing::street_scene(10, 6);
  without.intensities.clear();
  EXPECT_THAT(writer->add(without).error().message, HasSubstr("map.ply"));
  EXPECT_TRUE(writer->add(PointCloud{}));
}

}  // namespace
}  // namespace fleetmap::cloud
