#pragma once

#include <fstream>
#include <iterator>

#include "fleetmap/core/bytes.hpp"
#include "support/file_content.hpp"

namespace fleetmap::testing {

/// Eight messages as MAVLink v1, v2 and signed v2, written by node-mavlink (mavlink_golden/make_golden.mjs).
inline Bytes golden_mavlink() {
  return file_bytes(FLEETMAP_SOURCE_DIR "/tests/sensor/mavlink_golden/frames.bin");
}

}  // namespace fleetmap::testing
