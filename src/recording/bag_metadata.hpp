#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "fleetmap/core/result.hpp"

namespace fleetmap::recording {

/// The part of metadata.yaml that reading needs, and the whole of it for writing.
struct BagMetadata {
  struct Topic {
    std::string name;
    std::string type;
    std::uint64_t messages = 0;
    std::string offered_qos;  ///< YAML
  };
  std::string storage = "sqlite3";
  std::string compression_format;  ///< empty: none
  std::string compression_mode;    ///< FILE or MESSAGE
  std::vector<std::string> files;  ///< relative to the bag, in order of time
  std::vector<Topic> topics;
  std::int64_t first_ns = 0;  ///< received, since the Unix epoch
  std::int64_t last_ns = 0;
};

inline constexpr char kMetadataFile[] = "metadata.yaml";

Result<BagMetadata> read_metadata(const std::filesystem::path& bag);
/// Version 5, as of ROS 2 Humble; replaces the file as a whole.
Status write_metadata(const std::filesystem::path& bag, const BagMetadata& metadata);

}  // namespace fleetmap::recording
