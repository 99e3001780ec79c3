#include "fleetmap/geometry/geoid.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>

#include "geometry/geoid_file.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class GeoidTest : public ::testing::Test {
 protected:
  GeoidTest() { setenv("GEOGRAPHICLIB_GEOID_PATH", folder_.path().c_str(), 1); }
  ~GeoidTest() override { unsetenv("GEOGRAPHICLIB_GEOID_PATH"); }
  testing::TemporaryFolder folder_;
};

TEST_F(GeoidTest, InterpolatesItsData) {
  testing::write_sloped_geoid(folder_.path(), "slope-1");
  const auto geoid = Geoid::load("slope-1");
  ASSERT_TRUE(geoid) << geoid.error().message;
  EXPECT_EQ(geoid->name(), "slope-1");
  for (const double latitude : {-20.0, 0.0, 8.25, 40.0}) {
    const auto undulation = geoid->undulation(geo_point_from_degrees(latitude, -3.0, 700.0));
    ASSERT_TRUE(undulation);
    EXPECT_NEAR(*undulation, 0.1 * latitude, 1e-9);
  }
}

TEST_F(GeoidTest, DataThatIsMissingOrCutOffIsAnErrorWithItsRemedy) {
  for (const bool cut_off : {false, true}) {
    if (cut_off) {
      testing::write_sloped_geoid(folder_.path(), "egm2008-5");
      std::filesystem::resize_file(folder_.path() / "egm2008-5.pgm", 100);
    }
    const auto geoid = Geoid::load("egm2008-5");
    ASSERT_FALSE(geoid) << cut_off;
    EXPECT_THAT(geoid.error().message, AllOf(HasSubstr((folder_.path() / "egm2008-5.pgm").string()),
                                             HasSubstr("geographiclib-get-geoids egm2008-5"),
                                             HasSubstr("GEOGRAPHICLIB_GEOID_PATH")));
  }
}

TEST_F(GeoidTest, ANameIsNoPath) {
  testing::write_sloped_geoid(folder_.path(), "slope");
  for (const char* name : {"", "../slope", "a b", "slope.pgm", "slope\""})
    EXPECT_THAT(Geoid::load(name).error().message, HasSubstr("no name of a geoid")) << name;
}

TEST_F(GeoidTest, APlaceThatIsNoneHasNone) {
  testing::write_sloped_geoid(folder_.path(), "slope");
  const auto geoid = Geoid::load("slope");
  ASSERT_TRUE(geoid);
  EXPECT_FALSE(geoid->undulation({std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0}));
}

}  // namespace
}  // namespace fleetmap
