#pragma once

#include <string>
#include <vector>

#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/eval/colours.hpp"
#include "fleetmap/eval/image.hpp"

namespace fleetmap::eval {

/// Projection of a picture: orthographic from above, or perspective.
enum class Projection { kTop, kPerspective };

/// An entry of a picture's legend.
struct LegendEntry {
  std::string text;
  Rgb colour;
};
/// Scale of the colours of a picture.
struct ColourBar {
  std::string title;             ///< "error [m]"; empty: no bar
  double low = 0.0, high = 1.0;  ///< values at its ends
  bool open_ended = false;       ///< the last colour also stands for everything above `high`
};

/// Camera, size and decoration of a picture of a cloud.
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

}  // namespace fleetmap::eval
