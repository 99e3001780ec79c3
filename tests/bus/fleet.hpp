#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <memory>
#include <ostream>
#include <utility>

#include "fleetmap/bus/bus.hpp"

namespace fleetmap::bus::testing {

/// After which a test that waits for robots fails.
inline constexpr auto kPatience = std::chrono::seconds(60);

struct FleetConfig {
  std::size_t robots = 2;
  std::size_t queue_capacity =
      256;  ///< where this kind of bus bounds radio messages: sender's or receiver's queue
};

/// Some robots, whatever their bus, and a way to let things happen.
class Fleet {
 public:
  virtual ~Fleet() = default;
  virtual Bus& robot(std::size_t index) = 0;
  /// Lets all robots run until `done()`; false if that does not come within a generous time.
  virtual bool run_until(const std::function<bool()>& done) = 0;
  /// Waits until robot `from` sends `topic` to `readers` ends and robot `to` hears it from `writers`.
  virtual bool connect(const Topic& topic, std::size_t from, std::size_t readers, std::size_t to,
                       std::size_t writers) = 0;
};

struct FleetKind {
  const char* name;
  std::unique_ptr<Fleet> (*make)(const FleetConfig&);
};
inline void PrintTo(const FleetKind& kind, std::ostream* out) { *out << kind.name; }

std::unique_ptr<Fleet> make_local_fleet(const FleetConfig& config);
std::unique_ptr<Fleet> make_dds_fleet(const FleetConfig& config);

/// A message as tests see it: printed as its size and first bytes.
struct Message {
  Bytes cdr;
  bool operator==(const Message&) const = default;
};
inline void PrintTo(const Message& message, std::ostream* out) {
  *out << message.cdr.size() << " bytes, seed " << (message.cdr.size() > 4 ? int{message.cdr[4]} : -1);
}

/// A CDR message: little-endian header, then `size` bytes that depend on `seed`.
inline Message message(std::size_t size, std::uint8_t seed) {
  Bytes cdr = {0x00, 0x01, 0x00, 0x00};
  cdr.reserve(cdr.size() + size);
  for (std::size_t i = 0; i < size; ++i) cdr.push_back(static_cast<std::uint8_t>(seed + i * 31 + (i >> 8)));
  return {std::move(cdr)};
}

}  // namespace fleetmap::bus::testing
