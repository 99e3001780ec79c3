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
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  const TemporaryFolder folder_;
  int exit_code_ = -1;
  std::string output_;  ///< of the last run, both streams
};

}  // namespace fleetmap::testing
