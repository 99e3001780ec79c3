#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::eval {

struct Rgb {
  std::uint8_t r = 0, g = 0, b = 0;
  bool operator==(const Rgb&) const = default;
};

/// Rows from the top, three bytes a pixel.
struct Image {
  int width = 0, height = 0;
  std::vector<Rgb> pixels;
  Rgb& at(int x, int y) {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
  const Rgb& at(int x, int y) const { return const_cast<Image&>(*this).at(x, y); }
};

enum class Projection { kTop, kPerspective };

/// What a picture shows besides the points.
struct LegendEntry {
  std::string text;
  Rgb colour;
};
struct ColourBar {
  std::string title;             ///< "error [m]"; empty: no bar
  double low = 0.0, high = 1.0;  ///< values at its ends
  bool open_ended = false;       ///< the last colour also stands for everything above `high`
};

struct View {
  Projection projection = Projection::kTop;
  int width = 1600, height = 1200;  ///< pixels, 64 to 8192 each
  Rgb background{16, 18, 22};
  double azimuth_deg = -55.0;   ///< perspective: where the camera stands, seen from the middle, from east
  double elevation_deg = 32.0;  ///< perspective: above the horizon
  double field_of_view_deg = 40.0;
  double point_size = 0.08;  ///< m, edge of the square that stands for a point; at least one pixel
  double shading = 1.0;      ///< of steps in depth, 0 is none
  std::string title;
  std::vector<LegendEntry> legend;
  ColourBar bar;  ///< its colours are those of `turbo` or `viridis`
  bool bar_is_turbo = false;
  bool scale_bar = true;  ///< top view only
};

/// Points as squares behind each other, edges darkened by the steps in depth around them. `colours` has one
/// colour a point, in the order of the cloud. The view is fitted to all but the outermost points. Fails with
/// a reason when there is nothing to draw.
Result<Image> render(const cloud::PointCloud& cloud, const std::vector<Rgb>& colours, const View& view);

/// Perceptually uniform (viridis) and strong (turbo) colour tables, `share` in [0, 1]; NaN is grey.
Rgb viridis(double share);
Rgb turbo(double share);
/// Okabe and Ito's palette, which the colour-blind can tell apart too; it begins again after seven.
Rgb robot_colour(std::size_t robot);
/// "#rrggbb"
std::string hex(Rgb colour);

Result<std::vector<std::uint8_t>> encode_png(const Image& image);
Status write_png(const std::filesystem::path& file, const Image& image);

}  // namespace fleetmap::eval
