#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/recording/bag_format.hpp"

namespace fleetmap::recording {

/// Writes a bag that rosbag2 reads: DIR/metadata.yaml of ROS 2 Humble, and DIR/<name of DIR>_0.mcap or .db3.
/// Messages are flushed once a second of recording time or every 4 MB, in MCAP as a chunk; a killed writer
/// leaves a bag that lacks the last of them and metadata.yaml, and that open() reads. One thread at a time.
class BagWriter {
 public:
  /// Makes `dir` if need be; refuses a folder that holds a bag already.
  static Result<BagWriter> create(const std::filesystem::path& dir, const BagFormat& format = {});
  BagWriter(BagWriter&&) noexcept;
  BagWriter& operator=(BagWriter&&) noexcept;
  ~BagWriter();  ///< close(), errors logged

  /// `topic` and `type` as DDS names ("rt/points", "sensor_msgs::msg::dds_::PointCloud2_") or ROS 2 names
  /// ("/points", "sensor_msgs/msg/PointCloud2"). `received` orders the messages of a bag. `offered`, of
  /// a topic's first message, is how `ros2 bag play` publishes the topic.
  Status write(std::string_view topic, std::string_view type, Stamp received, ByteView cdr,
               Durability offered = Durability::kVolatile);
  /// Commits what was written so far.
  Status flush();
  /// Commits, writes metadata.yaml and leaves one whole file. Nothing can be written afterwards.
  Status close();

 private:
  struct Impl;
  explicit BagWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace fleetmap::recording
