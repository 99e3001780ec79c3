#pragma once

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "executor.hpp"
#include "fleetmap/bus/dds_bus.hpp"
#include "qos_file.hpp"

namespace fleetmap::bus {

/// One participant, and this robot's end of each of its topics.
class DdsLink : public std::enable_shared_from_this<DdsLink> {
 public:
  static Result<std::shared_ptr<DdsLink>> create(Link link, const DdsLinkConfig& config, const AgentId& agent,
                                                 QosFile qos, std::shared_ptr<Executor> executor);
  ~DdsLink();
  DdsLink(const DdsLink&) = delete;
  DdsLink& operator=(const DdsLink&) = delete;

  void advertise(const Topic& topic);
  void publish(const Topic& topic, const Bytes& cdr);
  Handle subscribe(const Topic& topic, Bus::OnMessage on_message);
  DdsBus::Matches matches(const Topic& topic) const;
  void add_stats(std::vector<TopicStats>& all) const;
  /// What the profile asks for and this machine has not; empty if all is there.
  const std::string& warning() const { return warning_; }

 private:
  class WriterListener;
  class ReaderListener;
  struct Subscription {
    Bus::OnMessage on_message;
    bool active = true;  ///< callback thread only
  };
  struct End {
    Topic topic;
    eprosima::fastdds::dds::Topic* dds_topic = nullptr;
    eprosima::fastdds::dds::DataWriter* writer = nullptr;
    eprosima::fastdds::dds::DataReader* reader = nullptr;
    std::unique_ptr<WriterListener> writer_listener;
    std::unique_ptr<ReaderListener> reader_listener;  ///< stays when the reader goes: it holds the counters
    std::vector<std::shared_ptr<Subscription>> subscriptions;
    std::uint64_t sent_messages = 0;
    std::uint64_t sent_bytes = 0;
    std::uint64_t refused = 0;  ///< by the writer: its history is busy or full
  };

  DdsLink(Link link, const DdsLinkConfig& config, QosFile qos, std::shared_ptr<Executor> executor);
  End& end_of(const Topic& topic);
  void open_writer(End& end);
  void open_reader(End& end);
  void dispatch(const std::string& topic);
  void cancel(const std::string& topic, const std::shared_ptr<Subscription>& subscription);

  const Link link_;
  const DdsLinkConfig config_;
  const QosFile qos_;
  const std::shared_ptr<Executor> executor_;
  std::string warning_;
  eprosima::fastdds::dds::DomainParticipant* participant_ = nullptr;
  eprosima::fastdds::dds::Publisher* publisher_ = nullptr;
  eprosima::fastdds::dds::Subscriber* subscriber_ = nullptr;
  mutable std::mutex mutex_;  ///< guards ends_; listeners never take it
  std::map<std::string, End> ends_;
};

}  // namespace fleetmap::bus
