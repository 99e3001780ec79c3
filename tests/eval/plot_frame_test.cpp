#include "plot_frame.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/field_bounds.hpp"
#include "support/occurrences.hpp"

namespace fleetmap::eval {
namespace {

using fleetmap::testing::kNaN;
using ::testing::HasSubstr;
using ::testing::Not;

Range range(double low, double high) {
  Range both;
  both.add(low);
  both.add(high);
  return both;
}

TEST(PlotRange, HoldsFiniteValuesOnly) {
  Range some;
  EXPECT_TRUE(some.empty());
  for (const double value : {kNaN<double>, HUGE_VAL, -HUGE_VAL}) some.add(value);
  EXPECT_TRUE(some.empty());
  for (const double value : {3.0, -2.0, 1.0}) some.add(value);
  EXPECT_EQ(some.low, -2.0);
  EXPECT_EQ(some.high, 3.0);
}

TEST(PlotFrame, LeavesRoomAroundTheValues) {
  // 600 x 350 without labels: the area is 62 to 582 and 16 to 316.
  const PlotFrame frame({.width = 600, .height = 350}, range(0, 100), range(0, 10), {});
  // Margins of 3 % and 6 % of the values on both sides.
  EXPECT_NEAR(frame.x_pixel(0), 62 + 520 * 3.0 / 106.0, 1e-9);
  EXPECT_NEAR(frame.x_pixel(100), 582 - 520 * 3.0 / 106.0, 1e-9);
  EXPECT_NEAR(frame.y_pixel(0), 316 - 300 * 0.6 / 11.2, 1e-9);
  EXPECT_NEAR(frame.y_pixel(10), 16 + 300 * 0.6 / 11.2, 1e-9);
  EXPECT_EQ(frame.floor_pixel(), 316);
  EXPECT_EQ(frame.x(50), "322.00");
}

TEST(PlotFrame, BarsStandOnTheFloor) {
  const PlotFrame frame({.zero_based = true}, range(0, 1), range(4, 10), {});
  EXPECT_EQ(frame.y_pixel(0), frame.floor_pixel());
  const PlotFrame below({.zero_based = true}, range(0, 1), range(-4, 10), {});
  EXPECT_LT(below.y_pixel(-4), below.floor_pixel()) << "values below zero are shown, too";
}

TEST(PlotFrame, OnAMapBothAxesHaveOneScale) {
  const PlotFrame frame({.width = 900, .height = 300, .equal = true}, range(0, 10), range(0, 40), {});
  const double metre_x = frame.x_pixel(1) - frame.x_pixel(0), metre_y = frame.y_pixel(0) - frame.y_pixel(1);
  EXPECT_NEAR(metre_x, metre_y, 1e-9);
  EXPECT_GE(frame.y_pixel(40), 16.0) << "all of it is shown";
  EXPECT_LE(frame.y_pixel(0), frame.floor_pixel());
}

TEST(PlotFrame, ALogarithmicAxisBeginsAndEndsAtPowersOfTen) {
  const PlotFrame frame({.height = 334, .log_y = true}, range(0, 1), range(0.02, 5), {});
  EXPECT_NEAR(frame.y_pixel(0.01), 300, 1e-9);
  EXPECT_NEAR(frame.y_pixel(10), 16, 1e-9);
  EXPECT_NEAR(frame.y_pixel(0.1), 300 - 284 / 3.0, 1e-9);
  EXPECT_TRUE(frame.shows_y(1e-9));
  for (const double hidden : {0.0, -1.0, kNaN<double>, HUGE_VAL})
    EXPECT_FALSE(frame.shows_y(hidden)) << hidden;
  const PlotFrame linear({}, range(0, 1), range(0, 1), {});
  EXPECT_TRUE(linear.shows_y(-1.0));
  EXPECT_FALSE(linear.shows_y(kNaN<double>));
}

TEST(PlotFrame, TicksAreRoundNumbers) {
  const auto ticks_of = [](double high) {
    const std::string svg = PlotFrame({}, range(0, high), range(0, 1), {}).finish();
    std::vector<std::string> found;
    // Labels of the x axis stand below the drawing, which ends at 366.
    for (std::size_t at = svg.find("y=\"384.00\""); at != std::string::npos;
         at = svg.find("y=\"384.00\"", at + 1)) {
      const std::size_t begin = svg.find('>', at) + 1;
      found.push_back(svg.substr(begin, svg.find('<', begin) - begin));
    }
    return found;
  };
  EXPECT_THAT(ticks_of(10), ::testing::ElementsAre("0", "2", "4", "6", "8", "10"));
  EXPECT_THAT(ticks_of(25), ::testing::ElementsAre("0", "5", "10", "15", "20", "25"));
  EXPECT_THAT(ticks_of(0.5), ::testing::ElementsAre("0", "0.1", "0.2", "0.3", "0.4", "0.5"));
}

TEST(PlotFrame, CategoriesStandAtWholeNumbersAndReplaceTheTicks) {
  const PlotFrame frame({.width = 662}, {}, range(0, 1), {}, {"first", "second"});
  EXPECT_NEAR(frame.x_pixel(0), 62 + 582 * 0.25, 1e-9);
  EXPECT_NEAR(frame.x_pixel(1), 62 + 582 * 0.75, 1e-9);
  const std::string svg = frame.finish();
  EXPECT_THAT(svg, HasSubstr(">second</text>"));
  EXPECT_THAT(svg, Not(HasSubstr(">0.5</text>\n<line")));
}

TEST(PlotFrame, TheLegendHasTheNamesAndTheColoursOfTheirSeries) {
  const std::string svg = PlotFrame({}, range(0, 1), range(0, 1), {"one", "", "three"}).finish();
  EXPECT_THAT(svg, HasSubstr(">one</text>"));
  EXPECT_THAT(svg, HasSubstr("fill=\"" + plot_colour(0) + "\"/>"));
  EXPECT_THAT(svg, HasSubstr("fill=\"" + plot_colour(2) + "\"/>"));
  EXPECT_THAT(svg, Not(HasSubstr("fill=\"" + plot_colour(1) + "\"/>")));
  EXPECT_NE(plot_colour(0), plot_colour(1));
  EXPECT_EQ(plot_colour(6), plot_colour(0));
  // Names that do not fit side by side take rows from the drawing.
  const std::vector<std::string> many(8, std::string(30, 'x'));
  const PlotFrame crowded({}, range(0, 1), range(0, 1), many), free({}, range(0, 1), range(0, 1), {});
  EXPECT_GT(crowded.y_pixel(1), free.y_pixel(1) + 3 * 18.0 * 0.9);
  EXPECT_EQ(crowded.y_pixel(0) < crowded.floor_pixel(), true);
  EXPECT_EQ(fleetmap::testing::occurrences(crowded.finish(), std::string(30, 'x')), 8u);
}

TEST(PlotFrame, WithoutValuesItIsStillAPlot) {
  for (const bool log_y : {false, true}) {
    const PlotFrame frame({.title = "nothing", .log_y = log_y}, {}, {}, {});
    EXPECT_TRUE(std::isfinite(frame.x_pixel(0.5)) && std::isfinite(frame.y_pixel(0.5)));
    EXPECT_THAT(frame.finish(), HasSubstr(">nothing</text>"));
  }
}

TEST(PlotFrame, PixelsHaveTwoDecimalsAndALimit) {
  EXPECT_EQ(pixel(1.234), "1.23");
  EXPECT_EQ(pixel(-0.5), "-0.50");
  EXPECT_EQ(pixel(1e300), "1000000.00");
  EXPECT_EQ(pixel(kNaN<double>), "0.00");
}

}  // namespace
}  // namespace fleetmap::eval
