// Each unit with logic has a test of its name in the tests of its library.
#include <gtest/gtest.h>

#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "source_tree.hpp"

namespace fleetmap {
namespace {

using structure::files_below;
using structure::unit_of;

/// Returns in a header that make it a unit with logic of its own; an interface has some of its defaults.
constexpr std::ptrdiff_t kMinReturns = 3, kMinReturnsOfInterface = 5;

bool has_logic(const std::string& header) {
  static const std::regex kReturn(R"(\breturn\b)");
  const std::string text = structure::text_of(header);
  const auto returns = std::distance(std::sregex_iterator(text.begin(), text.end(), kReturn), {});
  return returns >= (text.find(") = 0;") == text.npos && text.find("const = 0;") == text.npos
                         ? kMinReturns
                         : kMinReturnsOfInterface);
}

/// Every source, every header without a source that has logic, and every module of the monitor's page.
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
  for (const std::string& module : files_below("src", ".ts")) all.insert(module);
  return all;
}

/// "graph/placement" of tests/graph/solver/placement_test.cpp, for sources of that language.
std::set<std::string> tested(const std::string& extension) {
  const std::string suffix = "_test";
  std::set<std::string> all;
  for (const std::string& test : files_below("tests", extension)) {
    const std::string unit = unit_of(test);
    if (unit.ends_with(suffix)) all.insert(unit.substr(0, unit.size() - suffix.size()));
  }
  return all;
}

/// The path of the test that a unit is to have: tests/graph/placement_test.cpp, or in a folder below that.
std::string test_of(const std::string& unit) {
  const std::string prefix = "src/", suffix = ".ts";
  if (!unit.ends_with(suffix)) return "tests/" + unit_of(unit) + "_test.cpp";
  const std::size_t length = unit.size() - prefix.size() - suffix.size();
  return "tests/" + unit.substr(prefix.size(), length) + "_test.mjs";
}

/// Tests a unit's language: a .cpp of the same name does not test a module of the page.
bool is_tested(const std::string& unit) {
  static const std::set<std::string> kCpp = tested(".cpp"), kScripts = tested(".mjs");
  return (unit.ends_with(".ts") ? kScripts : kCpp).contains(unit_of(unit));
}

std::set<std::string> excepted() {
  std::set<std::string> all;
  for (const std::string& line : structure::lines_of("tests/structure/units_without_test.txt")) {
    if (!line.empty() && line.front() != '#') all.insert(line);
  }
  return all;
}

TEST(UnitTests, EachUnitHasATestOfItsName) {
  const std::set<std::string> all = units(), exceptions = excepted();
  ASSERT_GT(all.size(), 400u) << "the scan found hardly any unit: is FLEETMAP_SOURCE_DIR right?";
  ASSERT_TRUE(all.contains("src/monitor/page/geodesy.ts"));
  for (const std::string& unit : all)
    EXPECT_TRUE(is_tested(unit) || exceptions.contains(unit)) << unit << " has no " << test_of(unit);
}

TEST(UnitTests, NoExceptionIsLeftOver) {
  const std::set<std::string> all = units();
  for (const std::string& unit : excepted()) {
    EXPECT_TRUE(all.contains(unit)) << unit
                                    << " is listed in units_without_test.txt, but is no unit any more";
    EXPECT_FALSE(is_tested(unit)) << unit << " has a test now: strike it from the list";
  }
}

}  // namespace
}  // namespace fleetmap
