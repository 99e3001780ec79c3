#pragma once

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

namespace fleetmap::testing {

/// Permissions of a file.
inline mode_t mode_of(const std::filesystem::path& file) {
  struct stat status {};
  EXPECT_EQ(stat(file.c_str(), &status), 0) << file;
  return status.st_mode & 0777;
}

}  // namespace fleetmap::testing
