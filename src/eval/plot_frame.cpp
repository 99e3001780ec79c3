#include "plot_frame.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace fleetmap::eval {
namespace {

constexpr int kTicks = 6;

/// Multiples of 1, 2 or 5 times a power of ten within [low, high].
std::vector<double> round_ticks(double low, double high, int wanted) {
  const double raw = (high - low) / wanted;
  if (!(raw > 0.0) || !std::isfinite(raw)) return {low};
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  double step = 10.0 * power;
  for (const double factor : {5.0, 2.0, 1.0}) {
    if (factor * power >= raw) step = factor * power;
  }
  std::vector<double> ticks;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step && ticks.size() < 50; ++k)
    ticks.push_back(k * step + 0.0);  // no -0
  return ticks;
}

/// Powers of ten within [low, high], thinned to a few.
std::vector<double> decades(double low, double high) {
  const int first = static_cast<int>(std::ceil(std::log10(low) - 1e-9));
  const int last = static_cast<int>(std::floor(std::log10(high) + 1e-9));
  const int step = std::max(1, (last - first) / kTicks + 1);
  std::vector<double> ticks;
  for (int k = first; k <= last; k += step) ticks.push_back(std::pow(10.0, k));
  return ticks;
}

void widen(Range& range, double share) {
  if (range.empty()) range = {0.0, 1.0};
  double room = share * (range.high - range.low);
  if (room == 0.0) room = range.high == 0.0 ? 1.0 : 0.1 * std::abs(range.high);
  range.low -= room;
  range.high += room;
}

std::string text(double x, double y, const std::string& anchor, const std::string& content, double size = 12,
                 const std::string& more = "") {
  return "<text x=\"" + pixel(x) + "\" y=\"" + pixel(y) + "\" font-size=\"" + pixel(size) +
         "\" text-anchor=\"" + anchor + "\" fill=\"currentColor\"" + more + ">" + escaped(content) +
         "</text>\n";
}

std::string line(double x1, double y1, double x2, double y2, double opacity) {
  return "<line x1=\"" + pixel(x1) + "\" y1=\"" + pixel(y1) + "\" x2=\"" + pixel(x2) + "\" y2=\"" +
         pixel(y2) + "\" stroke=\"currentColor\" stroke-opacity=\"" + pixel(opacity) + "\"/>\n";
}

}  // namespace

void Range::add(double value) {
  if (!std::isfinite(value)) return;
  low = std::min(low, value);
  high = std::max(high, value);
}

std::string pixel(double value) {
  std::array<char, 48> out{};
  std::snprintf(out.data(), out.size(), "%.2f", std::isfinite(value) ? std::clamp(value, -1e6, 1e6) : 0.0);
  return out.data();
}

std::string plot_colour(std::size_t k) {
  // Okabe and Ito's palette without yellow, which a white page swallows.
  static constexpr std::array<const char*, 6> kColours{"#0072b2", "#d55e00", "#009e73",
                                                       "#cc79a7", "#e69f00", "#56b4e9"};
  return kColours[k % kColours.size()];
}

std::string escaped(std::string_view text) {
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
      case '\'':
        out += "&#39;";
        break;
      default: {
        const auto byte = static_cast<unsigned char>(c);
        const bool forbidden = (byte < 32 && c != '\n' && c != '\t' && c != '\r') || byte == 127;
        out += forbidden ? '?' : c;
      }
    }
  }
  return out;
}

std::string short_number(double value, int digits) {
  if (!std::isfinite(value)) return "-";
  std::array<char, 48> out{};
  const double size = std::abs(value);
  const bool plain = size == 0.0 || (size >= 1e-3 && size < 1e6);
  if (plain && size >= std::pow(10.0, digits - 1)) {
    std::snprintf(out.data(), out.size(), "%.0f", value);
  } else {
    std::snprintf(out.data(), out.size(), plain ? "%.*g" : "%.*e", plain ? digits : std::max(0, digits - 1),
                  value);
  }
  return out.data();
}

PlotFrame::PlotFrame(const Axes& axes, Range x, Range y, std::vector<std::string> names,
                     std::vector<std::string> categories)
    : axes_(axes), names_(std::move(names)), categories_(std::move(categories)) {
  axes_.width = std::clamp(axes_.width, 200, 4000);
  axes_.height = std::clamp(axes_.height, 150, 4000);
  left_ = axes_.y_label.empty() ? 62 : 80;
  top_ = axes_.title.empty() ? 16 : 40;
  right_ = axes_.width - 18;
  bottom_ = axes_.height - (axes_.x_label.empty() ? 34 : 54);
  place_legend();
  for (const double tick : axes_.x_ticks) x.add(tick);  // also where no series has a value
  fit(x, y);
}

/// Places the legend in rows between title and drawing, and moves the drawing's top below them.
void PlotFrame::place_legend() {
  constexpr double kRow = 18.0, kLetter = 7.0, kBox = 30.0;
  double x = left_, y = top_;
  for (std::size_t k = 0; k < names_.size(); ++k) {
    if (names_[k].empty()) continue;
    const double width = kBox + kLetter * static_cast<double>(names_[k].size());
    if (x > left_ && x + width > right_) {
      x = left_;
      y += kRow;
    }
    entries_.push_back({x, y, k});
    x += width;
  }
  if (!entries_.empty()) top_ = std::min(y + kRow, bottom_ - 60.0);
}

