// A header lies in include/ if another library needs it, a source has a header of its name, and a
// configuration has a header of its own.
#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "source_tree.hpp"

namespace fleetmap::structure {
namespace {

/// Sources without a header of their name, and the header that declares what they define.
const std::map<std::string, std::string> kDeclaredElsewhere = {
    {"src/apps/twin/virtual_fleet_power.cpp",
     "src/apps/twin/virtual_fleet.hpp"},                                    // more of class VirtualFleet
    {"src/bus/dds/introduced_robots.cpp", "src/bus/dds/radio_hellos.hpp"},  // more of class RadioLink::Hellos
};

/// Programs and subcommands: src/apps/commands.hpp declares one function of each of these.
bool is_command(const std::string& source) {
  return source == "src/apps/main.cpp" ||
         (source.starts_with("src/apps/") && source.ends_with("_command.cpp"));
}

/// Public headers by the name under which they are included ("fleetmap/graph/node.hpp").
std::set<std::string> public_headers() {
  const std::string root = "include/";
  std::set<std::string> headers;
  for (const std::string& file : cpp_files_below("include")) headers.insert(file.substr(root.size()));
  return headers;
}

/// Public headers that other libraries, programs or tests of others include, and what those include in turn.
std::set<std::string> needed_outside() {
  const std::set<std::string> all = public_headers();
  std::set<std::string> needed;
  std::multimap<std::string, std::string> of_public_header;
  for (const char* root : {"include", "src", "tests"}) {
    for (const std::string& file : cpp_files_below(root)) {
      for (const Include& include : includes_of(file)) {
        const std::string header = include.target.substr(1, include.target.size() - 2);
        if (!all.contains(header)) continue;
        if (library_of("include/" + header) != library_of(file)) needed.insert(header);
        if (file.starts_with("include/")) of_public_header.emplace(file.substr(8), header);
      }
    }
  }
  std::vector<std::string> open(needed.begin(), needed.end());
  while (!open.empty()) {
    const auto [begin, end] = of_public_header.equal_range(open.back());
    open.pop_back();
    for (auto next = begin; next != end; ++next) {
      if (needed.insert(next->second).second) open.push_back(next->second);
    }
  }
  return needed;
}

/// "las_map_config" of "LasMapConfig".
std::string snake_case(const std::string& name) {
  std::string snake;
  for (const char c : name) {
    const bool upper = std::isupper(static_cast<unsigned char>(c)) != 0;
    if (upper && !snake.empty()) snake += '_';
    snake += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return snake;
}

TEST(Headers, PublicOnesAreNeededByOthers) {
  const std::set<std::string> all = public_headers(), needed = needed_outside();
  ASSERT_GT(all.size(), 200u) << "the scan found hardly any header: is FLEETMAP_SOURCE_DIR right?";
  for (const std::string& header : all) {
    EXPECT_TRUE(needed.contains(header))
        << "include/" << header << ": no other library includes it, so it belongs into src/"
        << library_of("include/" + header);
  }
}

TEST(Headers, EachSourceHasOneOfItsName) {
  std::set<std::string> units;
  for (const char* root : {"include/fleetmap", "src"}) {
    for (const std::string& header : files_below(root, ".hpp")) units.insert(unit_of(header));
  }
  const auto sources = files_below("src", ".cpp");
  ASSERT_GT(sources.size(), 400u);
  for (const std::string& source : sources) {
    if (is_command(source) || kDeclaredElsewhere.contains(source)) continue;
    EXPECT_TRUE(units.contains(unit_of(source))) << source << " has no header of its name";
  }
  for (const auto& [source, header] : kDeclaredElsewhere) {
    EXPECT_FALSE(text_of(source).empty()) << source << " is listed, but is no source any more";
    EXPECT_FALSE(text_of(header).empty()) << header;
    EXPECT_FALSE(units.contains(unit_of(source))) << source << " has a header now: strike it from the list";
  }
}

TEST(Headers, EachConfigurationHasOneOfItsOwn) {
  static const std::regex kConfig(R"((^|\n) *struct (\w+(Config|Options|Limits|Spec)) \{)");
  std::size_t found = 0;
  for (const char* root : {"include", "src"}) {
    for (const std::string& file : cpp_files_below(root)) {
      const std::string text = text_of(file);
      for (std::sregex_iterator match(text.begin(), text.end(), kConfig), end; match != end; ++match) {
        ++found;
        const std::string name = (*match)[2];
        EXPECT_EQ(std::filesystem::path(file).filename(), snake_case(name) + ".hpp") << name;
      }
    }
  }
  EXPECT_GT(found, 80u);
}

}  // namespace
}  // namespace fleetmap::structure
