#include "maps/parts_apart.hpp"

#include <gtest/gtest.h>

#include <sstream>

namespace fleetmap::apps {
namespace {

TEST(PartsApart, NamesTheFramesOfEachPartInALineOfItsOwn) {
  output::MapParts parts;
  parts.main.frames = {{1, 0}};
  parts.apart.resize(2);
  parts.apart[0].frames = {{2, 0}, {3, 0}};
  parts.apart[1].frames = {{4, 7}};
  std::ostringstream err;
  name_parts_apart(parts, err);
  EXPECT_EQ(err.str(),
            "not in it, for nobody knows where to lay them: r2 r3\n"
            "not in it, for nobody knows where to lay them: r4.7\n");
}

TEST(PartsApart, SaysNothingOfAMapThatHoldsAllFrames) {
  output::MapParts parts;
  parts.main.frames = {{1, 0}, {2, 0}};
  std::ostringstream err;
  name_parts_apart(parts, err);
  EXPECT_EQ(err.str(), "");
}

}  // namespace
}  // namespace fleetmap::apps
