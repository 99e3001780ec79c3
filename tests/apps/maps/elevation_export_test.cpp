// `fleetmap map export --format geotiff`: what it writes and refuses. Heights are checked by
// elevation_map_test.cpp.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "support/command_line.hpp"
#include "support/scene_store.hpp"

namespace fleetmap {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class ElevationExport : public testing::CommandLineTest {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(FLEETMAP_BINARY_DIR "/lib/fleetmap/libfleetmap_geotiff.so"))
      GTEST_SKIP() << "built without GDAL";
  }
  std::string store(bool located) {
    const std::string file = path(located ? "located.db" : "lost.db");
    auto store = store::Store::open(file, AgentId::parse("r1").value());
    testing::add_scene(*store, located);
    return file;
  }
  void export_rasters(const std::string& store, std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"map", "export", store, "--origin", "49.0,8.4,110", "--format", "geotiff",
                               "--out", path("rasters")});
    run(std::move(more));
  }
};

TEST_F(ElevationExport, WritesThreeRastersAndSaysWhatTheirHeightsAre) {
  export_rasters(store(true), {"--cell", "1"});
  ASSERT_EQ(exit_code_, 0) << output_;
  EXPECT_THAT(output_,
              AllOf(HasSubstr("ground.tif, surface.tif, hillshade.tif of "), HasSubstr("cells of 1 m"),
                    HasSubstr("EPSG:32632"), HasSubstr("above the WGS 84 ellipsoid")));
  for (const char* file : {"ground.tif", "surface.tif", "hillshade.tif"})
    EXPECT_GT(std::filesystem::file_size(path("rasters") + "/" + file), 100u) << file;
}

TEST_F(ElevationExport, GdalsOwnProgramReadsThem) {
  if (!std::filesystem::exists("/usr/bin/gdalinfo")) GTEST_SKIP() << "gdalinfo is not installed (gdal-bin)";
  export_rasters(store(true), {"--crs", "EPSG:32631"});
  ASSERT_EQ(exit_code_, 0) << output_;
  testing::Process info({"/usr/bin/gdalinfo", "-stats", path("rasters") + "/ground.tif"});
  ASSERT_EQ(info.wait(), 0) << info.output();
  EXPECT_THAT(info.output(), AllOf(HasSubstr("WGS 84 / UTM zone 31N"), HasSubstr("Pixel Size = (0.5"),
                                   HasSubstr("NoData Value=-9999"), HasSubstr("COMPRESSION=DEFLATE")));
}

TEST_F(ElevationExport, AMapThatIsNotGeoreferencedStaysInItsOwnFrame) {
  const std::string lost = store(false);
  export_rasters(lost);
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_, AllOf(HasSubstr("no node of its map has GPS"), HasSubstr("--crs enu")));
  EXPECT_FALSE(std::filesystem::exists(path("rasters")));
  export_rasters(lost, {"--crs", "enu"});
  EXPECT_EQ(exit_code_, 0) << output_;
  EXPECT_THAT(output_, HasSubstr("nobody knows where to lay them: r2"));
}

TEST_F(ElevationExport, AFolderThatCannotBeMadeIsNamedAndNotTheStore) {
  const std::string located = store(true);
  folder_.write("rasters", "a file");
  export_rasters(located);
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_, AllOf(HasSubstr("rasters: "), Not(HasSubstr("located.db"))));
}

TEST_F(ElevationExport, UnsuitableOptionsAreRefused) {
  const std::string located = store(true);
  export_rasters(located, {"--tile", "50"});
  EXPECT_EQ(exit_code_, 2);
  EXPECT_THAT(output_, HasSubstr("--tile is of LAS"));
  export_rasters(located, {"--cell", "0"});
  EXPECT_EQ(exit_code_, 2);
  EXPECT_THAT(output_, AllOf(HasSubstr("--cell: must be a number from 0.05"), Not(HasSubstr("located.db"))));
  expect_usage_error({"map", "export", located, "--out", path("a.las"), "--cell", "1"}, "--format geotiff");
  expect_usage_error({"map", "export", located, "--out", path("a"), "--format", "png"}, "--format");
}

}  // namespace
}  // namespace fleetmap
