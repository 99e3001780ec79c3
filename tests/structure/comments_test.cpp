// Comments are sentences or name their subject: none begins as a riddle ("What the others hold").
#include <gtest/gtest.h>

#include <regex>
#include <string>

#include "source_tree.hpp"

namespace fleetmap::structure {
namespace {

TEST(Comments, NoneBeginsWithAQuestionWord) {
  static const std::regex kRiddle(R"(^\s*(///?|\*|/\*\*?|#) *(What|Where|How|Who|Whose|Whatever|Of)\b)");
  static const std::regex kTrailing(R"(///< *(what|who|whose|whatever)\b)");
  static const std::regex kSentence(R"(^\s*(//|\*|#).*[a-z0-9)`]\. (What|Who|Whose|Whoever|Whatever|Of)\b)");
  static const std::regex kComment(R"(^\s*(//|\*|/\*|#))");
  std::size_t files = 0;
  for (const char* root : {"include", "src", "tests", "idl", "config", "qos", "deploy", "cmake"}) {
    for (const char* extension :
         {".cpp", ".hpp", ".h", ".idl", ".ts", ".mjs", ".yaml", ".sh", ".py", ".cmake", ".txt"}) {
      for (const std::string& file : files_below(root, extension)) {
        if (file.find("/corpus/") != std::string::npos) continue;
        ++files;
        bool begins = true;
        int number = 0;
        for (const std::string& line : lines_of(file)) {
          ++number;
          if (begins) {
            EXPECT_FALSE(std::regex_search(line, kRiddle)) << file << ":" << number << ":" << line;
          }
          EXPECT_FALSE(std::regex_search(line, kSentence)) << file << ":" << number << ":" << line;
          EXPECT_FALSE(std::regex_search(line, kTrailing)) << file << ":" << number << ":" << line;
          begins = !std::regex_search(line, kComment);
        }
      }
    }
  }
  EXPECT_GT(files, 1000u) << "the tree is read";
}

}  // namespace
}  // namespace fleetmap::structure
