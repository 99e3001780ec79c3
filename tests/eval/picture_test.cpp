#include "fleetmap/eval/picture.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fleetmap::eval {
namespace {

/// A grid of points 20 m x 10 m with a block on it.
cloud::PointCloud scene() {
  cloud::PointCloud cloud;
  for (int x = 0; x < 200; ++x) {
    for (int y = 0; y < 100; ++y) {
      const bool block = x > 80 && x < 120 && y > 40 && y < 60;
      cloud.points.emplace_back(0.1f * static_cast<float>(x), 0.1f * static_cast<float>(y),
                                block ? 2.0f : 0.0f);
    }
  }
  return cloud;
}

std::size_t count(const Image& image, Rgb colour) {
  return static_cast<std::size_t>(std::count(image.pixels.begin(), image.pixels.end(), colour));
}

View small(Projection projection) {
  View view;
  view.projection = projection;
  view.width = 320;
  view.height = 200;
  view.shading = 0.0;
  view.scale_bar = false;
  view.point_size = 0.12;
  return view;
}

TEST(Picture, from_above_shows_east_to_the_right_and_north_up) {
  const cloud::PointCloud cloud = scene();
  std::vector<Rgb> colours;
  for (const auto& p : cloud.points)
    colours.push_back(p.x() < 10.0f ? (p.y() < 5.0f ? Rgb{255, 0, 0} : Rgb{0, 255, 0}) : Rgb{0, 0, 255});
  const auto image = render(cloud, colours, small(Projection::kTop));
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->at(60, 150), (Rgb{255, 0, 0}));
  EXPECT_EQ(image->at(60, 50), (Rgb{0, 255, 0}));
  EXPECT_EQ(image->at(260, 100), (Rgb{0, 0, 255}));
  EXPECT_EQ(image->at(3, 3), (View{}.background));
  // 20 m on 88 % of 320 pixels: the ground covers a rectangle of that size, without holes.
  const double pixels = 0.88 * 320 * 0.88 * 160;
  EXPECT_NEAR(static_cast<double>(320 * 200 - static_cast<int>(count(*image, View{}.background))), pixels,
              0.03 * pixels);
}

TEST(Picture, the_nearer_point_hides_the_farther) {
  cloud::PointCloud cloud = scene();
  std::vector<Rgb> colours(cloud.size(), Rgb{200, 200, 200});
  for (const auto& p : scene().points) {  // the same once more, under the ground
    cloud.points.emplace_back(p.x(), p.y(), p.z() - 1.0f);
    colours.push_back({255, 0, 0});
  }
  const auto image = render(cloud, colours, small(Projection::kTop));
  ASSERT_TRUE(image);
  EXPECT_EQ(count(*image, {255, 0, 0}), 0u);
}

TEST(Picture, in_perspective_fills_the_view_and_shading_darkens_edges) {
  const cloud::PointCloud cloud = scene();
  const std::vector<Rgb> colours(cloud.size(), Rgb{200, 200, 200});
  View view = small(Projection::kPerspective);
  const auto flat = render(cloud, colours, view);
  ASSERT_TRUE(flat);
  EXPECT_GT(320u * 200u - count(*flat, view.background), 320u * 200u / 5);
  for (int x = 0; x < 320; ++x) EXPECT_EQ(flat->at(x, 0), view.background);
  view.shading = 1.0;
  const auto shaded = render(cloud, colours, view);
  EXPECT_LT(count(*shaded, {200, 200, 200}), count(*flat, {200, 200, 200}));
}

TEST(Picture, lettering_is_drawn_and_clipped) {
  const cloud::PointCloud cloud = scene();
  View view = small(Projection::kTop);
  const std::vector<Rgb> colours(cloud.size(), view.background);
  view.title = std::string(300, 'W') + "\xc3\xa9";
  view.legend = {{"r1", {1, 255, 1}}};
  view.bar = {"error [m]", 0.0, 0.3, true};
  view.scale_bar = true;
  const auto image = render(cloud, colours, view);
  ASSERT_TRUE(image);
  EXPECT_GT(count(*image, {230, 230, 230}), 300u);
  EXPECT_GT(count(*image, {1, 255, 1}), 20u);
}

TEST(Picture, refuses_what_cannot_be_drawn) {
  const cloud::PointCloud cloud = scene();
  const std::vector<Rgb> colours(cloud.size());
  EXPECT_FALSE(render({}, {}, {}));
  EXPECT_FALSE(render(cloud, {}, {}));
  View view;
  view.width = 1 << 20;
  EXPECT_FALSE(render(cloud, colours, view));
  const cloud::PointCloud nothing{{{NAN, 0, 0}, {0, INFINITY, 0}}, {}};
  EXPECT_FALSE(render(nothing, std::vector<Rgb>(2), {}));
  const cloud::PointCloud one{{{1, 2, 3}}, {}};
  EXPECT_TRUE(render(one, std::vector<Rgb>(1), small(Projection::kTop)));
  EXPECT_TRUE(render(one, std::vector<Rgb>(1), small(Projection::kPerspective)));
}

}  // namespace
}  // namespace fleetmap::eval
