#include "fleetmap/bus/dds_bus.hpp"

#include <fastrtps/xmlparser/XMLProfileManager.h>

#include <array>
#include <map>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "executor.hpp"
#include "fleetmap/core/utc.hpp"
#include "onboard_link.hpp"
#include "participant_qos.hpp"
#include "qos_file.hpp"
#include "radio_link.hpp"
#include "work_watchdog.hpp"
#include "worker.hpp"

namespace fleetmap::bus {
namespace {

constexpr auto kFlagPeriod = std::chrono::milliseconds(100);
/// A scan takes some ms, a registration seconds on a slow computer.
constexpr Duration kPerceptionStuckAfter = std::chrono::seconds(2);
constexpr Duration kBackgroundStuckAfter = std::chrono::seconds(20);

}  // namespace

const std::vector<std::string>& profiles_of(Link link) {
  static const std::vector<std::string> onboard = {"sensor", "state", "latched"};
  static const std::vector<std::string> long_range = {"small", "cloud"};
  static const std::vector<std::string> short_range = {"control", "bulk"};
  return link == Link::kOnboard ? onboard : link == Link::kLongRange ? long_range : short_range;
}

struct DdsBus::State {
  const Stamp begun = system_now();
  const Executor::Clock::time_point begun_steady = Executor::Clock::now();
  std::shared_ptr<Executor> executor = std::make_shared<Executor>();
  std::map<Link, std::shared_ptr<LinkEnd>> links;
  std::mutex disabled_mutex;  ///< guards disabled
  std::map<std::pair<Link, std::string>, TopicStats> disabled;
  Worker perception{executor, kPerceptionStuckAfter};
  Worker background{executor, kBackgroundStuckAfter};
  WorkWatchdog watchdog;

  explicit State(const AgentId& agent)
      : watchdog(agent.str(), {{"callback thread", executor->record()},
                               {"perception thread", perception.record()},
                               {"background thread", background.record()}}) {}

  LinkEnd* link(const Topic& topic) const {
    const auto entry = links.find(topic.link);
    return entry == links.end() ? nullptr : entry->second.get();
  }
};

Result<std::unique_ptr<DdsBus>> DdsBus::create(const DdsBusConfig& config) {
  if (auto status = config.validate(); !status) return tl::unexpected(status.error());
  // Buses of one process would else hand each other messages without a socket, by readers that may be gone.
  eprosima::fastrtps::LibrarySettingsAttributes settings;
  settings.intraprocess_delivery = eprosima::fastrtps::INTRAPROCESS_OFF;
  eprosima::fastrtps::xmlparser::XMLProfileManager::library_settings(settings);
  auto state = std::make_unique<State>(config.agent);
  for (const Link link : kLinks) {
    const DdsLinkConfig& own = config_of(config, link);
    if (!own.enabled) continue;
    auto qos = load_qos_file(config.qos_directory, link);
    if (!qos) return tl::unexpected(qos.error());
    auto made = link == Link::kOnboard
                    ? OnboardLink::create(own, config.agent, *std::move(qos), state->executor)
                    : RadioLink::create(link, config, *std::move(qos), state->executor);
    if (!made) return tl::unexpected(made.error());
    state->links[link] = *std::move(made);
  }
  return std::unique_ptr<DdsBus>(new DdsBus(std::move(state)));
}

DdsBus::DdsBus(std::unique_ptr<State> state) : state_(std::move(state)) {}
DdsBus::~DdsBus() = default;

Stamp DdsBus::now() const {
  return state_->begun + std::chrono::duration_cast<Duration>(Executor::Clock::now() - state_->begun_steady);
}

void DdsBus::advertise(const Topic& topic) {
  if (auto* link = state_->link(topic)) link->advertise(topic);
}

void DdsBus::publish(const Topic& topic, const Bytes& cdr) {
  if (auto* link = state_->link(topic)) {
    link->publish(topic, cdr);
    return;
  }
  const std::scoped_lock lock(state_->disabled_mutex);
  TopicStats& stats = state_->disabled[{topic.link, topic.name}];
  stats.topic = topic.name;
  stats.link = topic.link;
  ++stats.sent_messages;
  stats.sent_bytes += cdr.size();
  ++stats.dropped_messages;
}

Handle DdsBus::subscribe(const Topic& topic, OnMessage on_message) {
  auto* link = state_->link(topic);
  return link ? link->subscribe(topic, std::move(on_message)) : Handle();
}

std::optional<AgentId> DdsBus::sender() const {
  for (const auto& [link, end] : state_->links) {
    if (end->sender()) return end->sender();
  }
  return std::nullopt;
}

Handle DdsBus::every(Duration period, Work callback) {
  if (period <= Duration::zero()) throw std::logic_error("a timer's period must be > 0");
  return Handle(state_->executor->add_timer(period, std::move(callback)));
}

bool DdsBus::offload(Lane lane, Work work, std::function<void()> done) {
  Worker& worker = lane == Lane::kPerception ? state_->perception : state_->background;
  return worker.add(std::move(work), std::move(done));
}

void DdsBus::finish_work() {
  state_->perception.finish();
  state_->background.finish();
}

std::vector<std::string> DdsBus::warnings() const {
  std::vector<std::string> all;
  for (const auto& [name, link] : state_->links) {
    if (!link->warning().empty()) all.push_back(link->warning());
  }
  return all;
}

std::vector<StallCounters> DdsBus::stalls() const { return state_->watchdog.counters(); }

RadioSurvey DdsBus::survey(Link link) const {
  const auto entry = state_->links.find(link);
  return entry == state_->links.end() ? RadioSurvey{} : entry->second->survey();
}

std::vector<TopicStats> DdsBus::stats() const {
  std::vector<TopicStats> all;
  for (const auto& [link, made] : state_->links) made->add_stats(all);
  const std::scoped_lock lock(state_->disabled_mutex);
  for (const auto& [key, stats] : state_->disabled) all.push_back(stats);
  return all;
}

std::uint64_t DdsBus::discovery_bytes(Link link) const {
  const auto entry = state_->links.find(link);
  return entry == state_->links.end() ? 0 : entry->second->discovery_bytes();
}

std::vector<HeardTraffic> DdsBus::take_heard_traffic() {
  std::vector<HeardTraffic> all;
  for (const auto& [link, made] : state_->links) made->take_heard_traffic(all);
  return all;
}

bool DdsBus::post(Work callback) {
  if (callback.name.empty()) callback.name = "posted work";
  return state_->executor->try_post(std::move(callback));
}

void DdsBus::run() {
  while (!state_->executor->stopped()) state_->executor->run_one(Executor::Clock::time_point::max());
}

void DdsBus::run_until(const std::atomic<bool>& stop) {
  while (!stop && !state_->executor->stopped()) {
    state_->executor->run_one(Executor::Clock::now() + kFlagPeriod);
  }
}

bool DdsBus::run_until(const std::function<bool()>& done, Duration timeout) {
  const auto now = Executor::Clock::now();
  // now + Duration::max() would lie in the past.
  const auto deadline =
      timeout < Executor::Clock::time_point::max() - now ? now + timeout : Executor::Clock::time_point::max();
  while (!done()) {
    if (!state_->executor->run_one(deadline)) return done();
  }
  return true;
}

void DdsBus::stop() { state_->executor->stop(); }

DdsBus::Matches DdsBus::matches(const Topic& topic) const {
  const auto* link = state_->link(topic);
  return link ? link->matches(topic) : Matches{};
}

}  // namespace fleetmap::bus
