#include "dds_link.hpp"

#include <atomic>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <stdexcept>
#include <utility>

#include "fleetmap/bus/shared_memory.hpp"
#include "inbox.hpp"
#include "participant_qos.hpp"
#include "raw_type.hpp"

namespace fleetmap::bus {
namespace {

namespace dds = eprosima::fastdds::dds;
using eprosima::fastrtps::rtps::GuidPrefix_t;
using eprosima::fastrtps::rtps::iHandle2GUID;
using eprosima::fastrtps::rtps::InstanceHandle_t;
using ReturnCode = eprosima::fastrtps::types::ReturnCode_t;

/// Whose counterparts count, and who is told when their number changes.
struct Owner {
  Link link;
  GuidPrefix_t self;
  std::shared_ptr<Executor> executor;

  /// On radios a robot does not hear itself, though its own reader and writer of a topic match.
  bool ignores(const GuidPrefix_t& other) const { return link != Link::kOnboard && other == self; }
  void wake() const {
    executor->post([] {});
  }
};

}  // namespace

class DdsLink::WriterListener final : public dds::DataWriterListener {
 public:
  explicit WriterListener(Owner owner) : owner_(std::move(owner)) {}
  void on_publication_matched(dds::DataWriter*, const dds::PublicationMatchedStatus& status) override {
    if (owner_.ignores(iHandle2GUID(status.last_subscription_handle).guidPrefix)) return;
    matched_ += status.current_count_change;
    owner_.wake();
  }
  std::size_t matched() const { return static_cast<std::size_t>(std::max(0, matched_.load())); }

 private:
  const Owner owner_;
  std::atomic<int> matched_ = 0;
};

/// Runs on Fast DDS's threads: only moves samples into the inbox and tells the callback thread.
class DdsLink::ReaderListener final : public dds::DataReaderListener {
 public:
  ReaderListener(Owner owner, const DdsLinkConfig& config, std::function<void()> dispatch)
      : inbox(config.queue_messages, config.queue_bytes),
        owner_(std::move(owner)),
        dispatch_(std::move(dispatch)) {}

  void on_data_available(dds::DataReader* reader) override {
    Bytes cdr;
    dds::SampleInfo info;
    while (reader->take_next_sample(&cdr, &info) == ReturnCode::RETCODE_OK) {
      if (!info.valid_data || owner_.ignores(info.sample_identity.writer_guid().guidPrefix)) continue;
      inbox.put(std::move(cdr));
      owner_.executor->post(dispatch_);
      cdr = Bytes();
    }
  }
  void on_subscription_matched(dds::DataReader*, const dds::SubscriptionMatchedStatus& status) override {
    if (owner_.ignores(iHandle2GUID(status.last_publication_handle).guidPrefix)) return;
    matched_ += status.current_count_change;
    owner_.wake();
  }
  std::size_t matched() const { return static_cast<std::size_t>(std::max(0, matched_.load())); }
  void forget_matches() { matched_ = 0; }

  Inbox inbox;

