#include "sim/mesh_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace fleetmap::sim {
namespace {

using ::testing::ElementsAre;

TEST(MeshText, LinesEndInAnyWayAndAreCounted) {
  Lines lines("one\r\n\ntwo \rx\nlast");
  std::vector<std::string> all;
  std::string_view line;
  while (lines.next(line)) all.emplace_back(line);
  EXPECT_THAT(all, ElementsAre("one", "", "two \rx", "last"));
  EXPECT_EQ(lines.number(), 4u);
  EXPECT_EQ(lines.rest(), "");
  Lines ended("a\n");
  EXPECT_TRUE(ended.next(line));
  EXPECT_FALSE(ended.next(line)) << "what ends with a newline has no empty line behind it";
}

TEST(MeshText, TheRestIsWhatNoLineTook) {
  Lines lines("head\n\1\2\n\3");
  std::string_view line;
  ASSERT_TRUE(lines.next(line));
  EXPECT_EQ(lines.rest(), "\1\2\n\3");
}

TEST(MeshText, WordsAreSeparatedByBlanksAndTabs) {
  std::string_view line = " \tf  1/2\t-3 ";
  std::vector<std::string> words;
  for (std::string_view word = next_word(line); !word.empty(); word = next_word(line))
    words.emplace_back(word);
  EXPECT_THAT(words, ElementsAre("f", "1/2", "-3"));
  EXPECT_TRUE(line.empty());
  EXPECT_TRUE(next_word(line).empty());
}

TEST(MeshText, ANumberIsTheWholeWord) {
  EXPECT_EQ(number_from<double>("-1.5e3"), -1500.0);
  EXPECT_EQ(number_from<double>("+2"), 2.0);
  EXPECT_EQ(number_from<int>("-7"), -7);
  for (const char* word : {"", "+", "1.5x", "x", "1,5", " 1", "0x10", "--1"})
    EXPECT_EQ(number_from<double>(word), std::nullopt) << word;
  EXPECT_EQ(number_from<int>("1.5"), std::nullopt);
  EXPECT_EQ(number_from<int>("99999999999"), std::nullopt) << "out of range";
  EXPECT_EQ(number_from<std::uint64_t>("-1"), std::nullopt);
}

TEST(MeshText, CoordinatesLieWithin100Km) {
  EXPECT_TRUE(is_coordinate(0.0));
  EXPECT_TRUE(is_coordinate(-1e5));
  EXPECT_FALSE(is_coordinate(100'000.1));
  EXPECT_FALSE(is_coordinate(-std::numeric_limits<double>::infinity()));
  EXPECT_FALSE(is_coordinate(std::nan("")));
}

TEST(MeshText, FailuresBeginWithTheirPlace) {
  EXPECT_EQ(failure_at_line(12, "no number").value().message, ":12: no number");
  EXPECT_EQ(failure_at_byte(7, "cut off").value().message, ": byte 7: cut off");
  EXPECT_EQ(in_quotes("abc"), "'abc'");
  EXPECT_EQ(in_quotes(std::string(100, 'x')), "'" + std::string(40, 'x') + "'")
      << "files may have any content";
}

}  // namespace
}  // namespace fleetmap::sim
