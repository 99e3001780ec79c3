#include "onboard_link.hpp"

#include <atomic>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <stdexcept>
#include <utility>

#include "participant_qos.hpp"
#include "raw_type.hpp"
#include "shared_memory.hpp"

namespace fleetmap::bus {
namespace {

namespace dds = eprosima::fastdds::dds;
using eprosima::fastrtps::rtps::InstanceHandle_t;
using ReturnCode = eprosima::fastrtps::types::ReturnCode_t;

class WriterListener final : public dds::DataWriterListener {
 public:
  explicit WriterListener(std::shared_ptr<Executor> executor) : executor_(std::move(executor)) {}
  void on_publication_matched(dds::DataWriter*, const dds::PublicationMatchedStatus& status) override {
    matched_ += status.current_count_change;
    executor_->wake();  // a call of matches() may wait for it
  }
  std::size_t matched() const { return static_cast<std::size_t>(std::max(0, matched_.load())); }

 private:
  const std::shared_ptr<Executor> executor_;
  std::atomic<int> matched_ = 0;
};

/// Runs on Fast DDS's threads: only moves samples into the inbox and wakes the callback thread.
class ReaderListener final : public dds::DataReaderListener {
 public:
  ReaderListener(std::shared_ptr<Executor> executor, std::shared_ptr<Inbox> inbox, Work dispatch)
      : executor_(std::move(executor)), inbox_(std::move(inbox)), dispatch_(std::move(dispatch)) {}

  void on_data_available(dds::DataReader* reader) override {
    Bytes cdr;
    dds::SampleInfo info;
    while (reader->take_next_sample(&cdr, &info) == ReturnCode::RETCODE_OK) {
      if (!info.valid_data) continue;
      if (inbox_->put(std::move(cdr))) executor_->post(dispatch_);
      cdr = Bytes();
    }
  }
  void on_subscription_matched(dds::DataReader*, const dds::SubscriptionMatchedStatus& status) override {
    matched_ += status.current_count_change;
    executor_->wake();
  }
  std::size_t matched() const { return static_cast<std::size_t>(std::max(0, matched_.load())); }
  void forget_matches() { matched_ = 0; }

 private:
  const std::shared_ptr<Executor> executor_;
  const std::shared_ptr<Inbox> inbox_;
  const Work dispatch_;
  std::atomic<int> matched_ = 0;
};

}  // namespace

class OnboardLink::End final : public TopicEnd {
 public:
  End(OnboardLink& link, const Topic& topic, const std::shared_ptr<Inbox>& inbox)
      : link_(link),
        profile_(topic.profile),
        writer_listener_(link.executor_),
        reader_listener_(link.executor_, inbox, link.dispatcher(topic.name)) {
    dds::TypeSupport(new RawType(topic.type)).register_type(link.participant_);
    topic_ = link.participant_->create_topic(topic.name, topic.type, dds::TOPIC_QOS_DEFAULT);
    if (!topic_)
      throw std::logic_error("Fast DDS refuses the topic " + topic.name + " of type " + topic.type);
  }

  void open_writer() override {
    if (writer_) return;
    dds::DataWriterQos qos;
    link_.publisher_->get_datawriter_qos_from_profile(link_.qos_.registered(profile_), qos);
    writer_ = link_.publisher_->create_datawriter(topic_, qos, &writer_listener_,
                                                  dds::StatusMask::publication_matched());
    if (!writer_) refuse("writer");
  }
  void open_reader() override {
    if (reader_) return;
    dds::DataReaderQos qos;
    link_.subscriber_->get_datareader_qos_from_profile(link_.qos_.registered(profile_), qos);
    reader_ = link_.subscriber_->create_datareader(topic_, qos, &reader_listener_,
                                                   dds::StatusMask::subscription_matched()
                                                       << dds::StatusMask::data_available());
    if (!reader_) refuse("reader");
  }
  void close_reader() override {
    if (!reader_) return;
    link_.subscriber_->delete_datareader(reader_);
    reader_ = nullptr;
    reader_listener_.forget_matches();
  }
  bool write(const Bytes& cdr) override {
    // Fast DDS only reads the sample, though its signature takes it as mutable.
    return writer_->write(const_cast<Bytes*>(&cdr), InstanceHandle_t()) == ReturnCode::RETCODE_OK;
  }
  DdsBus::Matches matches() const override {
    return {writer_ ? writer_listener_.matched() : 0, reader_ ? reader_listener_.matched() : 0};
  }

 private:
  [[noreturn]] void refuse(const char* what) const {
    throw std::logic_error(link_.qos_.path.string() + ": Fast DDS refuses the data " + what + " profile \"" +
                           profile_ + "\" (policies that contradict each other; its log says which)");
  }

  OnboardLink& link_;
  const std::string profile_;
  dds::Topic* topic_ = nullptr;
  dds::DataWriter* writer_ = nullptr;
  dds::DataReader* reader_ = nullptr;
  WriterListener writer_listener_;
  ReaderListener reader_listener_;
};

OnboardLink::OnboardLink(const DdsLinkConfig& config, QosFile qos, std::shared_ptr<Executor> executor)
    : LinkEnd(Link::kOnboard, config, std::move(executor)), qos_(std::move(qos)) {}

Result<std::shared_ptr<LinkEnd>> OnboardLink::create(const DdsLinkConfig& config, const AgentId& agent,
                                                     QosFile qos, std::shared_ptr<Executor> executor) {
  const std::string name = to_string(Link::kOnboard);
  if (auto status = check_address(config, name); !status) return tl::unexpected(status.error());
  std::shared_ptr<OnboardLink> result(new OnboardLink(config, std::move(qos), std::move(executor)));
  auto participant_qos = participant_profile(result->qos_, Link::kOnboard);
  if (!participant_qos) return tl::unexpected(participant_qos.error());
  apply_onboard(config, agent, *participant_qos);
  if (const std::size_t bytes = shared_memory_bytes(*participant_qos); bytes > 0) {
    remove_dead_segments();
    if (const Status room = check_room(bytes); !room) {
      leave_out_shared_memory(*participant_qos);
      result->warning_ =
          name + ": without shared memory, so UDP may lose large clouds: " + room.error().message;
    }
  }
  auto* factory = dds::DomainParticipantFactory::get_instance();
  result->participant_ =
      factory->create_participant(config.domain, *participant_qos, nullptr, dds::StatusMask::none());
  if (!result->participant_) {
    return failure(name + ": cannot join DDS domain " + std::to_string(config.domain) + " on " +
                   (config.address.empty() ? "the default interface" : config.address) +
                   "; its log says why");
  }
  result->publisher_ = result->participant_->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
  result->subscriber_ = result->participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
  if (!result->publisher_ || !result->subscriber_)
    return failure(name + ": Fast DDS is out of resources for a publisher and subscriber");
  return std::shared_ptr<LinkEnd>(std::move(result));
}

OnboardLink::~OnboardLink() {
  if (!participant_) return;
  participant_->delete_contained_entities();
  dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  forget_topics();
}

std::unique_ptr<LinkEnd::TopicEnd> OnboardLink::make(const Topic& topic,
                                                     const std::shared_ptr<Inbox>& inbox) {
  check_profile(qos_, topic);
  return std::make_unique<End>(*this, topic, inbox);
}

}  // namespace fleetmap::bus
