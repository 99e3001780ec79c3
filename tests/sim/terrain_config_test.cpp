#include "fleetmap/sim/terrain_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::sim {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kNaN;

TEST(TerrainConfig, NumbersLieInTheirRanges) {
  TerrainConfig flat;
  flat.rolling_amplitude = flat.rough_amplitude = 0.0;
  expect_accepted(flat, &TerrainConfig::rolling_wavelength, {5.0, 1e5});
  expect_accepted(flat, &TerrainConfig::rough_wavelength, {0.5, 100.0});
  expect_refused(flat, &TerrainConfig::rolling_amplitude, {-0.1, 100.1, kNaN<double>}, "rolling_amplitude");
  expect_refused(flat, &TerrainConfig::rolling_wavelength, {4.9, 1.1e5, kNaN<double>}, "rolling_wavelength");
  expect_refused(flat, &TerrainConfig::rough_amplitude, {-0.01, 1.1, kNaN<double>}, "rough_amplitude");
  expect_refused(flat, &TerrainConfig::rough_wavelength, {0.4, 101.0, kNaN<double>}, "rough_wavelength");
  for (double TerrainConfig::*slope : {&TerrainConfig::slope_east_rad, &TerrainConfig::slope_north_rad}) {
    expect_accepted(flat, slope, {-0.52, 0.52});
    expect_refused(flat, slope, {-0.53, 0.53, kNaN<double>}, "slopes");
  }
}

TEST(TerrainConfig, NoPlaceIsSteeperThan45Degrees) {
  TerrainConfig hills;
  hills.rough_amplitude = 0.0;
  hills.rolling_wavelength = 24.0;  // the steepest place then rises as much a metre as the amplitude is
  expect_accepted(hills, &TerrainConfig::rolling_amplitude, {0.999});
  expect_refused(hills, &TerrainConfig::rolling_amplitude, {1.001}, "45 deg");
  hills.rolling_amplitude = 0.9;
  expect_refused(hills, &TerrainConfig::slope_east_rad, {0.11, -0.11}, "45 deg");
}

}  // namespace
}  // namespace fleetmap::sim
