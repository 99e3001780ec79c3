// A name in an anonymous namespace belongs to one file of its library or suite of tests: several files can
// then be compiled as one, and a reader who searches for it finds one thing.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "source_tree.hpp"

namespace fleetmap::structure {
namespace {

bool is_of_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// The identifier that ends at `end`, spaces between left out.
std::string name_before(std::string_view line, std::size_t end) {
  while (end > 0 && line[end - 1] == ' ') --end;
  std::size_t begin = end;
  while (begin > 0 && is_of_name(line[begin - 1])) --begin;
  return std::string(line.substr(begin, end - begin));
}

/// Names that a line without indentation declares: a function, a type, or one or several constants.
std::vector<std::string> names_declared_by(std::string_view line) {
  constexpr std::string_view kNoDeclaration = " }#/):\"";
  if (line.empty() || kNoDeclaration.find(line.front()) != std::string_view::npos) return {};
  // Two files may make the same alias.
  for (const std::string_view no_name : {"template", "namespace", "using", "friend", "static_assert"}) {
    if (line.starts_with(no_name)) return {};
  }
  for (const std::string_view type : {"struct ", "enum class ", "class ", "enum "}) {
    if (!line.starts_with(type)) continue;
    const auto begin = line.begin() + static_cast<std::ptrdiff_t>(type.size());
    std::vector<std::string> names{std::string(begin, std::find_if_not(begin, line.end(), is_of_name))};
    if (names.front().empty()) names.clear();  // of an enum without a name
    if (type != "enum ") return names;         // whose enumerators are names of their own
    for (std::size_t k = line.find('{'); k < line.size(); ++k) {
      if (std::string_view(",=}").find(line[k]) == std::string_view::npos) continue;
      std::string name = name_before(line, k);
      if (!name.empty() && std::isdigit(static_cast<unsigned char>(name.front())) == 0)
        names.push_back(std::move(name));
    }
    return names;
  }
  std::vector<std::string> names;
  int angles = 0, others = 0;
  bool wanted = true;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const char c = line[k];
    if (c == '<') ++angles;
    if (c == '>') --angles;
    if (angles == 0 && others == 0 && wanted &&
        std::string_view("=({[;:").find(c) != std::string_view::npos) {
      if (c == ':' && (line.substr(k, 2) == "::" || (k > 0 && line[k - 1] == ':'))) continue;
      std::string name = name_before(line, k);
      const bool is_member = name.size() < k && line[k - name.size() - 1] == ':';
      if (!name.empty() && !is_member) names.push_back(std::move(name));
      wanted = false;
      if (c == '(') break;  // of a function
    }
    if (c == '(' || c == '{' || c == '[') ++others;
    if (c == ')' || c == '}' || c == ']') --others;
    if (c == ',' && angles == 0 && others == 0) wanted = true;
    if (c == ';' || (c == '/' && line.substr(k, 2) == "//")) break;
  }
  return names;
}

std::vector<std::string> lines_of_anonymous_namespaces(const std::vector<std::string>& lines) {
  std::vector<std::string> found;
  bool anonymous = false;
  for (const std::string& line : lines) {
    if (line == "namespace {") anonymous = true;
    if (line == "}  // namespace") anonymous = false;
    if (anonymous) found.push_back(line);
  }
  return found;
}

std::set<std::string> file_local_names(const std::vector<std::string>& lines) {
  std::set<std::string> names;
  for (const std::string& line : lines_of_anonymous_namespaces(lines)) {
    for (std::string& name : names_declared_by(line)) names.insert(std::move(name));
  }
  return names;
}

/// The name that an alias ("using X = Y;") or a matcher ("MATCHER_P(X, ...") of a file of tests declares. Two
/// files compiled as one cannot each declare it for a type or a matcher of its own.
std::vector<std::string> alias_or_matcher(std::string_view line) {
  std::size_t end = std::string_view::npos;
  if (line.starts_with("using ")) end = line.find(" = ");
  if (line.starts_with("MATCHER")) end = line.find(',', line.find('('));
  if (end == std::string_view::npos) return {};
  return {name_before(line, end)};
}

/// Cases of tests have names of their own.
bool is_test_macro(std::string_view line) {
  return std::ranges::any_of(std::array{"TEST", "TYPED_TEST", "INSTANTIATE_", "MATCHER"},
                             [&](std::string_view macro) { return line.starts_with(macro); });
}

std::set<std::string> file_local_names_of_test(const std::vector<std::string>& lines) {
  std::set<std::string> names;
  for (const std::string& line : lines_of_anonymous_namespaces(lines)) {
    for (std::string& name : alias_or_matcher(line)) names.insert(std::move(name));
    if (is_test_macro(line)) continue;
    for (std::string& name : names_declared_by(line)) names.insert(std::move(name));
  }
  return names;
}

TEST(FileLocalNames, AreReadFromDeclarations) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(names_declared_by("constexpr double kNear = 2.0, kFar = 3.0;  // m"), (Names{"kNear", "kFar"}));
  EXPECT_EQ(names_declared_by("constexpr std::array<int, 2> kBoth{1, 2};"), Names{"kBoth"});
  EXPECT_EQ(names_declared_by("Result<std::vector<int>> read(const Bytes& bytes, int count) {"),
            Names{"read"});
  EXPECT_EQ(names_declared_by("std::optional<core::Stamp> stamp_of("), Names{"stamp_of"});
  EXPECT_EQ(names_declared_by("struct Side final : Base {"), Names{"Side"});
  EXPECT_EQ(names_declared_by("class Grid {"), Names{"Grid"});
  EXPECT_EQ(names_declared_by("enum Type : int { kOne = 1, kTwo };"), (Names{"Type", "kOne", "kTwo"}));
  EXPECT_EQ(names_declared_by("enum : Index { kTwo = 2 };"), Names{"kTwo"});
  EXPECT_EQ(names_declared_by("Status Grid::add(int value) {"), Names{});
  EXPECT_EQ(names_declared_by("using Phase = Candidate::Phase;"), Names{});
  EXPECT_EQ(names_declared_by("std::atomic<bool> stop_requested{false};"), Names{"stop_requested"});
  EXPECT_EQ(names_declared_by("  const int inner = 1;"), Names{});
  EXPECT_EQ(names_declared_by("namespace fs = std::filesystem;"), Names{});
}

