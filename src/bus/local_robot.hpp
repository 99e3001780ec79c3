#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "event_queue.hpp"
#include "fleetmap/bus/bus.hpp"
#include "fleetmap/core/ids.hpp"

namespace fleetmap::bus {

/// A robot's Bus in virtual time.
class LocalRobot final : public Bus {
 public:
  using Transmit = std::function<void(const Topic& topic, std::shared_ptr<const Bytes> cdr)>;

  LocalRobot(EventQueue& events, std::size_t onboard_queue_capacity, Transmit transmit);

  Stamp now() const override;
  void publish(const Topic& topic, const Bytes& cdr) override;
  [[nodiscard]] Handle subscribe(const Topic& topic, OnMessage on_message) override;
  [[nodiscard]] Handle every(Duration period, std::function<void()> callback) override;
  void offload(Lane lane, std::function<void()> work, std::function<void()> done) override;
  std::vector<TopicStats> stats() const override;

  bool subscribes(const Topic& topic) const;
  /// From a link: runs the subscribers' callbacks now.
  void deliver(const Topic& topic, const std::shared_ptr<const Bytes>& cdr);
  void count_drop(const Topic& topic);

 private:
  struct Subscriber {
    OnMessage on_message;
    bool active = true;
  };
  struct TopicState {
    Topic topic;
    TopicStats stats;
    std::vector<std::shared_ptr<Subscriber>> subscribers;
    std::size_t pending = 0;  ///< onboard deliveries scheduled
    std::size_t skip = 0;     ///< of those, the oldest that gave way
  };
  struct Timer {
    Duration period;
    std::function<void()> callback;
    bool active = true;
  };
  /// What handles and events may outlive the robot with.
  struct State {
    std::map<std::pair<Link, std::string>, TopicState> topics;
  };

  static void schedule(EventQueue& events, const std::shared_ptr<Timer>& timer,
                       const std::weak_ptr<State>& owner, Stamp stamp);
  TopicState& state_of(const Topic& topic);
  void publish_onboard(TopicState& topic, std::shared_ptr<const Bytes> cdr);
  static void run_subscribers(TopicState& topic, const Bytes& cdr);

  EventQueue& events_;
  std::size_t onboard_queue_capacity_;
  Transmit transmit_;
  std::shared_ptr<State> state_ = std::make_shared<State>();
};

}  // namespace fleetmap::bus
