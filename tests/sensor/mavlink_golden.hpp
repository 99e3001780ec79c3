#pragma once

#include <fstream>
#include <iterator>

#include "fleetmap/core/bytes.hpp"

namespace fleetmap::testing {

/// Eight messages as MAVLink v1, v2 and signed v2, written by node-mavlink (mavlink_golden/make_golden.mjs).
inline Bytes golden_mavlink() {
  std::ifstream file(FLEETMAP_SOURCE_DIR "/tests/sensor/mavlink_golden/frames.bin", std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace fleetmap::testing
