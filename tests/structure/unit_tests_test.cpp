// Each unit with logic has a test of its name in the tests of its library.
#include <gtest/gtest.h>

#include <filesystem>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "source_tree.hpp"

namespace fleetmap {
namespace {

using structure::files_below;
using structure::library_of;
using structure::unit_of;

/// Returns in a header that make it a unit with logic of its own.
constexpr std::ptrdiff_t kMinReturns = 5;

bool has_logic(const std::string& header) {
  static const std::regex kReturn(R"(\breturn\b)");
  const std::string text = structure::text_of(header);
  return std::distance(std::sregex_iterator(text.begin(), text.end(), kReturn), {}) >= kMinReturns;
}

/// Every source, and every header without a source that has logic.
std::set<std::string> units() {
  std::set<std::string> all, with_source;
  for (const std::string& source : files_below("src", ".cpp")) {
    all.insert(source);
    with_source.insert(unit_of(source));
  }
  for (const char* root : {"include/fleetmap", "src"}) {
    for (const std::string& header : files_below(root, ".hpp")) {
      if (!with_source.contains(unit_of(header)) && has_logic(header)) all.insert(header);
    }
  }
  return all;
}

/// "graph/placement" of tests/graph/solver/placement_test.cpp.
std::set<std::string> tested() {
  const std::string suffix = "_test";
  std::set<std::string> all;
  for (const std::string& test : files_below("tests", ".cpp")) {
    const std::string unit = unit_of(test);
    if (unit.ends_with(suffix)) all.insert(unit.substr(0, unit.size() - suffix.size()));
  }
  return all;
}

std::set<std::string> excepted() {
  std::set<std::string> all;
  for (const std::string& line : structure::lines_of("tests/structure/units_without_test.txt")) {
    if (!line.empty() && line.front() != '#') all.insert(line);
  }
  return all;
}

TEST(UnitTests, EachUnitHasATestOfItsName) {
  const std::set<std::string> all = units(), named = tested(), exceptions = excepted();
  ASSERT_GT(all.size(), 400u) << "the scan found hardly any unit: is FLEETMAP_SOURCE_DIR right?";
  for (const std::string& unit : all) {
    EXPECT_TRUE(named.contains(unit_of(unit)) || exceptions.contains(unit))
        << unit << " has no tests/" << library_of(unit) << "/" << std::filesystem::path(unit).stem().string()
        << "_test.cpp";
  }
}

TEST(UnitTests, NoExceptionIsLeftOver) {
  const std::set<std::string> all = units(), named = tested();
  for (const std::string& unit : excepted()) {
    EXPECT_TRUE(all.contains(unit)) << unit
                                    << " is listed in units_without_test.txt, but is no unit any more";
    EXPECT_FALSE(named.contains(unit_of(unit))) << unit << " has a test now: strike it from the list";
  }
}

}  // namespace
}  // namespace fleetmap
