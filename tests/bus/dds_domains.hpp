#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cstdint>
#include <string>

namespace fleetmap::bus::testing {

/// First of six DDS domains (two radios and four robots) that no other test has while this process lives:
/// whoever holds the lock of a file has them, and the kernel gives it back however the process ends. They
/// stay below 100, where the ports are below those that the kernel hands out.
inline std::uint32_t first_test_domain() {
  constexpr std::uint32_t kGroups = 16;
  static const std::uint32_t mine = [] {
    const auto try_lock = [](std::uint32_t group, int how) {
      const std::string file = "/tmp/fleetmap-test-domains-" + std::to_string(group);
      const int fd = open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
      if (fd >= 0 && flock(fd, how) == 0) return true;  // open, so locked, to the end of the process
      close(fd);
      return false;
    };
    for (std::uint32_t group = 0; group < kGroups; ++group) {
      if (try_lock(group, LOCK_EX | LOCK_NB)) return group;
    }
    try_lock(0, LOCK_EX);  // all taken: wait for one
    return 0U;
  }();
  return 2 + 6 * mine;
}

}  // namespace fleetmap::bus::testing
