#include "twin/world_making.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "fleetmap/config/world_file.hpp"
#include "fleetmap/sim/mesh_file.hpp"
#include "support/file_content.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::HasSubstr;

const std::string kFarm = FLEETMAP_SOURCE_DIR "/config/worlds/farm_44.yaml";

class WorldMakingTest : public ::testing::Test {
 protected:
  static WorldOptions described(const std::string& file) {
    WorldOptions options;
    options.file = file;
    return options;
  }
  WorldOptions options_of(const std::string& folder, std::optional<std::uint64_t> seed = {}) const {
    WorldOptions options = described(kFarm);
    options.out = (folder_.path() / folder).string();
    options.seed = seed;
    options.files.density = 2.0;
    return options;
  }
  std::string mesh_of(const std::string& folder) const {
    return testing::file_text(folder_.path() / folder / "world.obj");
  }
  testing::TemporaryFolder folder_;
};

TEST_F(WorldMakingTest, WithoutAFolderItIsOnlyDescribed) {
  std::ostringstream out;
  EXPECT_EQ(make_world(described(kFarm), out).value(), kDone);
  EXPECT_NE(out.str(), "");
}

TEST_F(WorldMakingTest, TheSeedOfTheCommandLineReplacesThatOfTheFile) {
  std::ostringstream out;
  ASSERT_TRUE(make_world(options_of("own"), out) && make_world(options_of("same"), out) &&
              make_world(options_of("other", 77), out));
  EXPECT_NE(mesh_of("own"), "");
  EXPECT_EQ(mesh_of("own"), mesh_of("same"));
  EXPECT_NE(mesh_of("own"), mesh_of("other"));
}

TEST_F(WorldMakingTest, FilesThatCannotBeReadOrWrittenHaveCodesOfTheirOwn) {
  std::ostringstream out;
  const auto missing = make_world(described("none.yaml"), out);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, kBadConfiguration);
  EXPECT_THAT(missing.error().error.message, HasSubstr("none.yaml"));
  folder_.write("file", "no folder");
  const auto unwritable = make_world(options_of("file/out"), out);
  ASSERT_FALSE(unwritable);
  EXPECT_EQ(unwritable.error().code, kFailed);
  EXPECT_THAT(unwritable.error().error.message, HasSubstr("file/out"));
}

}  // namespace
}  // namespace fleetmap::apps
