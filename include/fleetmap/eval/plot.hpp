#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Plots are written as SVG rather than drawn by a JavaScript library. Pages must open offline, so they would
/// have to hold the library: vega 6.4 with vega-lite 6.4 is 772 kB minified (259 kB as gzip),
/// plotly.js-basic 4.1 1192 kB (395 kB). The evaluation page of a short run takes 73 kB with its pictures and
/// needs no script.
namespace fleetmap::eval {

/// Axes and title of a plot. Labels carry their unit: "RMSE [m]". All text is escaped.
struct Axes {
  std::string title = {};
  std::string x_label = {};
  std::string y_label = {};
  int width = 640, height = 400;  ///< of the view box; a page scales it
  bool log_y = false;             ///< values that are not positive are left out
  bool equal = false;             ///< a metre is as long on both axes (maps)
  bool zero_based = false;        ///< y begins at 0
  bool opaque = false;            ///< black on white, for files; else the page's background and text colour
  std::vector<double> x_ticks = {};  ///< where the x axis is marked, if they are few; empty: round numbers
};

/// A line with an optional band: mean, min and max as in the paper's Figures 9 to 11. Values that are not
/// finite break the line.
struct LineSeries {
  std::string name;  ///< no name, no entry in the legend
  std::vector<double> x, y;
  std::vector<double> low, high;  ///< as long as y, or empty: no band
  bool markers = true;
};

/// A series of a bar chart.
struct Bars {
  std::string name;
  std::vector<double> values;  ///< one for each group
};

/// Each returns a complete <svg> element that stands alone in a file or in a page and, unless it is
/// opaque, takes its text colour from there.
std::string line_plot(const Axes& axes, const std::vector<LineSeries>& series);
std::string scatter_plot(const Axes& axes, const std::vector<LineSeries>& series);
/// Shares by bin: bin k covers [first + k * width, first + (k + 1) * width). Several are laid over each
/// other.
struct HistogramSeries {
  std::string name;
  std::vector<double> shares;
};
std::string histogram(const Axes& axes, const std::vector<HistogramSeries>& series, double bin_width,
                      double first = 0.0);
std::string bar_plot(const Axes& axes, const std::vector<std::string>& groups, const std::vector<Bars>& bars);

/// For text in XML and HTML, attributes too. Control characters, which XML forbids, become '?'.
std::string escaped(std::string_view text);
/// A number with at most `digits` significant digits: 0.00012 is "1.2e-04", 1234567 is "1.23e+06".
std::string short_number(double value, int digits = 3);

}  // namespace fleetmap::eval
