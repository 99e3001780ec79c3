#include "experiment/chart.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "experiment/study_values.hpp"

namespace fleetmap::apps::experiment {
namespace {

constexpr double kWidth = 460.0, kHeight = 300.0;
constexpr double kLeft = 66.0, kRight = 16.0, kTop = 30.0, kBottom = 46.0;
constexpr std::array<const char*, 6> kColours{"#1f6fb4", "#d1495b", "#3a7d44",
                                              "#b8860b", "#6a4c93", "#444444"};

std::string text_at(double x, double y, const char* anchor, const std::string& text,
                    const std::string& more = "") {
  char place[80];
  std::snprintf(place, sizeof place, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\"", x, y, anchor);
  return place + (more.empty() ? "" : " " + more) + ">" + escaped(text) + "</text>\n";
}

std::string line_at(double x1, double y1, double x2, double y2, const char* colour) {
  char text[160];
  std::snprintf(text, sizeof text, "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\"/>\n",
                x1, y1, x2, y2, colour);
  return text;
}

std::string pair_of(double x, double y) {
  char text[60];
  std::snprintf(text, sizeof text, "%.1f,%.1f ", x, y);
  return text;
}

/// From data to the place on the page; y may be logarithmic.
struct Frame {
  double x_low = 0.0, x_high = 1.0, y_low = 0.0, y_high = 1.0;
  bool log_scale = false;

  double px(double x) const { return kLeft + (x - x_low) / (x_high - x_low) * (kWidth - kLeft - kRight); }
  double py(double y) const {
    const double value = log_scale ? std::log10(y) : y;
    return kHeight - kBottom - (value - y_low) / (y_high - y_low) * (kHeight - kTop - kBottom);
  }
};

/// 1, 2 or 5 times a power of ten, so that `span` has about five of them.
double tidy_step(double span) {
  const double raw = span / 5.0, power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (raw <= factor * power) return factor * power;
  return 10.0 * power;
}

std::vector<double> y_ticks(const Frame& frame) {
  std::vector<double> ticks;
  const double span = frame.y_high - frame.y_low;
  const double step = frame.log_scale ? std::max(1.0, std::ceil(span / 6.0)) : tidy_step(span);
  for (double tick = std::ceil(frame.y_low / step - 1e-9) * step; tick <= frame.y_high + 1e-9 * step;
       tick += step)
    ticks.push_back(std::abs(tick) < 1e-9 * step ? 0.0 : tick);
  return ticks;
}

std::string axes_of(const Frame& frame, const std::vector<BandChart::Tick>& ticks, const std::string& title,
                    const std::string& x_title, const std::string& y_title) {
  std::string svg = text_at(kWidth / 2.0, 17.0, "middle", title, "font-weight=\"600\"");
  for (const double tick : y_ticks(frame)) {
    const double value = frame.log_scale ? std::pow(10.0, tick) : tick, y = frame.py(value);
    svg += line_at(kLeft, y, kWidth - kRight, y, "#e4e4e4");
    svg += text_at(kLeft - 6.0, y + 4.0, "end", short_number(value));
  }
  for (const BandChart::Tick& tick : ticks) {
    svg += line_at(frame.px(tick.x), kHeight - kBottom, frame.px(tick.x), kHeight - kBottom + 4.0, "#555");
    svg += text_at(frame.px(tick.x), kHeight - kBottom + 17.0, "middle", tick.label);
  }
  svg += line_at(kLeft, kHeight - kBottom, kWidth - kRight, kHeight - kBottom, "#555");
  svg += text_at((kLeft + kWidth - kRight) / 2.0, kHeight - 10.0, "middle", x_title);
  return svg + text_at(14.0, kHeight / 2.0, "middle", y_title, "transform=\"rotate(-90 14 150)\"");
}

std::string legend(const std::vector<std::string>& names) {
  std::string svg;
  double y = kTop + 12.0;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k].empty()) continue;
    const char* colour = kColours[k % kColours.size()];
    svg += line_at(kWidth - kRight - 18.0, y - 4.0, kWidth - kRight - 2.0, y - 4.0, colour);
    svg += text_at(kWidth - kRight - 24.0, y, "end", names[k], std::string("fill=\"") + colour + "\"");
    y += 15.0;
  }
  return svg;
}

std::string opening() {
  return "<svg viewBox=\"0 0 460 300\" width=\"460\" height=\"300\" xmlns=\"http://www.w3.org/2000/svg\" "
         "font-family=\"sans-serif\" font-size=\"12\">\n";
}

bool drawable(const BandLine::Point& p, bool log_scale) {
  return std::isfinite(p.x) && std::isfinite(p.min) && std::isfinite(p.mean) && std::isfinite(p.max) &&
         (!log_scale || p.min > 0.0);
}

std::vector<BandLine::Point> drawable_points(const BandLine& line, bool log_scale) {
  std::vector<BandLine::Point> points;
  for (const BandLine::Point& point : line.points)
    if (drawable(point, log_scale)) points.push_back(point);
  return points;
}

