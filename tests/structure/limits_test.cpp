// Files, functions and lines stay so short that they are read at once.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "function_scan.hpp"
#include "source_tree.hpp"

namespace fleetmap::structure {
namespace {

constexpr std::size_t kMaxFileLines = 349;
constexpr int kMaxFunctionLines = 50;
constexpr std::ptrdiff_t kMaxLineCharacters = 120, kMaxDocumentLineCharacters = 119;

std::vector<std::string> cpp_files() {
  std::vector<std::string> files;
  for (const char* root : {"include", "src", "tests"}) {
    const auto more = cpp_files_below(root);
    files.insert(files.end(), more.begin(), more.end());
  }
  return files;
}

/// The monitor's page, and the tests that Node runs.
std::vector<std::string> script_files() {
  std::vector<std::string> files;
  for (const char* root : {"src", "tests"}) {
    for (const char* extension : {".ts", ".mjs"}) {
      const auto more = files_below(root, extension);
      files.insert(files.end(), more.begin(), more.end());
    }
  }
  return files;
}

/// Counts the bytes that begin a character in UTF-8.
std::ptrdiff_t characters(const std::string& line) {
  return std::ranges::count_if(line, [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; });
}

void expect_short_lines(const std::string& file, std::ptrdiff_t max_characters = kMaxLineCharacters) {
  int number = 0;
  for (const std::string& line : lines_of(file)) {
    ++number;
    EXPECT_LE(characters(line), max_characters) << file << ":" << number;
  }
}

TEST(Limits, FilesHaveFewerThan350Lines) {
  const auto files = cpp_files();
  ASSERT_GT(files.size(), 1000u) << "the scan found hardly any file: is FLEETMAP_SOURCE_DIR right?";
  for (const std::string& file : files) EXPECT_LE(lines_of(file).size(), kMaxFileLines) << file;
}

TEST(Limits, ScriptsHaveFewerThan350LinesOf120Characters) {
  const auto files = script_files();
  ASSERT_GT(files.size(), 50u) << "the scan found hardly any script";
  for (const std::string& file : files) {
    EXPECT_LE(lines_of(file).size(), kMaxFileLines) << file;
    expect_short_lines(file);
  }
  expect_short_lines("src/monitor/page/style.css");
}

TEST(Limits, FunctionsHaveAtMost50Lines) {
  std::size_t functions = 0;
  for (const std::string& file : cpp_files()) {
    for (const FunctionLines& function : functions_in(text_of(file))) {
      ++functions;
      EXPECT_LE(function.lines, kMaxFunctionLines) << file << ":" << function.line << ": " << function.header;
    }
  }
  EXPECT_GT(functions, 5000u) << "the scan found hardly any function";
}

TEST(Limits, LinesOfSourcesHaveAtMost120Characters) {
  for (const std::string& file : cpp_files()) expect_short_lines(file);
}

TEST(Limits, DocumentsHaveLinesBelow120Characters) {
  for (const char* page :
       {"README.md", "docs/architecture.md", "docs/contributing.md", "docs/terminology.md"})
    expect_short_lines(page, kMaxDocumentLineCharacters);
  for (const char* folder : {"docs/method", "docs/results"}) {
    const auto pages = files_below(folder, ".md");
    EXPECT_GT(pages.size(), 3u) << folder;
    for (const std::string& page : pages) expect_short_lines(page, kMaxDocumentLineCharacters);
  }
}

TEST(Limits, MethodAndResultsHaveFewerThan12000Words) {
  std::size_t words = 0;
  for (const char* folder : {"docs/method", "docs/results"}) {
    for (const std::string& page : files_below(folder, ".md")) {
      std::istringstream text(text_of(page));
      words += static_cast<std::size_t>(std::distance(std::istream_iterator<std::string>(text), {}));
    }
  }
  EXPECT_GT(words, 5000u) << "the scan found hardly any page";
  EXPECT_LT(words, 12'000u);
}

}  // namespace
}  // namespace fleetmap::structure
