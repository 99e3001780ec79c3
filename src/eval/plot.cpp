#include "fleetmap/eval/plot.hpp"

#include <algorithm>
#include <cmath>

#include "plot_frame.hpp"

namespace fleetmap::eval {
namespace {

std::string tooltip(const std::string& name, double x, double y) {
  return "<title>" + escaped(name) + (name.empty() ? "" : ": ") + short_number(x, 4) + ", " +
         short_number(y, 4) + "</title>";
}

std::size_t length_of(const LineSeries& series) { return std::min(series.x.size(), series.y.size()); }

bool has_band(const LineSeries& series) {
  return !series.low.empty() && series.low.size() == series.y.size() && series.high.size() == series.y.size();
}

std::pair<Range, Range> ranges_of(const Axes& axes, const std::vector<LineSeries>& series) {
  Range x, y;
  const auto add_y = [&](double value) {
    if (!axes.log_y || value > 0.0) y.add(value);
  };
  for (const LineSeries& s : series) {
    for (std::size_t i = 0; i < length_of(s); ++i) {
      x.add(s.x[i]);
      add_y(s.y[i]);
      if (has_band(s)) add_y(s.low[i]), add_y(s.high[i]);
    }
  }
  return {x, y};
}

void draw_band(PlotFrame& frame, const LineSeries& s, const std::string& colour) {
  std::string there, back;
  for (std::size_t i = 0; i < length_of(s); ++i) {
    if (!std::isfinite(s.x[i]) || !frame.shows_y(s.low[i]) || !frame.shows_y(s.high[i])) continue;
    there += frame.x(s.x[i]) + "," + frame.y(s.high[i]) + " ";
    back.insert(0, frame.x(s.x[i]) + "," + frame.y(s.low[i]) + " ");
  }
  if (there.empty()) return;
  frame.body << "<polygon fill=\"" << colour << "\" fill-opacity=\"0.18\" points=\"" << there << back
             << "\"/>\n";
}

void draw_line(PlotFrame& frame, const LineSeries& s, const std::string& colour) {
  std::string points;
  const auto flush = [&] {
    if (!points.empty()) {
      frame.body << "<polyline fill=\"none\" stroke-width=\"2\" stroke-linejoin=\"round\" stroke=\"" << colour
                 << "\" points=\"" << points << "\"/>\n";
    }
    points.clear();
  };
  for (std::size_t i = 0; i < length_of(s); ++i) {
    if (std::isfinite(s.x[i]) && frame.shows_y(s.y[i])) {
      points += frame.x(s.x[i]) + "," + frame.y(s.y[i]) + " ";
    } else {
      flush();
    }
  }
  flush();
}

void draw_markers(PlotFrame& frame, const LineSeries& s, const std::string& colour, double opacity) {
  for (std::size_t i = 0; i < length_of(s); ++i) {
    if (!std::isfinite(s.x[i]) || !frame.shows_y(s.y[i])) continue;
    frame.body << "<circle cx=\"" << frame.x(s.x[i]) << "\" cy=\"" << frame.y(s.y[i])
               << "\" r=\"3.5\" fill=\"" << colour << "\" fill-opacity=\"" << opacity << "\">"
               << tooltip(s.name, s.x[i], s.y[i]) << "</circle>\n";
  }
}

template <class Series>
std::vector<std::string> names_of(const std::vector<Series>& series) {
  std::vector<std::string> names;
  for (const Series& s : series) names.push_back(s.name);
  return names;
}

void draw_bar(PlotFrame& frame, double left, double right, double value, const std::string& colour,
              double opacity, const std::string& title) {
  const double top = std::min(frame.y_pixel(value), frame.floor_pixel());
  frame.body << "<rect x=\"" << pixel(left) << "\" y=\"" << pixel(top) << "\" width=\""
             << pixel(std::max(0.0, right - left)) << "\" height=\"" << pixel(frame.floor_pixel() - top)
             << "\" fill=\"" << colour << "\" fill-opacity=\"" << opacity << "\">" << title << "</rect>\n";
}

}  // namespace

std::string line_plot(const Axes& axes, const std::vector<LineSeries>& series) {
  const auto [x, y] = ranges_of(axes, series);
  PlotFrame frame(axes, x, y, names_of(series));
  for (std::size_t k = 0; k < series.size(); ++k) {
    if (has_band(series[k])) draw_band(frame, series[k], plot_colour(k));
  }
  for (std::size_t k = 0; k < series.size(); ++k) {
    draw_line(frame, series[k], plot_colour(k));
    if (series[k].markers) draw_markers(frame, series[k], plot_colour(k), 1.0);
  }
  return frame.finish();
}

std::string scatter_plot(const Axes& axes, const std::vector<LineSeries>& series) {
  const auto [x, y] = ranges_of(axes, series);
  PlotFrame frame(axes, x, y, names_of(series));
  for (std::size_t k = 0; k < series.size(); ++k) draw_markers(frame, series[k], plot_colour(k), 0.6);
  return frame.finish();
}

std::string histogram(const Axes& axes, const std::vector<HistogramSeries>& series, double bin_width,
                      double first) {
  Range x, y;
  x.add(first);
  for (const HistogramSeries& s : series) {
    x.add(first + bin_width * static_cast<double>(s.shares.size()));
    for (const double share : s.shares) {
      if (!axes.log_y || share > 0.0) y.add(share);
    }
  }
  Axes based = axes;
  based.zero_based = true;
  PlotFrame frame(based, x, y, names_of(series));
  const double opacity = series.size() > 1 ? 0.5 : 0.85;
  for (std::size_t k = 0; k < series.size(); ++k) {
    for (std::size_t i = 0; i < series[k].shares.size(); ++i) {
      const double share = series[k].shares[i];
      if (!frame.shows_y(share) || share == 0.0) continue;
      const double from = first + bin_width * static_cast<double>(i);
      draw_bar(frame, frame.x_pixel(from), frame.x_pixel(from + bin_width) - 0.5, share, plot_colour(k),
               opacity, tooltip(series[k].name, from, share));
    }
  }
  return frame.finish();
}

std::string bar_plot(const Axes& axes, const std::vector<std::string>& groups,
                     const std::vector<Bars>& bars) {
  Range x, y;
  for (const Bars& b : bars) {
    for (const double value : b.values) {
      if (!axes.log_y || value > 0.0) y.add(value);
    }
  }
  Axes based = axes;
  based.zero_based = true;
  PlotFrame frame(based, x, y, names_of(bars), groups.empty() ? std::vector<std::string>{""} : groups);
  const double width = 0.8 / static_cast<double>(std::max<std::size_t>(1, bars.size()));
  for (std::size_t k = 0; k < bars.size(); ++k) {
    for (std::size_t g = 0; g < std::min(groups.size(), bars[k].values.size()); ++g) {
      const double value = bars[k].values[g];
      if (!frame.shows_y(value)) continue;
      const double from = static_cast<double>(g) - 0.4 + width * static_cast<double>(k);
      const std::string title =
          "<title>" + escaped(groups[g] + " " + bars[k].name) + ": " + short_number(value, 4) + "</title>";
      draw_bar(frame, frame.x_pixel(from), frame.x_pixel(from + width) - 1.0, value, plot_colour(k), 0.9,
               title);
    }
  }
  return frame.finish();
}

}  // namespace fleetmap::eval
