#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace fleetmap::testing {

/// A folder of one test, or of all tests of a suite, gone with its object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    const auto& tests = *::testing::UnitTest::GetInstance();
    std::string name = std::string("fleetmap_") + tests.current_test_suite()->name() + "_";
    if (const auto* test = tests.current_test_info()) name += std::string(test->name()) + "_";
    path_ = std::filesystem::temp_directory_path() / (name + std::to_string(getpid()));
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path write(const std::filesystem::path& name, const std::string& content) const {
    const auto file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << content;
    return file;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace fleetmap::testing
