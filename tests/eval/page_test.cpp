#include <gtest/gtest.h>
#include <tinyxml2.h>

#include <cmath>
#include <functional>

#include "fleetmap/eval/html_page.hpp"
#include "fleetmap/eval/plot.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::eval {
namespace {

const std::string kNasty = "a<b & \"c\" 'd' </svg>\x01";

/// Number of elements of that name in a well-formed document; -1 when it is not well formed.
int elements(const std::string& xml, const std::string& name) {
  tinyxml2::XMLDocument document;
  if (document.Parse(xml.c_str(), xml.size()) != tinyxml2::XML_SUCCESS) return -1;
  int count = 0;
  const std::function<void(const tinyxml2::XMLElement*)> visit = [&](const tinyxml2::XMLElement* element) {
    for (; element != nullptr; element = element->NextSiblingElement()) {
      count += element->Name() == name ? 1 : 0;
      visit(element->FirstChildElement());
    }
  };
  visit(document.RootElement());
  return count;
}

Axes axes() { return {.title = kNasty, .x_label = "N_a", .y_label = "RMSE [m] & more"}; }

TEST(Plot, of_lines_with_bands_is_well_formed) {
  const LineSeries with_band{
      kNasty, {2, 3, 4, 5}, {0.3, 0.2, NAN, 0.1}, {0.2, 0.1, 0.1, 0.05}, {0.4, 0.3, 0.2, 0.2}};
  const std::string svg = line_plot(axes(), {with_band, {"5 Hz", {2, 3}, {0.4, 0.3}, {}, {}}});
  EXPECT_EQ(elements(svg, "polygon"), 1);
  EXPECT_EQ(elements(svg, "polyline"), 3);  // one is broken by the NaN
  EXPECT_EQ(elements(svg, "circle"), 5);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(Plot, in_a_file_has_a_background_and_marks_the_given_values) {
  Axes plain{.x_label = "L_max [m]", .y_label = "RMSE [m]"};
  const std::vector<LineSeries> lines{{"10 Hz", {20, 40, 80}, {0.4, 0.3, 0.2}, {}, {}}};
  const std::string in_page = line_plot(plain, lines);
  EXPECT_EQ(elements(in_page, "rect"), 1);  // of the legend
  EXPECT_NE(in_page.find(">60<"), std::string::npos);
  plain.opaque = true;
  plain.x_ticks = {20, 40, 80};
  const std::string in_file = line_plot(plain, lines);
  EXPECT_EQ(elements(in_file, "rect"), 2);
  EXPECT_EQ(in_file.find(">60<"), std::string::npos);
  for (const char* tick : {">20<", ">40<", ">80<"}) EXPECT_NE(in_file.find(tick), std::string::npos) << tick;
  // A series of one value leaves the marks where they are.
  const std::string sparse = line_plot(plain, {{"10 Hz", {40}, {0.4}, {}, {}}});
  const auto first_mark = [](const std::string& svg) { return svg.substr(svg.find("<line"), 60); };
  EXPECT_EQ(first_mark(sparse), first_mark(in_file));
}

TEST(Plot, of_every_kind_survives_every_input) {
  const double huge = 1e300, tiny = 1e-300;
  const std::vector<std::vector<double>> values{
      {}, {0.0}, {5.0, 5.0}, {-3.0, 2.0}, {NAN, INFINITY}, {huge, -huge}, {tiny, 1e-63}, {1.0}};
  for (const bool log_y : {false, true}) {
    for (const bool equal : {false, true}) {
      Axes a = axes();
      a.log_y = log_y;
      a.equal = equal && !log_y;
      for (const auto& v : values) {
        for (const std::string& svg :
             {line_plot(a, {{"s", v, v, {}, {}}}), scatter_plot(a, {{"s", v, v, {}, {}}}),
              histogram(a, {{"s", v}}, 0.5), bar_plot(a, {"g1", "g2"}, {{"b", v}})}) {
          EXPECT_EQ(elements(svg, "svg"), 2) << svg;
        }
      }
    }
  }
  EXPECT_EQ(elements(line_plot(axes(), {}), "svg"), 2);
  EXPECT_EQ(elements(bar_plot(axes(), {}, {}), "svg"), 2);
}

TEST(Plot, bars_and_bins_are_as_many_as_there_are_values) {
  EXPECT_EQ(elements(bar_plot(axes(), {"r1", "r2", "r3"}, {{"", {1, 2, 3}}, {"", {3, 2, 1}}}), "rect"), 6);
  EXPECT_EQ(elements(histogram(axes(), {{"", {0.2, 0.0, 0.8}}}, 10.0), "rect"), 2);
}

TEST(Plot, higher_values_are_higher_up) {
  const std::string svg = scatter_plot({}, {{"", {0, 1}, {1, 2}, {}, {}}});
  tinyxml2::XMLDocument document;
  ASSERT_EQ(document.Parse(svg.c_str()), tinyxml2::XML_SUCCESS);
  const auto* low = document.RootElement()->FirstChildElement("svg")->FirstChildElement("circle");
  const auto* high = low->NextSiblingElement("circle");
  EXPECT_GT(low->DoubleAttribute("cy"), high->DoubleAttribute("cy"));
  EXPECT_LT(low->DoubleAttribute("cx"), high->DoubleAttribute("cx"));
}

TEST(Numbers, are_short) {
  EXPECT_EQ(short_number(0.0), "0");
  EXPECT_EQ(short_number(12.3456), "12.3");
  EXPECT_EQ(short_number(123456.0), "123456");
  EXPECT_EQ(short_number(0.00012, 2), "1.2e-04");
  EXPECT_EQ(short_number(NAN), "-");
}

TEST(HtmlPage, escapes_text_and_nests_its_elements) {
  HtmlPage page(kNasty);
  page.heading(kNasty).paragraph(kNasty).table({{"robot", kNasty}, {"r1", "3"}});
  page.figure(line_plot(axes(), {}), kNasty).picture({1, 2, 3, 4}, kNasty).details("all", kNasty);
  std::string html = page.str();
  EXPECT_EQ(html.find("a<b"), std::string::npos);
  EXPECT_NE(html.find("data:image/png;base64,AQIDBA=="), std::string::npos);
  // The rest is XML but for what HTML leaves open.
  html.erase(0, html.find("<body>"));
  html.erase(html.find("</html>"));
  const std::size_t image = html.find("\">", html.find("<img"));
  html.insert(image + 1, 1, '/');
  EXPECT_EQ(elements(html, "figure"), 2);
  EXPECT_EQ(elements(html, "div"), 2);
  EXPECT_EQ(elements(html, "td"), 2);
}

TEST(HtmlPage, is_written_or_says_why_not) {
  const testing::TemporaryFolder folder;
  EXPECT_TRUE(HtmlPage("t").write(folder.path() / "a.html"));
  EXPECT_FALSE(HtmlPage("t").write(folder.path() / "none" / "a.html"));
}

TEST(Base64, is_that_of_the_standard) {
  const auto of = [](const std::string& text) {
    return base64(std::vector<std::uint8_t>(text.begin(), text.end()));
  };
  EXPECT_EQ(of(""), "");
  EXPECT_EQ(of("f"), "Zg==");
  EXPECT_EQ(of("fo"), "Zm8=");
  EXPECT_EQ(of("foobar"), "Zm9vYmFy");
}

}  // namespace
}  // namespace fleetmap::eval
