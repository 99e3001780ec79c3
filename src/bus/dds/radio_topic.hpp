#pragma once

#include <fastdds/rtps/RTPSDomain.h>
#include <fastdds/rtps/builtin/data/WriterProxyData.h>

#include <memory>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "radio_hellos.hpp"
#include "radio_link.hpp"
#include "radio_received.hpp"
#include "rtps_messages.hpp"

namespace fleetmap::bus {

/// This robot's end of one topic: a best-effort writer to its readers, and a place in the link's data reader.
class RadioLink::End final : public TopicEnd {
 public:
  End(RadioLink& link, const Topic& topic, std::shared_ptr<Inbox> inbox)
      : link_(link), topic_(topic), key_(key_of(topic)), inbox_(std::move(inbox)) {
    const auto [other, fresh] = link_.ends_.emplace(key_, this);
    if (!fresh) {
      throw std::logic_error("topics " + topic.name + " and " + other->second->topic_.name +
                             " have the same entity id; give that robot another name");
    }
  }
  ~End() override { link_.ends_.erase(key_); }

  void open_writer() override {
    if (writer_ != nullptr || link_.participant_ == nullptr)
      return;  // else with the first message after it joins
    const WriterPolicy policy = writer_policy(link_.qos_, topic_.profile);
    depth_ = policy.depth;
    auto attributes = best_effort<eprosima::fastrtps::rtps::WriterAttributes>();
    attributes.mode = policy.synchronous ? eprosima::fastrtps::rtps::SYNCHRONOUS_WRITER
                                         : eprosima::fastrtps::rtps::ASYNCHRONOUS_WRITER;
    history_ = std::make_unique<eprosima::fastrtps::rtps::WriterHistory>(unbounded_history());
    writer_ = eprosima::fastrtps::rtps::RTPSDomain::createRTPSWriter(
        link_.participant_, writer_id(key_), attributes, link_.payloads_, history_.get());
    if (writer_ == nullptr) throw std::logic_error("Fast DDS makes no writer of " + topic_.name);
    for (const auto& [robot, peer] : link_.peers_) meet(robot, peer);
  }
  void open_reader() override {
    if (link_.reads_.contains(key_)) return;
    {
      const std::scoped_lock lock(link_.received_->mutex);
      link_.received_->topics.insert_or_assign(key_, Received::Topic{inbox_, link_.dispatcher(topic_.name)});
    }
    link_.reads_.insert(key_);
    for (const auto& [robot, peer] : link_.peers_) hear(robot);
    link_.hellos_->reads_changed();
  }
  void close_reader() override {
    if (!link_.reads_.contains(key_)) return;
    {
      const std::scoped_lock lock(link_.received_->mutex);
      link_.received_->topics.erase(key_);
    }
    link_.reads_.erase(key_);
    for (const auto& [robot, peer] : link_.peers_) unhear(robot);
    link_.hellos_->reads_changed();
  }
  bool write(const Bytes& cdr) override {
    const auto now = Clock::now();
    bool anyone = false;
    for (auto& [robot, peer] : link_.peers_) {
      if (!peer.reads.contains(key_)) continue;
      peer.last_sent = now;
      anyone = true;
    }
    return !anyone || send(*writer_, *history_, cdr, depth_);
  }
  DdsBus::Matches matches() const override {
    DdsBus::Matches result;
    for (const auto& [robot, peer] : link_.peers_) result.readers += peer.reads.contains(key_);
    if (writer_ == nullptr) result.readers = 0;
    if (link_.reads_.contains(key_)) result.writers = link_.peers_.size();
    return result;
  }

  /// The key of this topic of `robot`, if it is this robot's own; else that of this topic, which is
  /// everybody's.
  EntityKey key_of_robot(const AgentId& robot) const {
    const std::string own = "/" + link_.agent_.str();
    if (!topic_.name.ends_with(own)) return key_;
    Topic theirs = topic_;
    theirs.name.replace(theirs.name.size() - own.size(), own.size(), "/" + robot.str());
    return key_of(theirs);
  }

  /// Sends to `robot` if it reads this topic, else no more.
  void meet(const Prefix& robot, const Peer& peer) {
    if (writer_ == nullptr) return;
    if (peer.reads.contains(key_)) {
      writer_->matched_reader_add(link_.reader_of(robot, peer));
    } else {
      part(robot);
    }
  }
  /// Hears `robot` on this topic.
  void hear(const Prefix& robot) {
    if (!link_.reads_.contains(key_)) return;
    eprosima::fastrtps::rtps::WriterProxyData data(0, 0);
    data.guid(writer_of(robot));
    data.topicKind(eprosima::fastrtps::rtps::NO_KEY);
    link_.data_reader_->matched_writer_add(data);
  }
  void forget(const Prefix& robot) {
    part(robot);
    unhear(robot);
  }

 private:
  void part(const Prefix& robot) {
    if (writer_ != nullptr) writer_->matched_reader_remove({robot, data_reader_id()});
  }
  void unhear(const Prefix& robot) { link_.data_reader_->matched_writer_remove(writer_of(robot)); }
  eprosima::fastrtps::rtps::EntityId_t data_reader_id() const {
    return link_.data_reader_->getGuid().entityId;
  }
  eprosima::fastrtps::rtps::GUID_t writer_of(const Prefix& robot) const { return {robot, writer_id(key_)}; }

  RadioLink& link_;
  const Topic topic_;
  const EntityKey key_;
  const std::shared_ptr<Inbox> inbox_;
  std::size_t depth_ = 1;
  std::unique_ptr<eprosima::fastrtps::rtps::WriterHistory> history_;
  eprosima::fastrtps::rtps::RTPSWriter* writer_ = nullptr;
};

}  // namespace fleetmap::bus
