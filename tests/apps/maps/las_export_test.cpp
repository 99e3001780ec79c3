// `fleetmap map export` as LAS: what it refuses, and that its points are those of map.ply at their place on
// Earth.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <GeographicLib/LocalCartesian.hpp>
#include <GeographicLib/UTMUPS.hpp>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "cloud/las_reader.hpp"
#include "fleetmap/cloud/file_io.hpp"
#include "geometry/geoid_file.hpp"
#include "support/command_line.hpp"
#include "support/process.hpp"
#include "support/scene_store.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::LasFile;
using ::testing::Not;
using testing::read_las;

class LasExport : public testing::CommandLineTest {
 protected:
  std::string store(bool located) {
    const std::string file = path(located ? "located.db" : "lost.db");
    auto store = store::Store::open(file, AgentId::parse("r1").value());
    testing::add_scene(*store, located);
    return file;
  }
  /// `fleetmap map export` with the origin of the scene.
  void export_map(const std::string& store, const std::string& out, std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"map", "export", store, "--origin", "49.0,8.4,110", "--out", path(out)});
    run(std::move(more));
  }
};

/// Easting, northing and ellipsoidal height by GeographicLib alone.
Eigen::Vector3d expected(int zone, const Eigen::Vector3f& p) {
  double latitude = 0.0, longitude = 0.0, height = 0.0, x = 0.0, y = 0.0;
  GeographicLib::LocalCartesian(49.0, 8.4, 110.0)
      .Reverse(static_cast<double>(p.x()), static_cast<double>(p.y()), static_cast<double>(p.z()), latitude,
               longitude, height);
  bool north = false;
  GeographicLib::UTMUPS::Forward(latitude, longitude, zone, north, x, y, zone);
  return {x, y, height};
}

TEST_F(LasExport, PointsAreThoseOfThePlyAtTheirPlaceOnEarth) {
  const std::string located = store(true);
  export_map(located, "map.ply");
  ASSERT_EQ(exit_code_, 0) << output_;
  const auto ply = cloud::read_cloud(path("map.ply"));
  ASSERT_TRUE(ply);
  for (const std::string crs : {"utm", "EPSG:32631"}) {
    export_map(located, "map.las", {"--crs", crs});
    ASSERT_EQ(exit_code_, 0) << output_;
    const int zone = crs == "utm" ? 32 : 31;
    EXPECT_THAT(output_, AllOf(HasSubstr("EPSG:326" + std::to_string(zone)), HasSubstr("from 6 submaps"),
                               HasSubstr("above the WGS 84 ellipsoid"),
                               HasSubstr("Heights at the nodes of r2 are as GPS gave them"),
                               HasSubstr("Scale at the origin: ")));
    const LasFile las = read_las(path("map.las"));
    EXPECT_THAT(las.software, HasSubstr("fleetmap "));
    ASSERT_EQ(las.points.size(), ply->size());
    for (std::size_t k = 0; k < ply->size(); ++k)
      EXPECT_LT((las.points[k].position - expected(zone, ply->points[k])).cwiseAbs().maxCoeff(), 0.000501);
  }
  EXPECT_FALSE(fs::exists(path("map.las.part")));
}

TEST_F(LasExport, TilesAddUpToTheWhole) {
  const std::string located = store(true);
  export_map(located, "map.las");
  ASSERT_EQ(exit_code_, 0) << output_;
  const LasFile whole = read_las(path("map.las"));
  export_map(located, "tiles", {"--tile", "50"});
  ASSERT_EQ(exit_code_, 0) << output_;
  std::uint64_t points = 0, files = 0;
  Eigen::Vector3d min = whole.max, max = whole.min;
  for (const auto& entry : fs::directory_iterator(path("tiles"))) {
    const LasFile tile = read_las(entry.path());
    points += tile.count;
    min = min.cwiseMin(tile.min);
    max = max.cwiseMax(tile.max);
    ++files;
  }
  EXPECT_GT(files, 3u);
  EXPECT_EQ(points, whole.count);
  EXPECT_EQ(min, whole.min);
  EXPECT_EQ(max, whole.max);
  EXPECT_THAT(output_, HasSubstr(std::to_string(files) + " files of 50 m"));
  export_map(located, "tiles", {"--tile", "50"});
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_, HasSubstr("tiles: is there already and not empty"));
}

TEST_F(LasExport, AMapThatIsNotGeoreferencedStaysInItsOwnFrame) {
  const std::string lost = store(false);
  export_map(lost, "map.las");
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_,
              AllOf(HasSubstr("lost.db"), HasSubstr("no node of its map has GPS"), HasSubstr("--crs enu")));
  EXPECT_FALSE(fs::exists(path("map.las")));
  export_map(lost, "map.las", {"--crs", "enu"});
  EXPECT_EQ(exit_code_, 0) << output_;
  EXPECT_THAT(output_, HasSubstr("nobody knows where to lay them: r2"));
  const LasFile las = read_las(path("map.las"));
  EXPECT_GT(las.count, 0u);
  EXPECT_THAT(las.wkt(), HasSubstr("unknown"));
  EXPECT_THAT(las.text(), HasSubstr("Nobody knows its place"));
}

