#include "monitor/foxglove/schemas.hpp"

#include <gtest/gtest.h>

#include <regex>
#include <set>

namespace fleetmap::monitor::foxglove {
namespace {

constexpr ChannelKind kAll[] = {ChannelKind::transforms, ChannelKind::trajectories, ChannelKind::alignments,
                                ChannelKind::map,        ChannelKind::fix,          ChannelKind::status};

TEST(Schemas, have_the_names_by_which_foxglove_recognises_them) {
  EXPECT_EQ(schema_of(ChannelKind::transforms).name, "foxglove::FrameTransforms");
  EXPECT_EQ(schema_of(ChannelKind::trajectories).name, "foxglove::SceneUpdate");
  EXPECT_EQ(schema_of(ChannelKind::alignments).name, "foxglove::SceneUpdate");
  EXPECT_EQ(schema_of(ChannelKind::map).name, "foxglove::PointCloud");
  EXPECT_EQ(schema_of(ChannelKind::fix).name, "foxglove::LocationFix");
  EXPECT_EQ(schema_of(ChannelKind::status).name, "fleetmap::RobotStatus");
}

// foxglove_test.mjs has Foxglove's own parser read them.
TEST(Schemas, define_every_type_before_it_is_used) {
  const std::regex item(R"((?:struct|enum)\s+(\w+)\s*\{|(?:sequence<(\w+)>|(\b\w+))\s+\w+(?:\[\d+\])?;)");
  for (const ChannelKind kind : kAll) {
    const Schema& schema = schema_of(kind);
    std::set<std::string> known = {"double", "uint32", "int32", "uint8", "string", "boolean"};
    const std::string idl = std::regex_replace(schema.idl, std::regex("//[^\n]*"), "");
    for (std::sregex_iterator found(idl.begin(), idl.end(), item), end; found != end; ++found) {
      const std::smatch& match = *found;
      if (match[1].matched) {
        EXPECT_TRUE(known.insert(match[1].str()).second)
            << schema.name << " defines " << match[1] << " twice";
      } else {
        const std::string used = match[2].matched ? match[2].str() : match[3].str();
        EXPECT_TRUE(known.contains(used)) << schema.name << " uses " << used;
      }
    }
    const std::size_t colons = schema.name.find("::");
    EXPECT_NE(schema.idl.find("module " + schema.name.substr(0, colons) + " {"), std::string::npos);
    EXPECT_TRUE(known.contains(schema.name.substr(colons + 2))) << schema.name;
  }
}

}  // namespace
}  // namespace fleetmap::monitor::foxglove
