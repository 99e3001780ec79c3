#pragma once

#include <string>
#include <vector>

#include "experiment/case.hpp"

namespace fleetmap::apps::experiment {

/// Mean of a metric along an axis, with the band from least to greatest.
struct BandLine {
  std::string name;
  struct Point {
    double x = 0.0, min = 0.0, mean = 0.0, max = 0.0;
  };
  std::vector<Point> points;
};

struct BandChart {
  std::string title, x_title, y_title;
  bool log_scale = false;  ///< of y; every value is positive then
  struct Tick {
    double x = 0.0;
    std::string label;
  };
  std::vector<Tick> ticks;
  std::vector<BandLine> lines;
};

/// An SVG element, like Figures 9 to 11 of the paper. What is not finite is left out.
std::string band_chart(const BandChart& chart);

struct NamedHistogram {
  std::string name;
  Histogram histogram;
};
/// Several histograms as outlines over the same axis.
std::string histogram_chart(const std::string& title, const std::vector<NamedHistogram>& histograms);

/// With &, <, > and quotes written out.
std::string escaped(const std::string& text);

}  // namespace fleetmap::apps::experiment