 private:
  const Owner owner_;
  const std::function<void()> dispatch_;
  std::atomic<int> matched_ = 0;
};

DdsLink::DdsLink(Link link, const DdsLinkConfig& config, QosFile qos, std::shared_ptr<Executor> executor)
    : link_(link), config_(config), qos_(std::move(qos)), executor_(std::move(executor)) {}

Result<std::shared_ptr<DdsLink>> DdsLink::create(Link link, const DdsLinkConfig& config, const AgentId& agent,
                                                 QosFile qos, std::shared_ptr<Executor> executor) {
  if (auto status = check_address(config, to_string(link)); !status) return tl::unexpected(status.error());
  std::shared_ptr<DdsLink> result(new DdsLink(link, config, std::move(qos), std::move(executor)));
  auto* factory = dds::DomainParticipantFactory::get_instance();
  dds::DomainParticipantQos participant_qos;
  const std::string profile = result->qos_.registered(to_string(link));
  if (factory->get_participant_qos_from_profile(profile, participant_qos) != ReturnCode::RETCODE_OK) {
    return failure(result->qos_.path.string() + ": Fast DDS does not know the participant profile \"" +
                   to_string(link) + "\" after loading it; its log says why");
  }
  apply(config, link, agent, participant_qos);
  if (const std::size_t bytes = shared_memory_bytes(participant_qos); bytes > 0) {
    remove_dead_segments();
    if (const Status room = check_room(bytes); !room) {
      leave_out_shared_memory(participant_qos);
      result->warning_ = std::string(to_string(link)) +
                         ": without shared memory, so UDP may lose large clouds: " + room.error().message;
    }
  }
  result->participant_ =
      factory->create_participant(config.domain, participant_qos, nullptr, dds::StatusMask::none());
  if (!result->participant_) {
    return failure(
        std::string(to_string(link)) + ": cannot join DDS domain " + std::to_string(config.domain) + " on " +
        (config.address.empty() ? "the default interface" : config.address) + "; its log says why");
  }
  result->publisher_ = result->participant_->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
  result->subscriber_ = result->participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
  if (!result->publisher_ || !result->subscriber_) {
    return failure(std::string(to_string(link)) +
                   ": Fast DDS is out of resources for a publisher and subscriber");
  }
  return result;
}

DdsLink::~DdsLink() {
  if (!participant_) return;
  participant_->delete_contained_entities();
  dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
}

DdsLink::End& DdsLink::end_of(const Topic& topic) {
  const auto [entry, fresh] = ends_.try_emplace(topic.name);
  End& end = entry->second;
  if (!fresh) {
    if (end.topic.type == topic.type && end.topic.profile == topic.profile) return end;
    throw std::logic_error("topic " + topic.name + " is used with two types or profiles");
  }
  if (!qos_.profiles.contains(topic.profile)) {
    ends_.erase(entry);
    throw std::logic_error(qos_.path.string() + ": topic " + topic.name + " needs a <data_writer> and a " +
                           "<data_reader> profile \"" + topic.profile + "\"; add them");
  }
  end.topic = topic;
  dds::TypeSupport(new RawType(topic.type)).register_type(participant_);
  end.dds_topic = participant_->create_topic(topic.name, topic.type, dds::TOPIC_QOS_DEFAULT);
  if (!end.dds_topic)
    throw std::logic_error("Fast DDS refuses the topic " + topic.name + " of type " + topic.type);
  return end;
}

void DdsLink::open_writer(End& end) {
  if (end.writer) return;
  dds::DataWriterQos qos;
  publisher_->get_datawriter_qos_from_profile(qos_.registered(end.topic.profile), qos);
  end.writer_listener =
      std::make_unique<WriterListener>(Owner{link_, participant_->guid().guidPrefix, executor_});
  end.writer = publisher_->create_datawriter(end.dds_topic, qos, end.writer_listener.get(),
                                             dds::StatusMask::publication_matched());
  if (end.writer) return;
  throw std::logic_error(qos_.path.string() + ": Fast DDS refuses the data writer profile \"" +
                         end.topic.profile + "\" (policies that contradict each other; its log says which)");
}

void DdsLink::open_reader(End& end) {
  if (end.reader) return;
  dds::DataReaderQos qos;
  subscriber_->get_datareader_qos_from_profile(qos_.registered(end.topic.profile), qos);
  if (!end.reader_listener) {
    auto dispatch = [link = weak_from_this(), name = end.topic.name] {
      if (const auto alive = link.lock()) alive->dispatch(name);
    };
    end.reader_listener = std::make_unique<ReaderListener>(
        Owner{link_, participant_->guid().guidPrefix, executor_}, config_, std::move(dispatch));
  }
  end.reader = subscriber_->create_datareader(end.dds_topic, qos, end.reader_listener.get(),
                                              dds::StatusMask::subscription_matched()
                                                  << dds::StatusMask::data_available());
  if (end.reader) return;
  throw std::logic_error(qos_.path.string() + ": Fast DDS refuses the data reader profile \"" +
                         end.topic.profile + "\" (policies that contradict each other; its log says which)");
}

void DdsLink::advertise(const Topic& topic) {
  const std::scoped_lock lock(mutex_);
  open_writer(end_of(topic));
}

void DdsLink::publish(const Topic& topic, const Bytes& cdr) {
  const std::scoped_lock lock(mutex_);
  End& end = end_of(topic);
  open_writer(end);
  ++end.sent_messages;
  end.sent_bytes += cdr.size();
  // Fast DDS only reads the sample, though its signature does not say so.
  if (end.writer->write(const_cast<Bytes*>(&cdr), InstanceHandle_t()) != ReturnCode::RETCODE_OK)
    ++end.refused;
}

Handle DdsLink::subscribe(const Topic& topic, Bus::OnMessage on_message) {
  auto subscription = std::make_shared<Subscription>(Subscription{std::move(on_message)});
  const std::scoped_lock lock(mutex_);
  End& end = end_of(topic);
  end.subscriptions.push_back(subscription);
  open_reader(end);
  return Handle([link = weak_from_this(), name = topic.name, subscription] {
    subscription->active = false;
    if (const auto alive = link.lock()) alive->cancel(name, subscription);
  });
}

void DdsLink::cancel(const std::string& topic, const std::shared_ptr<Subscription>& subscription) {
  const std::scoped_lock lock(mutex_);
  End& end = ends_.at(topic);
  std::erase(end.subscriptions, subscription);
  if (!end.subscriptions.empty() || !end.reader) return;
  subscriber_->delete_datareader(end.reader);
  end.reader = nullptr;
  end.reader_listener->forget_matches();
}

void DdsLink::dispatch(const std::string& topic) {
  std::vector<std::shared_ptr<Subscription>> subscriptions;
  std::optional<Bytes> cdr;
  {
    const std::scoped_lock lock(mutex_);
    End& end = ends_.at(topic);
    subscriptions = end.subscriptions;  // a callback may subscribe or cancel
    cdr = end.reader_listener->inbox.take();
  }
  if (!cdr) return;
  for (const auto& subscription : subscriptions) {
    if (subscription->active) subscription->on_message(*cdr);
  }
}

DdsBus::Matches DdsLink::matches(const Topic& topic) const {
  const std::scoped_lock lock(mutex_);
  const auto entry = ends_.find(topic.name);
  if (entry == ends_.end()) return {};
  const End& end = entry->second;
  return {end.writer ? end.writer_listener->matched() : 0, end.reader ? end.reader_listener->matched() : 0};
}

void DdsLink::add_stats(std::vector<TopicStats>& all) const {
  const std::scoped_lock lock(mutex_);
  for (const auto& [name, end] : ends_) {
    TopicStats stats;
    stats.topic = name;
    stats.link = link_;
    stats.sent_messages = end.sent_messages;
    stats.sent_bytes = end.sent_bytes;
    stats.dropped_messages = end.refused;
    if (end.reader_listener) end.reader_listener->inbox.add_to(stats);
    all.push_back(std::move(stats));
  }
}

}  // namespace fleetmap::bus