TEST(FileLocalNames, OfTestsAreAliasesAndMatchersToo) {
  const std::vector<std::string> lines{"namespace {",
                                       "using Points = std::vector<int>;",
                                       "using testing::agent;",
                                       "using namespace std::chrono_literals;",
                                       "MATCHER_P(IsNear, place, \"\") { return true; }",
                                       "MATCHER(IsSigned, \"\") {",
                                       "TEST(Points, AreMany) {",
                                       "TYPED_TEST_SUITE(PointsTest, Kinds);",
                                       "const AgentId kSelf = agent(\"r1\"), kPeer = agent(\"r2\");",
                                       "}  // namespace",
                                       "struct Shared {"};
  EXPECT_EQ(file_local_names_of_test(lines),
            (std::set<std::string>{"IsNear", "IsSigned", "Points", "kPeer", "kSelf"}));
}

TEST(FileLocalNames, BelongToOneFileOfTheirLibrary) {
  std::map<std::string, std::map<std::string, std::string>> owners;  // library, name, file
  std::size_t names = 0;
  for (const std::string& file : files_below("src", ".cpp")) {
    const std::string library = library_of(file);
    if (file.ends_with("_command.cpp")) continue;  // each has a run() for options of its own
    for (const std::string& name : file_local_names(lines_of(file))) {
      ++names;
      const auto [owner, is_first] = owners[library].emplace(name, file);
      EXPECT_TRUE(is_first) << name << " is in " << owner->second << " and in " << file
                            << ": share it in a header, or name each by what it is";
    }
  }
  EXPECT_GT(names, 1500u) << "the tree is read";
}

TEST(FileLocalNames, BelongToOneFileOfTheirSuite) {
  std::map<std::string, std::map<std::string, std::string>> owners;  // suite, name, file
  std::size_t names = 0;
  for (const std::string& file : files_below("tests", ".cpp")) {
    const std::string suite = library_of(file);
    if (suite == "bench" || suite == "fuzz") continue;  // each file is a program of its own
    for (const std::string& name : file_local_names_of_test(lines_of(file))) {
      ++names;
      const auto [owner, is_first] = owners[suite].emplace(name, file);
      EXPECT_TRUE(is_first) << name << " is in " << owner->second << " and in " << file
                            << ", which are compiled as one: move it into a header of tests/" << suite
                            << " if both mean the same, or else name each by what it is";
    }
  }
  EXPECT_GT(names, 1500u) << "the tree is read";
}

}  // namespace
}  // namespace fleetmap::structure
