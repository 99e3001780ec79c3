#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/recording/bag_format.hpp"

namespace fleetmap::recording {

/// A topic of a bag that is written, by its ROS 2 names.
struct WrittenTopic {
  std::string name;
  std::string type;
  std::string offered_qos;  ///< YAML
};

/// The one file into which a bag is written. Errors name the file.
class StorageFile {
 public:
  virtual ~StorageFile() = default;
  /// Topics are numbered in the order in which they are added, from 0.
  virtual Status add_topic(const WrittenTopic& topic) = 0;
  virtual Status write(std::size_t topic, std::int64_t received_ns, ByteView cdr) = 0;
  /// Hands all that was written to the operating system: it survives the process, and can be read.
  virtual Status flush() = 0;
  virtual Status close() = 0;
};

}  // namespace fleetmap::recording
