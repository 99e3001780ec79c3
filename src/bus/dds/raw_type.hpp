#pragma once

#include <fastdds/dds/topic/TopicDataType.hpp>
#include <string>

namespace fleetmap::bus {

/// A DDS type of any name whose samples are Bytes that are CDR already, encapsulation header included.
/// Keyless, as ROS 2's types are.
class RawType final : public eprosima::fastdds::dds::TopicDataType {
 public:
  explicit RawType(const std::string& type_name);

  bool serialize(void* data, eprosima::fastrtps::rtps::SerializedPayload_t* payload) override;
  bool deserialize(eprosima::fastrtps::rtps::SerializedPayload_t* payload, void* data) override;
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override;
  void* createData() override;
  void deleteData(void* data) override;
  bool getKey(void* data, eprosima::fastrtps::rtps::InstanceHandle_t* handle, bool force_md5) override;
};

}  // namespace fleetmap::bus
