#pragma once

#include <array>
#include <deque>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "event_queue.hpp"
#include "fleetmap/bus/bus.hpp"
#include "fleetmap/bus/local_network.hpp"
#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/thread_pool.hpp"

namespace fleetmap::bus {

/// A robot's Bus in virtual time.
class LocalRobot final : public Bus {
 public:
  using Transmit = std::function<void(const Topic& topic, std::shared_ptr<const Bytes> cdr)>;

  LocalRobot(EventQueue& events, ThreadPool& pool, const LocalNetworkConfig& config, Transmit transmit);
  ~LocalRobot() override;

  Stamp now() const override;
  void publish(const Topic& topic, const Bytes& cdr) override;
  [[nodiscard]] Handle subscribe(const Topic& topic, OnMessage on_message) override;
  std::optional<AgentId> sender() const override { return state_->sender; }
  [[nodiscard]] Handle every(Duration period, Work callback) override;
  bool offload(Lane lane, Work work, std::function<void()> done) override;
  std::vector<TopicStats> stats() const override;

  bool subscribes(const Topic& topic) const;
  /// From a link: runs the subscribers' callbacks now.
  void deliver(const AgentId& from, const Topic& topic, const std::shared_ptr<const Bytes>& cdr);
  void count_drop(const Topic& topic);
  void finish_work();

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
    std::size_t skip = 0;     ///< the number of them, the oldest, that were dropped
  };
  struct Timer {
    Duration period;
    std::function<void()> callback;
    bool active = true;
  };
  struct WorkItem {
    std::function<void()> work;
    std::function<void()> done;
  };
  struct LaneState {
    Duration time{};
    std::deque<WorkItem> waiting;
    bool busy = false;
    std::future<void> under_way;
    std::uint64_t round = 0;  ///< counts finish_work(): what began before one is not followed up
  };
  /// State with which handles and events may outlive the robot.
  struct State {
    std::array<LaneState, 2> lanes;
    std::map<std::pair<Link, std::string>, TopicState> topics;
    std::optional<AgentId> sender;  ///< of the message that is delivered
  };

  static void schedule(EventQueue& events, const std::shared_ptr<Timer>& timer,
                       const std::weak_ptr<State>& owner, Stamp stamp);
  static void start_next(EventQueue& events, ThreadPool& pool, const std::shared_ptr<State>& state,
                         std::size_t lane);
  TopicState& state_of(const Topic& topic);
  void publish_onboard(TopicState& topic, std::shared_ptr<const Bytes> cdr);
  static void run_subscribers(TopicState& topic, const Bytes& cdr);

  EventQueue& events_;
  ThreadPool& pool_;
  std::size_t onboard_queue_capacity_;
  Transmit transmit_;
  std::shared_ptr<State> state_ = std::make_shared<State>();
};

}  // namespace fleetmap::bus