TEST_F(LasExport, UnwritableExportsAreRefusedWithTheReason) {
  const std::string located = store(true);
  struct Case {
    std::vector<std::string> more;
    int exit_code;
    std::string says;
  };
  for (const Case& wrong : std::initializer_list<Case>{
           {{"--crs", "EPSG:25832"}, 2, "--crs: EPSG:25832 cannot be written; expected utm"},
           {{"--crs", "gauss"}, 2, "--crs: gauss: no reference system"},
           {{"--tile", "0"}, 2, "--tile: must be a whole number from 1 to"},
           {{"--crs", "EPSG:32701"}, 1, "its own zone is EPSG:32632"},
           {{"--crs", "enu", "--geoid", "none-1"}, 1, "geographiclib-get-geoids none-1"},
           {{"--geoid", "../x"}, 1, "no name of a geoid"}}) {
    export_map(located, "map.las", wrong.more);
    EXPECT_EQ(exit_code_, wrong.exit_code) << wrong.says;
    EXPECT_THAT(output_, HasSubstr(wrong.says));
  }
  export_map(located, "map.ply", {"--crs", "utm"});
  EXPECT_EQ(exit_code_, 2);
  EXPECT_THAT(output_, HasSubstr("map.ply: --crs and --geoid are of LAS"));
  fs::create_symlink("/dev/full", path("map.las.part"));
  export_map(located, "map.las");
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_, AllOf(HasSubstr("map.las: cannot be written"), HasSubstr("No space left"),
                             Not(HasSubstr("located.db"))));
  export_map(located, "no/folder/map.las");
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_, AllOf(HasSubstr("folder/map.las: cannot be written"), Not(HasSubstr("located.db"))));
  for (const char* file : {"map.las", "map.ply"}) EXPECT_FALSE(fs::exists(path(file))) << file;
}

TEST_F(LasExport, HeightsAreAboveTheGeoidThatIsAskedFor) {
  const std::string located = store(true);
  testing::write_sloped_geoid(folder_.path(), "egm96-15");
  export_map(located, "map.las");
  const LasFile ellipsoidal = read_las(path("map.las"));
  setenv("GEOGRAPHICLIB_GEOID_PATH", folder_.path().c_str(), 1);
  export_map(located, "map.las", {"--geoid", "egm96-15"});
  unsetenv("GEOGRAPHICLIB_GEOID_PATH");
  ASSERT_EQ(exit_code_, 0) << output_;
  const LasFile above_geoid = read_las(path("map.las"));
  ASSERT_EQ(above_geoid.points.size(), ellipsoidal.points.size());
  for (std::size_t k = 0; k < above_geoid.points.size(); ++k)
    EXPECT_NEAR(ellipsoidal.points[k].position.z() - above_geoid.points[k].position.z(), 4.9, 0.0012);
  EXPECT_THAT(above_geoid.wkt(), HasSubstr("VERT_CS[\"EGM96 height\""));
  EXPECT_THAT(ellipsoidal.wkt(), HasSubstr("VERT_DATUM[\"Ellipsoid\",2002]"));
}

/// Latitude, longitude (deg) and height by GDAL, which uses PROJ; empty where gdal-bin is not installed.
std::vector<Eigen::Vector3d> by_gdal(const fs::path& folder, const LasFile& las, std::size_t every) {
  constexpr const char* kProgram = "/usr/bin/gdaltransform";
  std::vector<Eigen::Vector3d> places;
  if (access(kProgram, X_OK) != 0) return places;
  std::ofstream points(folder / "points.txt");
  points.precision(12);
  for (std::size_t k = 0; k < las.points.size(); k += every) {
    const Eigen::Vector3d& p = las.points[k].position;
    points << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
  }
  points.close();
  std::ofstream(folder / "crs.wkt") << las.wkt();
  testing::Process process({"/bin/sh", "-c",
                            std::string(kProgram) + " -s_srs '" + (folder / "crs.wkt").string() +
                                "' -t_srs EPSG:4979 < '" + (folder / "points.txt").string() + "'"});
  EXPECT_EQ(process.wait(), 0) << process.output();
  std::istringstream lines(process.output());
  for (Eigen::Vector3d place; lines >> place.y() >> place.x() >> place.z();) places.push_back(place);
  return places;
}

TEST_F(LasExport, GdalFindsThePointsWhereTheyAre) {
  const std::string located = store(true);
  export_map(located, "map.las");
  export_map(located, "map.ply");
  const auto ply = cloud::read_cloud(path("map.ply"));
  ASSERT_TRUE(ply);
  constexpr std::size_t kEvery = 50;
  const auto places = by_gdal(folder_.path(), read_las(path("map.las")), kEvery);
  if (places.empty()) GTEST_SKIP() << "gdaltransform is not installed";
  ASSERT_EQ(places.size(), (ply->size() + kEvery - 1) / kEvery);
  const LocalFrame enu(testing::kSceneOrigin);
  for (std::size_t k = 0; k < places.size(); ++k) {
    const GeoPoint place = geo_point_from_degrees(places[k].x(), places[k].y(), places[k].z());
    EXPECT_LT((enu.to_enu(place) - ply->points[k * kEvery].cast<double>()).norm(), 0.002);
  }
}

}  // namespace
}  // namespace fleetmap
