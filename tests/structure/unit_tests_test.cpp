// Each unit with logic has a test of its name in the tests of its library.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace fleetmap {
namespace {

namespace fs = std::filesystem;

const fs::path kTop = FLEETMAP_SOURCE_DIR;

/// Returns in a header that make it a unit with logic of its own.
constexpr std::ptrdiff_t kMinReturns = 5;

std::string library_of(const std::string& file) {
  const std::string prefix = file.starts_with("include/") ? "include/fleetmap/" : "src/";
  return file.substr(prefix.size(), file.find('/', prefix.size()) - prefix.size());
}

/// Library and name: "graph/placement" of src/graph/placement.cpp and of
/// include/fleetmap/graph/placement.hpp.
std::string key_of(const std::string& file) {
  return library_of(file) + "/" + fs::path(file).stem().string();
}

std::vector<std::string> files_below(const char* root, const char* extension) {
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(kTop / root)) {
    if (entry.path().extension() == extension) files.push_back(fs::relative(entry.path(), kTop).string());
  }
  return files;
}

bool has_logic(const std::string& header) {
  static const std::regex kReturn(R"(\breturn\b)");
  std::ifstream in(kTop / header);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  return std::distance(std::sregex_iterator(text.begin(), text.end(), kReturn), {}) >= kMinReturns;
}

/// Every source, and every header without a source that has logic.
std::set<std::string> units() {
  std::set<std::string> all, with_source;
  for (const std::string& source : files_below("src", ".cpp")) {
    all.insert(source);
    with_source.insert(key_of(source));
  }
  for (const char* root : {"include/fleetmap", "src"}) {
    for (const std::string& header : files_below(root, ".hpp")) {
      if (!with_source.contains(key_of(header)) && has_logic(header)) all.insert(header);
    }
  }
  return all;
}

/// "graph/placement" of tests/graph/solver/placement_test.cpp.
std::set<std::string> tested() {
  const std::string prefix = "tests/", suffix = "_test";
  std::set<std::string> all;
  for (const std::string& test : files_below("tests", ".cpp")) {
    const std::string stem = fs::path(test).stem().string();
    if (!stem.ends_with(suffix)) continue;
    const std::string library = test.substr(prefix.size(), test.find('/', prefix.size()) - prefix.size());
    all.insert(library + "/" + stem.substr(0, stem.size() - suffix.size()));
  }
  return all;
}

std::set<std::string> excepted() {
  std::set<std::string> all;
  std::ifstream in(kTop / "tests/structure/units_without_test.txt");
  for (std::string line; std::getline(in, line);) {
    if (!line.empty() && line.front() != '#') all.insert(line);
  }
  return all;
}

TEST(UnitTests, EachUnitHasATestOfItsName) {
  const std::set<std::string> all = units(), named = tested(), exceptions = excepted();
  ASSERT_GT(all.size(), 400u) << "the scan found hardly any unit: is FLEETMAP_SOURCE_DIR right?";
  for (const std::string& unit : all) {
    EXPECT_TRUE(named.contains(key_of(unit)) || exceptions.contains(unit))
        << unit << " has no tests/" << library_of(unit) << "/" << fs::path(unit).stem().string()
        << "_test.cpp";
  }
}

TEST(UnitTests, NoExceptionIsLeftOver) {
  const std::set<std::string> all = units(), named = tested();
  for (const std::string& unit : excepted()) {
    EXPECT_TRUE(all.contains(unit)) << unit
                                    << " is listed in units_without_test.txt, but is no unit any more";
    EXPECT_FALSE(named.contains(key_of(unit))) << unit << " has a test now: strike it from the list";
  }
}

}  // namespace
}  // namespace fleetmap
