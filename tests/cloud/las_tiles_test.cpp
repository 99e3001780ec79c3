#include "fleetmap/cloud/las_tiles.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <string>

#include "cloud/las_reader.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::cloud {
namespace {

namespace fs = std::filesystem;
using fleetmap::testing::read_las;
using ::testing::HasSubstr;

class LasTilesTest : public ::testing::Test {
 protected:
  LasTilesTest() : description_(std::make_shared<LasDescription>()) {
    description_->offset = {431'000, 5'400'000, 0};
  }
  static LasPoint at(double east, double north, std::uint16_t mark = 0) {
    return {{east, north, 1.0}, mark, 0};
  }
  static std::set<std::string> names_in(const fs::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename().string());
    return names;
  }

  fleetmap::testing::TemporaryFolder folder_;
  std::shared_ptr<LasDescription> description_;
  const fs::path out_ = folder_.path() / "tiles";
};

TEST_F(LasTilesTest, ASquareHoldsItsSouthAndWestBorderAndNotTheOthers) {
  auto tiles = LasTiles::create(out_, 100, description_);
  ASSERT_TRUE(tiles) << tiles.error().message;
  // 0.4 mm below a border is stored on it.
  const std::vector<LasPoint> first{at(431'600, 5'400'000, 1), at(431'699.999, 5'400'099.999, 2),
                                    at(431'700, 5'400'000, 3), at(431'699.9996, 5'400'050, 4)};
  const std::vector<LasPoint> second{at(431'650, 5'399'999.999, 5), at(431'650, 5'400'050, 6)};
  ASSERT_TRUE(tiles->add(first) && tiles->add(second));
  EXPECT_FALSE(fs::exists(out_)) << "before it is whole";
  ASSERT_TRUE(tiles->finish());
  EXPECT_EQ(names_in(out_),
            (std::set<std::string>{"431600_5400000.las", "431700_5400000.las", "431600_5399900.las"}));
  EXPECT_EQ(tiles->files(), 3u);
  EXPECT_EQ(tiles->points(), 6u);
  const auto marks = [&](const char* name) {
    std::vector<int> marks;
    for (const auto& point : read_las(out_ / name).points) marks.push_back(point.intensity);
    return marks;
  };
  EXPECT_EQ(marks("431600_5400000.las"), (std::vector{1, 2, 6}));
  EXPECT_EQ(marks("431700_5400000.las"), (std::vector{3, 4}));
  EXPECT_EQ(marks("431600_5399900.las"), (std::vector{5}));
  EXPECT_EQ(names_in(folder_.path()), std::set<std::string>{"tiles"}) << "nothing else is left";
}

TEST_F(LasTilesTest, NegativeCoordinatesAreRoundedDown) {
  description_->offset = {0, 0, 0};
  auto tiles = LasTiles::create(out_ / "", 50, description_);  // a separator at the end
  ASSERT_TRUE(tiles && tiles->add(std::vector{at(-0.001, -50.0), at(0.0, -50.001)}) && tiles->finish());
  EXPECT_EQ(names_in(out_), (std::set<std::string>{"-50_-50.las", "0_-100.las"}));
}

TEST_F(LasTilesTest, APointThatIsNoneIsLeftOutAndCounted) {
  auto tiles = LasTiles::create(out_, 50, description_);
  const std::vector points{at(std::numeric_limits<double>::quiet_NaN(), 0.0), at(1e9, 0.0),
                           at(431'000, 5'400'000)};
  ASSERT_TRUE(tiles && tiles->add(points) && tiles->finish());
  EXPECT_EQ(tiles->left_out(), 2u);
  EXPECT_EQ(tiles->points(), 1u);
  EXPECT_EQ(tiles->files(), 1u);
}

TEST_F(LasTilesTest, AnEmptyMapIsAnEmptyFolder) {
  fs::create_directory(out_);  // one that is empty may be there
  auto tiles = LasTiles::create(out_, 50, description_);
  ASSERT_TRUE(tiles && tiles->finish());
  EXPECT_TRUE(names_in(out_).empty());
}

TEST_F(LasTilesTest, ExistingFilesAreNotTouched) {
  folder_.write("tiles/other.las", "");
  EXPECT_THAT(LasTiles::create(out_, 50, description_).error().message,
              AllOf(HasSubstr("tiles"), HasSubstr("not empty")));
  fs::remove_all(out_);
  fs::create_directory(folder_.path() / "tiles.part");
  EXPECT_THAT(LasTiles::create(out_, 50, description_).error().message,
              AllOf(HasSubstr("tiles.part"), HasSubstr("cut off")));
  EXPECT_TRUE(fs::exists(folder_.path() / "tiles.part"));
  EXPECT_FALSE(LasTiles::create(folder_.path() / "none" / "tiles", 50, description_));
  EXPECT_FALSE(LasTiles::create(folder_.path() / "new", 0, description_));
}

TEST_F(LasTilesTest, UnfinishedFileLeavesNothing) {
  {
    auto tiles = LasTiles::create(out_, 50, description_);
    ASSERT_TRUE(tiles && tiles->add(std::vector{at(431'000, 5'400'000)}));
    const LasTiles moved = std::move(*tiles);
    EXPECT_EQ(names_in(folder_.path()), std::set<std::string>{"tiles.part"});
  }
  EXPECT_TRUE(names_in(folder_.path()).empty());
}

TEST_F(LasTilesTest, AFileThatCannotBeWrittenIsNamed) {
  auto tiles = LasTiles::create(out_, 50, description_);
  ASSERT_TRUE(tiles);
  fs::create_symlink("/dev/full", folder_.path() / "tiles.part" / "431000_5400000.las.part");
  const Status added = tiles->add(std::vector{at(431'000, 5'400'000)});
  ASSERT_FALSE(added);
  EXPECT_THAT(added.error().message, AllOf(HasSubstr("431000_5400000.las"), HasSubstr("No space left")));
}

}  // namespace
}  // namespace fleetmap::cloud