/// Room around what is drawn; a single value gets some, too.
Frame frame_of(const BandChart& chart) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Frame frame{kInfinity, -kInfinity, kInfinity, -kInfinity, chart.log_scale};
  for (const BandChart::Tick& tick : chart.ticks) {
    frame.x_low = std::min(frame.x_low, tick.x);
    frame.x_high = std::max(frame.x_high, tick.x);
  }
  for (const BandLine& line : chart.lines) {
    for (const BandLine::Point& point : drawable_points(line, chart.log_scale)) {
      frame.y_low = std::min(frame.y_low, chart.log_scale ? std::log10(point.min) : point.min);
      frame.y_high = std::max(frame.y_high, chart.log_scale ? std::log10(point.max) : point.max);
      frame.x_low = std::min(frame.x_low, point.x);
      frame.x_high = std::max(frame.x_high, point.x);
    }
  }
  if (frame.y_low > frame.y_high) frame.y_low = 0.0, frame.y_high = 1.0;
  if (frame.x_low > frame.x_high) frame.x_low = 0.0, frame.x_high = 1.0;
  const double y_span = frame.y_high - frame.y_low, x_span = frame.x_high - frame.x_low;
  const double y_room = y_span > 0.0 ? 0.08 * y_span : std::max(0.1 * std::abs(frame.y_low), 1e-12);
  const double x_room = x_span > 0.0 ? 0.06 * x_span : 0.5;
  return {frame.x_low - x_room, frame.x_high + x_room, frame.y_low - y_room, frame.y_high + y_room,
          chart.log_scale};
}

std::string band(const BandLine& line, const Frame& frame, const char* colour) {
  const std::vector<BandLine::Point> points = drawable_points(line, frame.log_scale);
  if (points.empty()) return "";
  std::string area, mean, dots;
  for (const BandLine::Point& p : points) area += pair_of(frame.px(p.x), frame.py(p.max));
  for (auto p = points.rbegin(); p != points.rend(); ++p) area += pair_of(frame.px(p->x), frame.py(p->min));
  for (const BandLine::Point& p : points) {
    mean += pair_of(frame.px(p.x), frame.py(p.mean));
    dots += line_at(frame.px(p.x), frame.py(p.min), frame.px(p.x), frame.py(p.max), colour);
    char dot[120];
    std::snprintf(dot, sizeof dot, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"%s\"/>\n", frame.px(p.x),
                  frame.py(p.mean), colour);
    dots += dot;
  }
  const std::string paint = colour;
  return "<polygon points=\"" + area + "\" fill=\"" + paint +
         "\" fill-opacity=\"0.15\"/>\n<polyline points=\"" + mean + "\" fill=\"none\" stroke=\"" + paint +
         "\" stroke-width=\"2\"/>\n" + dots;
}

}  // namespace

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string band_chart(const BandChart& chart) {
  const Frame frame = frame_of(chart);
  std::string svg = opening() + axes_of(frame, chart.ticks, chart.title, chart.x_title, chart.y_title);
  std::vector<std::string> names;
  for (std::size_t k = 0; k < chart.lines.size(); ++k) {
    svg += band(chart.lines[k], frame, kColours[k % kColours.size()]);
    names.push_back(chart.lines[k].name);
  }
  return svg + legend(names) + "</svg>\n";
}

std::string histogram_chart(const std::string& title, const std::vector<NamedHistogram>& histograms) {
  Frame frame{0.0, 0.0, 0.0, 0.0, false};
  for (const auto& [name, histogram] : histograms) {
    frame.x_high = std::max(frame.x_high, histogram.bin_width * static_cast<double>(histogram.shares.size()));
    for (const double share : histogram.shares)
      if (std::isfinite(share)) frame.y_high = std::max(frame.y_high, 1.08 * share);
  }
  if (!(frame.x_high > 0.0)) frame.x_high = 1.0;
  if (!(frame.y_high > 0.0)) frame.y_high = 1.0;
  std::vector<BandChart::Tick> ticks;
  const double step = tidy_step(frame.x_high);
  for (double tick = 0.0; tick <= frame.x_high + 1e-9 * step; tick += step)
    ticks.push_back({tick, short_number(tick)});
  std::string svg = opening() + axes_of(frame, ticks, title, "value", "share");
  std::vector<std::string> names;
  for (std::size_t k = 0; k < histograms.size(); ++k) {
    const auto& [name, histogram] = histograms[k];
    std::string outline = pair_of(frame.px(0.0), frame.py(0.0));
    for (std::size_t bin = 0; bin < histogram.shares.size(); ++bin) {
      const double share = std::isfinite(histogram.shares[bin]) ? histogram.shares[bin] : 0.0;
      outline += pair_of(frame.px(histogram.bin_width * static_cast<double>(bin)), frame.py(share));
      outline += pair_of(frame.px(histogram.bin_width * static_cast<double>(bin + 1)), frame.py(share));
    }
    const std::string colour = kColours[k % kColours.size()];
    svg += "<polyline points=\"" + outline + "\" fill=\"" + colour + "\" fill-opacity=\"0.12\" stroke=\"" +
           colour + "\"/>\n";
    names.push_back(name);
  }
  return svg + legend(names) + "</svg>\n";
}

}  // namespace fleetmap::apps::experiment
