#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "executor.hpp"
#include "fleetmap/bus/dds_bus.hpp"
#include "inbox.hpp"

namespace fleetmap::bus {

/// This robot's end of one link: its topics, their subscribers and the traffic.
class LinkEnd : public std::enable_shared_from_this<LinkEnd> {
 public:
  virtual ~LinkEnd() = default;
  LinkEnd(const LinkEnd&) = delete;
  LinkEnd& operator=(const LinkEnd&) = delete;

  void advertise(const Topic& topic);
  void publish(const Topic& topic, const Bytes& cdr);
  Handle subscribe(const Topic& topic, Bus::OnMessage on_message);
  DdsBus::Matches matches(const Topic& topic) const;
  void add_stats(std::vector<TopicStats>& all) const;
  /// Appends the traffic of each robot since the last call. Only radios distinguish robots.
  virtual void take_heard_traffic(std::vector<HeardTraffic>&) {}
  /// B on the wire of this end's own, so far. Only radios have such.
  virtual std::uint64_t discovery_bytes() const { return 0; }
  /// The sender of the message that is being dispatched; on the callback thread.
  const std::optional<AgentId>& sender() const { return sender_; }
  /// The robots that a radio heard.
  virtual RadioSurvey survey() const { return {}; }
  /// Features of the profile that this machine lacks; empty if it has all.
  const std::string& warning() const { return warning_; }

 protected:
  /// One topic. Opened and closed under the link's lock.
  class TopicEnd {
   public:
    virtual ~TopicEnd() = default;
    virtual void open_writer() = 0;
    virtual void open_reader() = 0;
    virtual void close_reader() = 0;
    /// False: refused.
    virtual bool write(const Bytes& cdr) = 0;
    virtual DdsBus::Matches matches() const = 0;
  };

  LinkEnd(Link link, const DdsLinkConfig& config, std::shared_ptr<Executor> executor);
  /// Throws std::logic_error for a topic that the link's profiles lack.
  virtual std::unique_ptr<TopicEnd> make(const Topic& topic, const std::shared_ptr<Inbox>& inbox) = 0;
  /// The robot to which the participant belongs. Empty onboard.
  virtual std::optional<AgentId> robot_of(const Inbox::Sender&) const { return std::nullopt; }
  /// A message of `topic` lies in its inbox. From any thread; takes no lock.
  Work dispatcher(const std::string& topic);

  const Link link_;
  const DdsLinkConfig config_;
  const std::shared_ptr<Executor> executor_;
  std::string warning_;
  mutable std::mutex mutex_;  ///< guards the topics; what runs on Fast DDS's threads never takes it

  /// Before the entities that they hold are deleted.
  void forget_topics();

 private:
  struct Subscription {
    Bus::OnMessage on_message;
    bool active = true;  ///< callback thread only
  };
  struct Entry {
    Topic topic;
    std::shared_ptr<Inbox> inbox;  ///< stays when the reader goes: it holds the counters
    std::unique_ptr<TopicEnd> end;
    std::vector<std::shared_ptr<Subscription>> subscriptions;
    std::uint64_t sent_messages = 0;
    std::uint64_t sent_bytes = 0;
    std::uint64_t refused = 0;  ///< by the writer: its history is busy or full
  };
  Entry& entry_of(const Topic& topic);
  void dispatch(const std::string& topic);
  void cancel(const std::string& topic, const std::shared_ptr<Subscription>& subscription);

  std::map<std::string, Entry> topics_;
  std::optional<AgentId> sender_;  ///< callback thread only
};

}  // namespace fleetmap::bus
