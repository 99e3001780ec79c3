#pragma once

#include <sstream>
#include <string>
#include <vector>

#include "fleetmap/eval/plot.hpp"

namespace fleetmap::eval {

/// Least and largest of what a plot shows on one axis; only finite values count.
struct Range {
  double low = 1e308, high = -1e308;
  void add(double value);
  bool empty() const { return low > high; }
};

/// The drawing area of a plot: axes, ticks, legend, and the map from values to pixels.
class PlotFrame {
 public:
  /// Fits the axes to the ranges. The legend has those of `names` that are not empty; colour k is that of
  /// names[k]. `categories` (may be empty) replace the ticks of x, at 0, 1, 2, ...
  PlotFrame(const Axes& axes, Range x, Range y, std::vector<std::string> names,
            std::vector<std::string> categories = {});

  /// Pixels, with two decimals.
  std::string x(double value) const;
  std::string y(double value) const;
  double x_pixel(double value) const;
  double y_pixel(double value) const;
  double floor_pixel() const { return bottom_; }
  bool shows_y(double value) const;

  std::ostringstream body;  ///< drawn elements, clipped to the area
  /// The whole plot.
  std::string finish() const;

 private:
  void fit(Range x, Range y);
  void place_legend();
  std::string legend() const;
  std::string ticks_x() const;
  std::string ticks_y() const;
  struct Entry {
    double x, y;
    std::size_t series;
  };
  Axes axes_;
  std::vector<std::string> names_;
  std::vector<Entry> entries_;  ///< of the legend
  std::vector<std::string> categories_;
  Range x_, y_;
  double left_, top_, right_, bottom_;
};

/// Colour of series k.
std::string plot_colour(std::size_t k);
std::string pixel(double value);

}  // namespace fleetmap::eval
