#include "fleetmap/ros_codec/ros1.hpp"

#include <cstdint>
#include <string>

#include "fleetmap/core/byte_fields.hpp"

namespace fleetmap::ros_codec {
namespace {

/// Both put little-endian fields one after the other. CDR aligns them, ends text with a zero, and its header
/// has no sequence number.
class Transcoder {
 public:
  explicit Transcoder(ByteView message) : in_(message) {}

  void numbers(std::size_t size, std::size_t count) {
    align(size);
    copy(in_.take(size * count));
  }
  void text() {
    const ByteView bytes = in_.counted();
    put_count(bytes.size() + 1);
    copy(bytes);
    out_.push_back(0);
  }
  void octets() {
    const ByteView bytes = in_.counted();
    put_count(bytes.size());
    copy(bytes);
  }
  /// The number of elements that follow.
  std::uint32_t count() {
    const auto count = in_.number<std::uint32_t>();
    put_count(count);
    return count;
  }
  void header() {
    in_.number<std::uint32_t>();  // sequence
    numbers(4, 2);                // s, ns
    text();                       // frame_id
  }
  bool more() const { return in_.whole(); }
  /// Empty if the message had another length.
  Bytes take() { return in_.whole() && in_.rest().empty() ? std::move(out_) : Bytes(); }

 private:
  static constexpr std::size_t kEncapsulation = 4;

  void align(std::size_t size) {
    while ((out_.size() - kEncapsulation) % size != 0) out_.push_back(0);
  }
  void copy(ByteView bytes) { out_.insert(out_.end(), bytes.begin(), bytes.end()); }
  void put_count(std::size_t count) {
    align(4);
    for (int k = 0; k < 4; ++k) out_.push_back(static_cast<std::uint8_t>(count >> (8 * k)));
  }

  ByteFields in_;
  Bytes out_{0, 1, 0, 0};  // CDR, little-endian
};

void point_cloud2(Transcoder& message) {
  message.header();
  message.numbers(4, 2);  // height, width
  const std::uint32_t fields = message.count();
  for (std::uint32_t k = 0; k < fields && message.more(); ++k) {
    message.text();         // name
    message.numbers(4, 1);  // offset
    message.numbers(1, 1);  // datatype
    message.numbers(4, 1);  // count
  }
  message.numbers(1, 1);  // is_bigendian
  message.numbers(4, 2);  // point_step, row_step
  message.octets();       // data
  message.numbers(1, 1);  // is_dense
}

void imu(Transcoder& message) {
  message.header();
  message.numbers(8,
                  4 + 9 + 3 + 9 + 3 + 9);  // orientation, rates and accelerations, each with its covariance
}

void nav_sat_fix(Transcoder& message) {
  message.header();
  message.numbers(1, 1);  // status
  message.numbers(2, 1);  // service
  message.numbers(8, 3 + 9);
  message.numbers(1, 1);  // type of the covariance
}

void odometry(Transcoder& message) {
  message.header();
  message.text();                       // child_frame_id
  message.numbers(8, 7 + 36 + 6 + 36);  // pose and twist, each with its covariance
}

void tf_message(Transcoder& message) {
  const std::uint32_t transforms = message.count();
  for (std::uint32_t k = 0; k < transforms && message.more(); ++k) {
    message.header();
    message.text();         // child_frame_id
    message.numbers(8, 7);  // translation and rotation
  }
}

void velodyne_scan(Transcoder& message) {
  message.header();
  const std::uint32_t packets = message.count();
  for (std::uint32_t k = 0; k < packets && message.more(); ++k) {
    message.numbers(4, 2);     // s, ns
    message.numbers(1, 1206);  // data
  }
}

void livox_points(Transcoder& message) {
  message.header();
  message.numbers(8, 1);  // timebase
  message.numbers(4, 1);  // point_num
  message.numbers(1, 4);  // lidar_id, rsvd
  const std::uint32_t points = message.count();
  for (std::uint32_t k = 0; k < points && message.more(); ++k) {
    message.numbers(4, 4);  // offset_time, x, y, z
    message.numbers(1, 3);  // reflectivity, tag, line
  }
}

}  // namespace

Result<Bytes> cdr_from_ros1(std::string_view type, ByteView message) {
  Transcoder transcoder(message);
  if (type == "sensor_msgs/msg/PointCloud2") {
    point_cloud2(transcoder);
  } else if (type == "sensor_msgs/msg/Imu") {
    imu(transcoder);
  } else if (type == "sensor_msgs/msg/NavSatFix") {
    nav_sat_fix(transcoder);
  } else if (type == "nav_msgs/msg/Odometry") {
    odometry(transcoder);
  } else if (type == "tf2_msgs/msg/TFMessage") {
    tf_message(transcoder);
  } else if (type == "velodyne_msgs/msg/VelodyneScan") {
    velodyne_scan(transcoder);
  } else if (type == "livox_ros_driver/msg/CustomMsg" || type == "livox_ros_driver2/msg/CustomMsg") {
    livox_points(transcoder);
  } else {
    return failure(std::string(type) + ": is not read from ROS 1");
  }
  Bytes cdr = transcoder.take();
  if (cdr.empty())
    return failure(std::string(type) + ": its " + std::to_string(message.size()) +
                   " bytes are no such message of ROS 1");
  return cdr;
}

}  // namespace fleetmap::ros_codec
