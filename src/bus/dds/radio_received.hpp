#pragma once

#include <fastdds/rtps/reader/ReaderListener.h>

#include <algorithm>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "fleetmap/bus/wire_overhead.hpp"
#include "inbox.hpp"
#include "radio_link.hpp"
#include "rtps_messages.hpp"

namespace fleetmap::bus {

/// Data from Fast DDS's threads for the callback thread. Its lock is never held while Fast DDS is called.
struct RadioLink::Received {
  static constexpr std::size_t kMaxHellos = 256;  ///< that wait for the callback thread
  struct Topic {
    std::shared_ptr<Inbox> inbox;
    Work dispatch;
  };
  struct Robot {
    Clock::time_point heard;
    std::map<EntityKey, std::uint64_t> numbers;  ///< of the last message of each of its writers
    HeardTraffic traffic;  ///< since the last call of take_heard_traffic(); `delay` is their sum
  };
  std::mutex mutex;
  std::map<EntityKey, Topic> topics;
  std::map<Prefix, Robot> robots;
  std::deque<std::pair<Prefix, Bytes>> hellos;
};

class RadioLink::HelloListener final : public eprosima::fastrtps::rtps::ReaderListener {
 public:
  explicit HelloListener(std::shared_ptr<Received> received) : received_(std::move(received)) {}
  void onNewCacheChangeAdded(eprosima::fastrtps::rtps::RTPSReader* reader,
                             const eprosima::fastrtps::rtps::CacheChange_t* change) override {
    const Prefix sender = change->writerGUID.guidPrefix;
    std::optional<Bytes> cdr = taken(*reader, change);
    if (!cdr) return;
    const std::scoped_lock lock(received_->mutex);
    if (received_->hellos.size() < Received::kMaxHellos)
      received_->hellos.emplace_back(sender, *std::move(cdr));
  }

 private:
  const std::shared_ptr<Received> received_;
};

class RadioLink::DataListener final : public eprosima::fastrtps::rtps::ReaderListener {
 public:
  /// `seal`: bytes that it adds to a datagram.
  DataListener(std::shared_ptr<Received> received, std::shared_ptr<Executor> executor, std::size_t seal)
      : received_(std::move(received)), executor_(std::move(executor)), overhead_{.seal = seal} {}
  void onNewCacheChangeAdded(eprosima::fastrtps::rtps::RTPSReader* reader,
                             const eprosima::fastrtps::rtps::CacheChange_t* change) override {
    const eprosima::fastrtps::rtps::GUID_t writer = change->writerGUID;
    const std::uint64_t number = change->sequenceNumber.to64long();
    const std::optional<Duration> delay = since(change->sourceTimestamp);
    std::optional<Bytes> cdr = taken(*reader, change);
    if (!cdr) return;
    std::optional<Work> dispatch;
    {
      const std::scoped_lock lock(received_->mutex);
      Received::Robot& robot = received_->robots[writer.guidPrefix];
      robot.heard = Clock::now();
      count(robot, key_of(writer.entityId), number, cdr->size(), delay);
      const auto topic = received_->topics.find(key_of(writer.entityId));
      if (topic == received_->topics.end()) return;
      if (!topic->second.inbox->put(*std::move(cdr), sender_of(writer))) return;
      dispatch = topic->second.dispatch;
    }
    executor_->post(*std::move(dispatch));
  }

 private:
  static Inbox::Sender sender_of(const eprosima::fastrtps::rtps::GUID_t& writer) {
    Inbox::Sender sender{};
    std::copy_n(writer.guidPrefix.value, sender.size(), sender.begin());
    return sender;
  }
  void count(Received::Robot& robot, EntityKey writer, std::uint64_t number, std::size_t payload,
             std::optional<Duration> delay) const {
    const auto [last, first] = robot.numbers.try_emplace(writer, number);
    if (!first && number > last->second) robot.traffic.lost += number - last->second - 1;
    last->second = std::max(last->second, number);
    ++robot.traffic.messages;
    robot.traffic.bytes += wire_bytes(payload, overhead_);
    if (!delay) return;
    robot.traffic.delay += *delay;
    ++robot.traffic.timed;
  }

  const std::shared_ptr<Received> received_;
  const std::shared_ptr<Executor> executor_;
  const WireOverhead overhead_;
};

}  // namespace fleetmap::bus
