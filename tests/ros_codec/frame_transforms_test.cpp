#include "fleetmap/ros_codec/frame_transforms.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "fleetmap/ros_codec/samples.hpp"

namespace fleetmap::ros_codec {
namespace {

std::vector<sensor::FrameTransform> robot() {
  return {{"base_link", "mast", {0.1, -0.2, 0.5}, Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5)},
          {"mast", "velodyne", {0.0, 0.0, 0.3}, Eigen::Quaterniond(0.0, 0.0, 0.0, 0.0)}};
}

TEST(FrameTransforms, ComeBackAsTheyWereSentWhateverTheirValues) {
  const auto sent = robot();
  const auto received = decode_transforms(encode(sent));
  ASSERT_TRUE(received) << received.error().message;
  ASSERT_EQ(received->size(), sent.size());
  for (std::size_t k = 0; k < sent.size(); ++k) {
    EXPECT_EQ((*received)[k].parent, sent[k].parent);
    EXPECT_EQ((*received)[k].child, sent[k].child);
    EXPECT_EQ((*received)[k].translation, sent[k].translation);
    EXPECT_EQ((*received)[k].rotation.coeffs(), sent[k].rotation.coeffs());
  }
}

TEST(FrameTransforms, ACutMessageIsRefused) {
  const Bytes whole = encode(robot());
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(decode_transforms(ByteView(whole).first(size))) << size;
}

TEST(FrameTransforms, TheFrameOfAMessageIsReadWithoutTheRest) {
  EXPECT_EQ(frame_id_of(encode(sensor::Scan{}, "velodyne")), "velodyne");
  EXPECT_EQ(frame_id_of(encode(sensor::Imu{}, "")), "");
  const Bytes fix = encode(sensor::Fix{}, "gps_antenna");
  constexpr std::size_t kHeader = 4 + 8 + 4 + 12;
  EXPECT_EQ(frame_id_of(ByteView(fix).first(kHeader)), "gps_antenna");
  for (std::size_t size = 0; size < kHeader; ++size)
    EXPECT_FALSE(frame_id_of(ByteView(fix).first(size))) << size;
  const Bytes big_endian{0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 3, 'o', 's', 0};
  EXPECT_EQ(frame_id_of(big_endian), "os");
}

}  // namespace
}  // namespace fleetmap::ros_codec
