#pragma once

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <memory>
#include <string>

#include "fleetmap/core/ids.hpp"
#include "link_end.hpp"
#include "qos_file.hpp"

namespace fleetmap::bus {

/// The domain of a robot's sensors and state: one DDS participant, found by ROS 2 nodes through DDS
/// discovery.
class OnboardLink final : public LinkEnd {
 public:
  static Result<std::shared_ptr<LinkEnd>> create(const DdsLinkConfig& config, const AgentId& agent,
                                                 QosFile qos, std::shared_ptr<Executor> executor);
  ~OnboardLink() override;

 private:
  class End;
  OnboardLink(const DdsLinkConfig& config, QosFile qos, std::shared_ptr<Executor> executor);
  std::unique_ptr<TopicEnd> make(const Topic& topic, const std::shared_ptr<Inbox>& inbox) override;

  const QosFile qos_;
  eprosima::fastdds::dds::DomainParticipant* participant_ = nullptr;
  eprosima::fastdds::dds::Publisher* publisher_ = nullptr;
  eprosima::fastdds::dds::Subscriber* subscriber_ = nullptr;
};

}  // namespace fleetmap::bus
