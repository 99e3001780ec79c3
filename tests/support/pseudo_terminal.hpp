#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <string>

#include "fleetmap/core/bytes.hpp"

namespace fleetmap::testing {

/// A serial port at whose other end is the test. Its device vanishes with it.
class PseudoTerminal {
 public:
  PseudoTerminal() : device_(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
    EXPECT_EQ(::grantpt(device_), 0);
    EXPECT_EQ(::unlockpt(device_), 0);
    std::array<char, 128> name{};
    EXPECT_EQ(::ptsname_r(device_, name.data(), name.size()), 0);
    path_ = name.data();
  }
  ~PseudoTerminal() { ::close(device_); }
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  const std::string& path() const { return path_; }
  /// False if nobody reads and the line is full.
  bool send(ByteView bytes) const {
    return ::write(device_, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size());
  }
  /// The bytes that the program sent since the last call.
  Bytes receive() const {
    Bytes bytes(4096);
    const ssize_t size = ::read(device_, bytes.data(), bytes.size());
    bytes.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
    return bytes;
  }
  speed_t speed() const {
    termios settings{};
    EXPECT_EQ(::tcgetattr(device_, &settings), 0);
    return ::cfgetospeed(&settings);
  }

 private:
  int device_;
  std::string path_;
};

}  // namespace fleetmap::testing
