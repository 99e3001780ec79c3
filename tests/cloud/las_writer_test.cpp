#include "fleetmap/cloud/las_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <vector>

#include "cloud/las_reader.hpp"
#include "support/full_disk.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::cloud {
namespace {

namespace fs = std::filesystem;
using fleetmap::testing::LasFile;
using fleetmap::testing::read_las;
using ::testing::HasSubstr;

std::vector<LasPoint> random_las_points(std::size_t count) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> metres(-500.0, 500.0);
  std::vector<LasPoint> points;
  for (std::size_t k = 0; k < count; ++k) {
    points.push_back({{432'000 + metres(random), 5'400'000 + metres(random), metres(random)},
                      static_cast<std::uint16_t>(k),
                      static_cast<std::uint16_t>(k % 3)});
  }
  return points;
}

class LasWriterTest : public ::testing::Test {
 protected:
  LasWriterTest() : description_(std::make_shared<LasDescription>()) {
    description_->wkt = "PROJCS[\"somewhere\"]";
    description_->offset = {432'000, 5'400'000, 0};
  }
  std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator{}));
  }

  fleetmap::testing::TemporaryFolder folder_;
  std::shared_ptr<LasDescription> description_;
  const fs::path file_ = folder_.path() / "map.las";
};

TEST_F(LasWriterTest, PiecesMakeTheFileOfTheWhole) {
  const std::vector<LasPoint> points = random_las_points(70'000);  // more than one block
  const std::span all(points);
  auto streamed = LasWriter::create(file_, description_);
  ASSERT_TRUE(streamed) << streamed.error().message;
  for (const auto& piece : {all.first(9), all.first(0), all.subspan(9, 69'000), all.subspan(69'009)})
    ASSERT_TRUE(streamed->add(piece));
  EXPECT_FALSE(fs::exists(file_)) << "before it is whole";
  ASSERT_TRUE(streamed->finish());
  const LasFile back = read_las(file_);
  ASSERT_EQ(back.points.size(), points.size());
  EXPECT_EQ(back.count, points.size());
  EXPECT_EQ(streamed->points(), points.size());
  Eigen::Vector3d min = back.points[0].position, max = min;
  for (std::size_t k = 0; k < points.size(); ++k) {
    EXPECT_LT((back.points[k].position - points[k].position).cwiseAbs().maxCoeff(), 0.000501);
    EXPECT_EQ(back.points[k].intensity, points[k].intensity);
    EXPECT_EQ(back.points[k].source, points[k].source);
    min = min.cwiseMin(back.points[k].position);
    max = max.cwiseMax(back.points[k].position);
  }
  EXPECT_EQ(back.min, min);
  EXPECT_EQ(back.max, max);
  auto whole = LasWriter::create(folder_.path() / "whole.las", description_);
  ASSERT_TRUE(whole && whole->add(points) && whole->finish());
  EXPECT_TRUE(read_las(folder_.path() / "whole.las").bytes == back.bytes);
  EXPECT_EQ(files(), 2u) << "nothing else is left";
}

TEST_F(LasWriterTest, APointThatIsNoneIsLeftOutAndCounted) {
  std::vector<LasPoint> points = random_las_points(4);
  points[1].position.y() = std::numeric_limits<double>::quiet_NaN();
  points[2].position.z() = 1e12;
  auto writer = LasWriter::create(file_, description_);
  ASSERT_TRUE(writer && writer->add(points) && writer->finish());
  EXPECT_EQ(writer->left_out(), 2u);
  const LasFile back = read_las(file_);
  ASSERT_EQ(back.points.size(), 2u);
  EXPECT_EQ(back.count, 2u);
  EXPECT_EQ(back.points[1].intensity, points[3].intensity);
  EXPECT_LT(back.max.z(), 500.0);
}

TEST_F(LasWriterTest, AnEmptyMapIsAFileWithoutPoints) {
  auto writer = LasWriter::create(file_, description_);
  ASSERT_TRUE(writer && writer->finish());
  EXPECT_EQ(read_las(file_).count, 0u);
  EXPECT_TRUE(read_las(file_).points.empty());
}

TEST_F(LasWriterTest, AFullDiskIsAnErrorThatNamesTheFileWhichStays) {
  auto before = LasWriter::create(file_, description_);
  ASSERT_TRUE(before && before->add(random_las_points(10)) && before->finish());
  fs::create_symlink("/dev/full", folder_.path() / "map.las.part");
  const auto writer = LasWriter::create(file_, description_);
  ASSERT_FALSE(writer);
  EXPECT_THAT(writer.error().message, AllOf(HasSubstr("map.las"), HasSubstr("No space left")));
  EXPECT_EQ(read_las(file_).count, 10u);
  EXPECT_EQ(files(), 1u);
}

TEST_F(LasWriterTest, CannotFinishAFileThatLacksPointsThoughThereIsRoomAgain) {
  auto writer = LasWriter::create(file_, description_);
  ASSERT_TRUE(writer);
  {
    const fleetmap::testing::FullDisk full(4'096);
    const Status added = writer->add(random_las_points(1'000));
    ASSERT_FALSE(added);
    EXPECT_THAT(added.error().message, AllOf(HasSubstr("map.las"), HasSubstr("File too large")));
  }
  EXPECT_FALSE(writer->finish());
  EXPECT_FALSE(fs::exists(file_));
}

TEST_F(LasWriterTest, UnfinishedFileLeavesNothing) {
  {
    auto writer = LasWriter::create(file_, description_);
    ASSERT_TRUE(writer && writer->add(random_las_points(10)));
    const LasWriter moved = std::move(*writer);
    EXPECT_EQ(files(), 1u);
  }
  EXPECT_EQ(files(), 0u);
}

TEST_F(LasWriterTest, AFolderThatIsNotThereIsNamed) {
  const auto writer = LasWriter::create(folder_.path() / "none" / "map.las", description_);
  ASSERT_FALSE(writer);
  EXPECT_THAT(writer.error().message, AllOf(HasSubstr("map.las"), HasSubstr("No such file")));
}

}  // namespace
}  // namespace fleetmap::cloud
