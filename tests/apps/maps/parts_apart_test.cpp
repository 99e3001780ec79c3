#include "maps/parts_apart.hpp"

#include <gtest/gtest.h>

#include <sstream>

namespace fleetmap::apps {
namespace {

graph::FrameId session_of_robot(const char* name, std::uint16_t session = 0) {
  return {*AgentId::parse(name), session};
}

TEST(PartsApart, NamesTheFramesOfEachPartInALineOfItsOwn) {
  output::MapParts parts;
  parts.main.frames = {session_of_robot("r1")};
  parts.apart.resize(2);
  parts.apart[0].frames = {session_of_robot("r2"), session_of_robot("r3")};
  parts.apart[1].frames = {session_of_robot("r4", 7)};
  std::ostringstream err;
  name_parts_apart(parts, err);
  EXPECT_EQ(err.str(),
            "not in it, for nobody knows where to lay them: r2 r3\n"
            "not in it, for nobody knows where to lay them: r4#7\n");
}

TEST(PartsApart, SaysNothingOfAMapThatHoldsAllFrames) {
  output::MapParts parts;
  parts.main.frames = {session_of_robot("r1"), session_of_robot("r2")};
  std::ostringstream err;
  name_parts_apart(parts, err);
  EXPECT_EQ(err.str(), "");
}

}  // namespace
}  // namespace fleetmap::apps
