// Comments are sentences or name their subject: none begins as a riddle ("What the others hold").
#include <gtest/gtest.h>

#include <regex>
#include <string>

#include "source_tree.hpp"

namespace fleetmap::structure {
namespace {

TEST(Comments, NoneBeginsWithAQuestionWord) {
  static const std::regex kRiddle(R"(^\s*///? *(What|Where|How|Who|Whose|Whatever|Of)\b)");
  static const std::regex kComment(R"(^\s*//)");
  for (const char* root : {"include", "src", "tests"}) {
    for (const std::string& file : cpp_files_below(root)) {
      bool begins = true;
      int number = 0;
      for (const std::string& line : lines_of(file)) {
        ++number;
        if (begins) {
          EXPECT_FALSE(std::regex_search(line, kRiddle)) << file << ":" << number << ":" << line;
        }
        begins = !std::regex_search(line, kComment);
      }
    }
  }
}

}  // namespace
}  // namespace fleetmap::structure
