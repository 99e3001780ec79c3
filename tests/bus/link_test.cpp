#include "fleetmap/bus/link.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>

namespace fleetmap::bus {
namespace {

TEST(Link, HasAProfileFileOfItsName) {
  std::set<std::string> names;
  for (const Link link : {Link::kOnboard, Link::kLongRange, Link::kShortRange}) names.insert(to_string(link));
  EXPECT_EQ(names, (std::set<std::string>{"onboard", "long_range", "short_range"}));
  std::set<std::string> files;
  for (const auto& file : std::filesystem::directory_iterator(FLEETMAP_SOURCE_DIR "/qos"))
    files.insert(file.path().stem().string());
  EXPECT_EQ(names, files);
  EXPECT_STREQ(to_string(Link::kLongRange), "long_range");
  EXPECT_STREQ(to_string(static_cast<Link>(3)), "unknown");
}

}  // namespace
}  // namespace fleetmap::bus
