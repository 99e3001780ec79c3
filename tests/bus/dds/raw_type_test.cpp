#include "bus/dds/raw_type.hpp"

#include <gtest/gtest.h>

#include "fleetmap/core/bytes.hpp"

namespace fleetmap::bus {
namespace {

using eprosima::fastrtps::rtps::InstanceHandle_t;
using eprosima::fastrtps::rtps::SerializedPayload_t;

TEST(RawType, HasTheNameOfTheIdlTypeAndNoKey) {
  RawType type("sensor_msgs::msg::dds_::Imu_");
  EXPECT_STREQ(type.getName(), "sensor_msgs::msg::dds_::Imu_");
  EXPECT_FALSE(type.m_isGetKeyDefined);
  Bytes sample{0, 1, 0, 0, 5};
  InstanceHandle_t handle;
  EXPECT_FALSE(type.getKey(&sample, &handle, false));
}

TEST(RawType, CarriesBytesThatAreCdrAlready) {
  RawType type("T");
  Bytes sent{0, 1, 0, 0, 5, 6, 7};
  EXPECT_EQ(type.getSerializedSizeProvider(&sent)(), 8u) << "padded to 4";
  SerializedPayload_t payload(type.getSerializedSizeProvider(&sent)());
  ASSERT_TRUE(type.serialize(&sent, &payload));
  void* sample = type.createData();
  ASSERT_TRUE(type.deserialize(&payload, sample));
  EXPECT_EQ(*static_cast<Bytes*>(sample), sent);
  payload.length = 2;
  EXPECT_FALSE(type.deserialize(&payload, sample));
  type.deleteData(sample);
  SerializedPayload_t small(4);
  EXPECT_FALSE(type.serialize(&sent, &small));
}

}  // namespace
}  // namespace fleetmap::bus
