#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bag_topics.hpp"
#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::recording {

/// A message as it lies in a bag.
struct BagMessage {
  std::string topic;  ///< its ROS 2 name
  std::int64_t received_ns = 0;
  ByteView cdr;  ///< valid until the next message is read
};

/// One file of a bag, whose messages come in the order in which they were received.
class BagFile {
 public:
  virtual ~BagFile() = default;
  virtual Result<std::vector<BagTopic>> topics() = 0;
  /// Empty at the end, and after an error.
  virtual Result<std::optional<BagMessage>> next() = 0;
  /// Parts of the file that could not be read and were left out, so far.
  virtual std::uint64_t damaged_parts() const { return 0; }
  /// The first of these and its cause, with the file's name; empty if there is none.
  virtual std::string damage() const { return {}; }
};

/// Opens a .db3, .mcap or (ROS 1) .bag file; one with .zstd behind its name is unpacked into the folder for
/// temporary files, where it has no name, so that nothing is left of it whatever becomes of the program.
Result<std::unique_ptr<BagFile>> open_bag_file(const std::filesystem::path& file);

}  // namespace fleetmap::recording
