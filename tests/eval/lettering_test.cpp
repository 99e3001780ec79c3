#include "lettering.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace fleetmap::eval {
namespace {

using ::testing::ElementsAre;

constexpr Rgb kInk{255, 255, 255};

Image blank(int width, int height) {
  return {width, height, std::vector<Rgb>(static_cast<std::size_t>(width * height))};
}

/// Rows of an image, ink as '#'.
std::vector<std::string> rows(const Image& image) {
  std::vector<std::string> text;
  for (int y = 0; y < image.height; ++y) {
    std::string& row = text.emplace_back();
    for (int x = 0; x < image.width; ++x) row += image.at(x, y) == kInk ? '#' : '.';
  }
  return text;
}

std::vector<std::string> letter(std::string_view text) {
  Image image = blank(5, 8);
  draw_text(image, 0, 0, text, kInk, 1);
  return rows(image);
}

TEST(Lettering, LettersAreReadable) {
  EXPECT_THAT(letter("F"),
              ElementsAre("#####", "#....", "#....", "####.", "#....", "#....", "#....", "....."));
  EXPECT_THAT(letter("7"),
              ElementsAre("#####", "....#", "....#", "...#.", "..#..", ".#...", "#....", "....."))
      << "its slash falls to the left";
  EXPECT_THAT(letter("L"),
              ElementsAre("#....", "#....", "#....", "#....", "#....", "#....", "#####", "....."));
  EXPECT_THAT(letter("~")[7], ".....");
  EXPECT_NE(letter("p")[7], ".....") << "what hangs below the line is drawn";
  EXPECT_EQ(rows(blank(5, 8)), letter(" "));
}

TEST(Lettering, OtherBytesAreQuestionMarks) {
  for (const char* other : {"\x7f", "\xc3", "\n", "\x01"}) EXPECT_EQ(letter(other), letter("?"));
  EXPECT_NE(letter("?"), letter(" "));
}

TEST(Lettering, AScaleMakesEachDotASquare) {
  Image image = blank(10, 16);
  draw_text(image, 0, 0, "L", kInk, 2);
  const std::vector<std::string> large = rows(image), small = letter("L");
  for (std::size_t y = 0; y < 16; ++y)
    for (std::size_t x = 0; x < 10; ++x) EXPECT_EQ(large[y][x], small[y / 2][x / 2]);
}

TEST(Lettering, TheWidthIsThatOfTheLettersAndTheGapsBetween) {
  EXPECT_EQ(text_width("", 3), 0);
  EXPECT_EQ(text_width("a", 1), 5);
  EXPECT_EQ(text_width("abc", 2), 34);
  EXPECT_EQ(text_height(3), 21);
  Image image = blank(40, 8);
  draw_text(image, 2, 0, "HHH", kInk, 1);  // an H fills its five columns
  int last = 0;
  for (int x = 0; x < image.width; ++x) last = image.at(x, 3) == kInk ? x : last;
  EXPECT_EQ(last, 2 + text_width("HHH", 1) - 1);
}

TEST(Lettering, TextBeyondTheImageIsCutOff) {
  Image image = blank(4, 4);
  fill_rectangle(image, -2, -2, 4, 3, kInk);
  EXPECT_THAT(rows(image), ElementsAre("##..", "....", "....", "...."));
  fill_rectangle(image, 3, 3, 100, 100, kInk);
  fill_rectangle(image, 50, 50, 5, 5, kInk);
  EXPECT_THAT(rows(image), ElementsAre("##..", "....", "....", "...#"));
  draw_text(image, -3, -3, "HHHHHHHH", kInk, 3);
  EXPECT_EQ(image.pixels.size(), 16u);
}

/// Columns of the widest run of `colour` in a row.
int widest_run(const Image& image, Rgb colour) {
  int widest = 0;
  for (int y = 0; y < image.height; ++y) {
    int run = 0;
    for (int x = 0; x < image.width; ++x) {
      run = image.at(x, y) == colour ? run + 1 : 0;
      widest = std::max(widest, run);
    }
  }
  return widest;
}

TEST(Lettering, TheScaleBarIsARoundLengthOfTheView) {
  // A fifth of 640 pixels; ink is light on the dark ground.
  for (const auto& [metres_per_pixel, pixels] :
       {std::pair{0.1, 100}, std::pair{0.05, 100}, std::pair{0.2, 100}, std::pair{0.04, 125},
        std::pair{1.0, 100}}) {
    Image image = blank(640, 480);
    annotate(image, View{}, metres_per_pixel);
    EXPECT_EQ(widest_run(image, {230, 230, 230}), pixels) << metres_per_pixel;
  }
  Image none = blank(640, 480), hidden = blank(640, 480);
  annotate(none, View{}, 0.0);
  View without;
  without.scale_bar = false;
  annotate(hidden, without, 0.1);
  EXPECT_TRUE(none.pixels == blank(640, 480).pixels);
  EXPECT_TRUE(hidden.pixels == blank(640, 480).pixels);
}

TEST(Lettering, LegendsStandAtTheTopLeftAndBarsAtTheBottomLeft) {
  View view;
  view.legend = {{"r1", {10, 200, 30}}, {"r2", {200, 10, 30}}};
  view.bar = {.title = "error [m]", .low = 0.0, .high = 2.0};
  Image image = blank(640, 480);
  annotate(image, view, 0.0);
  // Boxes of 14 x 7 dots, 11 rows apart, from the margin of 12.
  EXPECT_EQ(image.at(12, 12), (Rgb{10, 200, 30}));
  EXPECT_EQ(image.at(25, 18), (Rgb{10, 200, 30}));
  EXPECT_EQ(image.at(12, 23), (Rgb{200, 10, 30}));
  const int row = 480 - 12 - 18;
  EXPECT_EQ(image.at(12, row), viridis(0.0));
  EXPECT_EQ(image.at(12 + 159, row), viridis(1.0)) << "a quarter of the width";
  view.bar_is_turbo = true;
  annotate(image, view, 0.0);
  EXPECT_EQ(image.at(12, row), turbo(0.0));
}

TEST(Lettering, InkIsDarkOnALightGround) {
  View view;
  view.background = {255, 255, 255};
  view.title = "M";
  Image image = blank(640, 480);
  annotate(image, view, 0.0);
  EXPECT_EQ(image.at(12, 12), (Rgb{30, 30, 30}));
}

}  // namespace
}  // namespace fleetmap::eval
