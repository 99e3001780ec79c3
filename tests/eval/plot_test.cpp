#include "fleetmap/eval/plot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

namespace fleetmap::eval {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

/// The drawing within the axes: each element with its attributes and its tooltip.
struct Drawn {
  std::string name;
  std::map<std::string, std::string> attributes;
  std::string tooltip;
  double number(const char* attribute) const { return std::stod(attributes.at(attribute)); }
};

std::vector<Drawn> drawn_in(const std::string& svg, const std::string& name) {
  tinyxml2::XMLDocument document;
  EXPECT_EQ(document.Parse(svg.c_str(), svg.size()), tinyxml2::XML_SUCCESS);
  std::vector<Drawn> all;
  const auto* area = document.RootElement()->FirstChildElement("svg");
  for (const auto* e = area->FirstChildElement(name.c_str()); e != nullptr;
       e = e->NextSiblingElement(name.c_str())) {
    Drawn& one = all.emplace_back();
    one.name = name;
    for (const auto* a = e->FirstAttribute(); a != nullptr; a = a->Next())
      one.attributes[a->Name()] = a->Value();
    if (const auto* title = e->FirstChildElement("title")) one.tooltip = title->GetText();
  }
  return all;
}

TEST(Plot, ALineIsBrokenWhereAValueIsMissing) {
  const LineSeries broken{"r1", {0, 1, 2, 3, 4}, {1, 2, NAN, 3, 1}, {}, {}};
  const std::string svg = line_plot({}, {broken});
  const auto lines = drawn_in(svg, "polyline");
  ASSERT_THAT(lines, SizeIs(2));
  const auto points = [](const std::string& text) { return std::ranges::count(text, ','); };
  EXPECT_EQ(points(lines[0].attributes.at("points")), 2);
  EXPECT_EQ(points(lines[1].attributes.at("points")), 2);
  const auto markers = drawn_in(svg, "circle");
  ASSERT_THAT(markers, SizeIs(4));
  EXPECT_EQ(markers[2].tooltip, "r1: 3, 3");
  LineSeries bare = broken;
  bare.markers = false;
  EXPECT_THAT(drawn_in(line_plot({}, {bare}), "circle"), SizeIs(0));
}

TEST(Plot, ABandGoesThereAboveAndBackBelow) {
  const std::string svg = line_plot({}, {{"", {0, 1}, {5, 6}, {4, 5}, {8, 9}}});
  const auto bands = drawn_in(svg, "polygon");
  ASSERT_THAT(bands, SizeIs(1));
  std::vector<double> x, y;
  std::istringstream points(bands[0].attributes.at("points"));
  for (char comma = 0; points;) {
    double px = 0.0, py = 0.0;
    if (points >> px >> comma >> py) x.push_back(px), y.push_back(py);
  }
  ASSERT_THAT(x, SizeIs(4));
  EXPECT_LT(x[0], x[1]);
  EXPECT_EQ(x[1], x[2]);
  EXPECT_EQ(x[3], x[0]);
  EXPECT_LT(y[1], y[0]) << "9 is above 8";
  EXPECT_LT(y[0], y[2]) << "8 is above 5";
  EXPECT_LT(y[2], y[3]) << "5 is above 4";
  EXPECT_THAT(drawn_in(line_plot({}, {{"", {0, 1}, {5, 6}, {4}, {8}}}), "polygon"), SizeIs(0));
}

TEST(Plot, OnALogarithmicAxisOnlyPositiveValuesAreDrawn) {
  const std::string svg =
      scatter_plot({.log_y = true}, {{"", {0, 1, 2, 3}, {0.0, -1.0, 10.0, 100.0}, {}, {}}});
  const auto markers = drawn_in(svg, "circle");
  ASSERT_THAT(markers, SizeIs(2));
  EXPECT_EQ(markers[0].tooltip, "2, 10");
}

TEST(Plot, BinsOfAHistogramStandSideBySideFromTheFirstEdge) {
  const std::string svg = histogram({}, {{"h", {0.2, 0.0, 0.4}}}, 5.0, 10.0);
  const auto bins = drawn_in(svg, "rect");
  ASSERT_THAT(bins, SizeIs(2)) << "an empty bin has no bar";
  EXPECT_EQ(bins[0].tooltip, "h: 10, 0.2");
  EXPECT_EQ(bins[1].tooltip, "h: 20, 0.4");
  EXPECT_NEAR(bins[1].number("height"), 2.0 * bins[0].number("height"), 0.02);
  EXPECT_NEAR(bins[1].number("x") - bins[0].number("x"), 2.0 * (bins[0].number("width") + 0.5), 0.02);
}

TEST(Plot, BarsOfAGroupStandSideBySide) {
  const std::string svg = bar_plot({}, {"r1", "r2"}, {{"a", {1, 2}}, {"b", {3, NAN, 9}}});
  const auto bars = drawn_in(svg, "rect");
  ASSERT_THAT(bars, SizeIs(3)) << "no bar for NaN, nor beyond the groups";
  EXPECT_EQ(bars[0].tooltip, "r1 a: 1");
  EXPECT_EQ(bars[1].tooltip, "r2 a: 2");
  EXPECT_EQ(bars[2].tooltip, "r1 b: 3");
  EXPECT_LT(bars[0].number("x"), bars[2].number("x"));
  EXPECT_LT(bars[2].number("x"), bars[1].number("x"));
  EXPECT_NEAR(bars[2].number("height"), 3.0 * bars[0].number("height"), 0.05);
  EXPECT_NE(bars[0].attributes.at("fill"), bars[2].attributes.at("fill"));
}

TEST(Plot, NumbersHaveAsManyDigitsAsAreAskedFor) {
  EXPECT_EQ(short_number(1234567.0), "1.23e+06");
  EXPECT_EQ(short_number(999999.0), "999999") << "below a million all digits are shown";
  EXPECT_EQ(short_number(-12.3456, 4), "-12.35");
  EXPECT_EQ(short_number(0.001), "0.001");
  EXPECT_EQ(short_number(0.000999), "9.99e-04");
  EXPECT_EQ(short_number(5e-7, 1), "5e-07");
  EXPECT_EQ(short_number(-INFINITY), "-");
}

TEST(Plot, TextIsEscaped) {
  EXPECT_EQ(escaped("a<b> & \"c\" 'd'"), "a&lt;b&gt; &amp; &quot;c&quot; &#39;d&#39;");
  EXPECT_EQ(escaped(std::string("\n\t\r\x01\x7f\0z", 7)), "\n\t\r???z");
  EXPECT_EQ(escaped("Grüße"), "Grüße") << "UTF-8 stays";
  EXPECT_THAT(line_plot({.title = "<b>"}, {}), HasSubstr("&lt;b&gt;"));
}

}  // namespace
}  // namespace fleetmap::eval
