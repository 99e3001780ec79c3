#include "geotiff_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace fleetmap::output {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(GeoTiffWriter, WithoutItsModuleSaysWhatToInstall) {
  const testing::TemporaryFolder folder;
  const auto missing = GeoTiffWriter::load(folder.path() / "none.so");
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().message, AllOf(HasSubstr("none.so"), HasSubstr("libgdal-dev")));
  const auto damaged = GeoTiffWriter::load(folder.write("damaged.so", "no library"));
  ASSERT_FALSE(damaged);
  EXPECT_THAT(damaged.error().message, HasSubstr("damaged.so"));
}

TEST(GeoTiffWriter, LooksForItBesideTheProgram) {
  EXPECT_EQ(GeoTiffWriter::module_file(),
            std::filesystem::path(FLEETMAP_BINARY_DIR) / "lib/fleetmap/libfleetmap_geotiff.so");
}

}  // namespace
}  // namespace fleetmap::output
