#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::testing {

/// The program under test.
inline const std::string kProgram = FLEETMAP_BINARY_DIR "/bin/fleetmap";

/// A test that runs the program. Its files are in a folder of its own.
class CommandLineTest : public ::testing::Test {
 protected:
  /// `fleetmap ARGUMENTS...` until it ends.
  void run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), kProgram);
    Process process(arguments);
    exit_code_ = process.wait();
    output_ = process.output();
  }
  /// The program refuses the arguments: exit code 2, and `reason` in its words.
  void expect_usage_error(std::vector<std::string> arguments, const std::string& reason) {
    run(std::move(arguments));
    EXPECT_EQ(exit_code_, 2) << reason << '\n' << output_;
    EXPECT_NE(output_.find(reason), std::string::npos) << "not \"" << reason << "\", but\n" << output_;
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  const TemporaryFolder folder_;
  int exit_code_ = -1;
  std::string output_;  ///< of the last run, both streams
};

}  // namespace fleetmap::testing