std::string PlotFrame::legend() const {
  std::string out;
  for (const Entry& entry : entries_) {
    out += "<rect x=\"" + pixel(entry.x) + "\" y=\"" + pixel(entry.y - 6) +
           "\" width=\"12\" height=\"10\" fill=\"" + plot_colour(entry.series) + "\"/>\n";
    out += text(entry.x + 16, entry.y + 3, "start", names_[entry.series]);
  }
  return out;
}

void PlotFrame::fit(Range x, Range y) {
  if (categories_.empty()) {
    widen(x, 0.03);
  } else {
    x = {-0.5, static_cast<double>(categories_.size()) - 0.5};
  }
  if (axes_.log_y) {
    if (y.empty() || !(y.low > 0.0)) y = {std::min(1.0, y.high > 0.0 ? y.high : 1.0), std::max(1.0, y.high)};
    Range exponent{std::floor(std::log10(y.low) + 1e-9), std::ceil(std::log10(y.high) - 1e-9)};
    if (exponent.low == exponent.high) exponent.high += 1.0;
    y = {std::pow(10.0, exponent.low), std::pow(10.0, exponent.high)};
  } else {
    const bool at_zero = axes_.zero_based && !y.empty() && y.low >= 0.0;
    if (at_zero) y.low = 0.0;
    widen(y, 0.06);
    if (at_zero) y.low = 0.0;
  }
  if (axes_.equal) {
    const double scale = std::max((x.high - x.low) / (right_ - left_), (y.high - y.low) / (bottom_ - top_));
    const double x_middle = 0.5 * (x.low + x.high), y_middle = 0.5 * (y.low + y.high);
    x = {x_middle - 0.5 * scale * (right_ - left_), x_middle + 0.5 * scale * (right_ - left_)};
    y = {y_middle - 0.5 * scale * (bottom_ - top_), y_middle + 0.5 * scale * (bottom_ - top_)};
  }
  x_ = x;
  y_ = y;
}

double PlotFrame::x_pixel(double value) const {
  return left_ + (right_ - left_) * (value - x_.low) / (x_.high - x_.low);
}

double PlotFrame::y_pixel(double value) const {
  const double share = axes_.log_y ? std::log(value / y_.low) / std::log(y_.high / y_.low)
                                   : (value - y_.low) / (y_.high - y_.low);
  return bottom_ - (bottom_ - top_) * share;
}

std::string PlotFrame::x(double value) const { return pixel(x_pixel(value)); }
std::string PlotFrame::y(double value) const { return pixel(y_pixel(value)); }

bool PlotFrame::shows_y(double value) const { return std::isfinite(value) && (!axes_.log_y || value > 0.0); }

std::string PlotFrame::ticks_x() const {
  std::string out;
  if (!categories_.empty()) {
    for (std::size_t k = 0; k < categories_.size(); ++k)
      out += text(x_pixel(static_cast<double>(k)), bottom_ + 18, "middle", categories_[k]);
    return out;
  }
  constexpr std::size_t kMaxConfiguredTicks = 12;
  const bool configured = !axes_.x_ticks.empty() && axes_.x_ticks.size() <= kMaxConfiguredTicks;
  for (const double tick : configured ? axes_.x_ticks : round_ticks(x_.low, x_.high, kTicks)) {
    const double at = x_pixel(tick);
    out += line(at, top_, at, bottom_, 0.12);
    out += text(at, bottom_ + 18, "middle", short_number(tick, 4));
  }
  return out;
}

std::string PlotFrame::ticks_y() const {
  std::string out;
  const auto ticks = axes_.log_y ? decades(y_.low, y_.high) : round_ticks(y_.low, y_.high, kTicks);
  for (const double tick : ticks) {
    const double at = y_pixel(tick);
    out += line(left_, at, right_, at, 0.12);
    out += text(left_ - 6, at + 4, "end", short_number(tick, axes_.log_y ? 1 : 4));
  }
  return out;
}

std::string PlotFrame::finish() const {
  const double width = axes_.width, height = axes_.height;
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + pixel(width) + " " +
                    pixel(height) + "\" width=\"" + pixel(width) +
                    "\" font-family=\"system-ui,sans-serif\" role=\"img\"" +
                    (axes_.opaque ? " color=\"#1b1f24\"" : "") + ">\n<title>" +
                    escaped(axes_.title.empty() ? axes_.y_label : axes_.title) + "</title>\n";
  if (axes_.opaque) svg += "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
  svg += ticks_x() + ticks_y();
  // A nested svg clips what reaches beyond the axes.
  svg += "<svg x=\"" + pixel(left_) + "\" y=\"" + pixel(top_) + "\" width=\"" + pixel(right_ - left_) +
         "\" height=\"" + pixel(bottom_ - top_) + "\" viewBox=\"" + pixel(left_) + " " + pixel(top_) + " " +
         pixel(right_ - left_) + " " + pixel(bottom_ - top_) + "\">\n" + body.str() + "</svg>\n";
  svg += line(left_, bottom_, right_, bottom_, 0.7) + line(left_, top_, left_, bottom_, 0.7);
  if (!axes_.title.empty())
    svg += text(0.5 * (left_ + right_), 24, "middle", axes_.title, 15, " font-weight=\"600\"");
  if (!axes_.x_label.empty()) svg += text(0.5 * (left_ + right_), height - 10, "middle", axes_.x_label, 13);
  if (!axes_.y_label.empty()) {
    const std::string at = pixel(0.5 * (top_ + bottom_));
    svg += text(18, 0.5 * (top_ + bottom_), "middle", axes_.y_label, 13,
                " transform=\"rotate(-90 18 " + at + ")\"");
  }
  svg += legend();
  return svg + "</svg>\n";
}

}  // namespace fleetmap::eval
