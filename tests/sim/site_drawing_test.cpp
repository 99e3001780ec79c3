#include "fleetmap/sim/site_drawing.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace fleetmap::sim {
namespace {

SiteDrawing square() {
  SiteDrawing drawing;
  for (double y = -40.0; y <= 40.0; y += 10.0) {
    drawing.lanes.push_back({{-45.0, y}, {45.0, y}});
    drawing.keep_out.push_back({{-40.0, y + 3.0}, {40.0, y + 3.0}, {40.0, y + 7.0}, {-40.0, y + 7.0}});
  }
  drawing.boundary = {{-50.0, -50.0}, {50.0, -50.0}, {50.0, 50.0}, {-50.0, 50.0}};
  drawing.marks = {{-45.0, -48.0}};
  return drawing;
}

TEST(SiteDrawing, WithoutErrorItIsAsItWas) {
  const SiteDrawing drawing = square();
  const SiteDrawing same = with_position_error(drawing, 0.0, 3);
  EXPECT_EQ(same.keep_out, drawing.keep_out);
  EXPECT_EQ(same.boundary, drawing.boundary);
  EXPECT_EQ(same.lanes[2].to, drawing.lanes[2].to);
}

TEST(SiteDrawing, ItIsOffByTheErrorAllOver) {
  const SiteDrawing drawing = square();
  for (const double error : {0.5, 2.0}) {
    Eigen::Vector2d mean_direction = Eigen::Vector2d::Zero();
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
      const SiteDrawing off = with_position_error(drawing, error, seed);
      Eigen::Vector2d mean = Eigen::Vector2d::Zero();
      for (std::size_t k = 0; k < 4; ++k) {
        const Eigen::Vector2d shift = off.boundary[k] - drawing.boundary[k];
        EXPECT_LE(shift.norm(), 1.301 * error);
        EXPECT_GE(shift.norm(), 0.699 * error);
        mean += 0.25 * shift;
      }
      EXPECT_NEAR(mean.norm(), error, 1e-9) << "the turn is about the middle";
      mean_direction += mean / error / 200.0;
      double relative = 0.0;  // between a lane and the tables beside it
      for (std::size_t k = 0; k < drawing.lanes.size(); ++k) {
        const Eigen::Vector2d before = drawing.keep_out[k][0] - drawing.lanes[k].from;
        const Eigen::Vector2d after = off.keep_out[k][0] - off.lanes[k].from;
        relative = std::max(relative, (after - before).norm());
      }
      EXPECT_GT(relative, 0.05 * error);
      EXPECT_LT(relative, 0.65 * error);
      EXPECT_LE((off.marks[0] - drawing.marks[0]).norm(), 1.301 * error);
    }
    EXPECT_LT(mean_direction.norm(), 0.25) << "into all directions";
  }
}

TEST(SiteDrawing, TheSameSeedGivesTheSameAnotherAnother) {
  const SiteDrawing a = with_position_error(square(), 0.5, 7);
  EXPECT_EQ(a.keep_out, with_position_error(square(), 0.5, 7).keep_out);
  EXPECT_NE(a.keep_out, with_position_error(square(), 0.5, 8).keep_out);
}

}  // namespace
}  // namespace fleetmap::sim
