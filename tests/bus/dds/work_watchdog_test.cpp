// A real thread that blocks is noticed by another.
#include "bus/dds/work_watchdog.hpp"

#include <gtest/gtest.h>

#include <future>

#include "bus/captured_log.hpp"
#include "bus/dds/executor.hpp"
#include "bus/dds/worker.hpp"
#include "bus/dds_domains.hpp"
#include "fleetmap/bus/dds_bus.hpp"

namespace fleetmap::bus::testing {
namespace {

using namespace std::chrono_literals;

TEST(WorkWatchdog, NoticesAThreadThatIsBlocked) {
  const CapturedLog log;
  const auto record = std::make_shared<WorkRecord>(50ms);
  const WorkWatchdog watchdog("r1", {{"callback thread", record}}, 5ms);
  std::promise<void> may_go_on;
  std::thread watched([&, gate = may_go_on.get_future()] {
    record->run({"topic rt/points", [&] { gate.wait(); }});
  });
  EXPECT_TRUE(log.wait_for("s in topic rt/points"));
  EXPECT_EQ(log.count("r1: callback thread stuck for"), 1);
  EXPECT_EQ(watchdog.counters().at(0).times, 1u);
  may_go_on.set_value();
  watched.join();
  EXPECT_TRUE(log.wait_for("r1: callback thread goes on after"));
  EXPECT_EQ(log.count("stuck for"), 1);
  EXPECT_EQ(watchdog.counters().at(0).times, 1u);
  EXPECT_GE(watchdog.counters().at(0).longest, 50ms);
}

TEST(WorkWatchdog, WorkThatThrowsHasEnded) {
  WorkRecord record(1h);
  EXPECT_THROW(record.run({"bad work", [] { throw std::runtime_error("bug"); }}), std::runtime_error);
  EXPECT_FALSE(record.take().under_way);
}

/// A bus without any link.
class StuckBus : public ::testing::Test {
 protected:
  StuckBus() {
    DdsBusConfig config;
    config.agent = AgentId::parse("r1").value();
    config.qos_directory = FLEETMAP_SOURCE_DIR "/qos";
    config.onboard.domain = first_test_domain();
    config.long_range.enabled = config.short_range.enabled = false;
    bus_ = DdsBus::create(config).value();
  }
  /// In a callback: waits until the log tells that it is stuck.
  void block(const std::string& work) {
    noticed_ = log_.wait_for("s in " + work) && log_.count("r1: callback thread stuck for") > 0;
  }
  StallCounters callback_thread() const { return bus_->stalls().at(0); }

  CapturedLog log_;
  std::unique_ptr<DdsBus> bus_;
  bool noticed_ = false;
};

TEST_F(StuckBus, ACallbackOfATopicIsNamed) {
  const Topic topic{Link::kOnboard, "rt/points", "std_msgs::msg::dds_::String_", "sensor"};
  const Handle subscription = bus_->subscribe(topic, [&](const Bytes&) { block("topic rt/points"); });
  bus_->advertise(topic);
  ASSERT_TRUE(bus_->run_until([&] { return bus_->matches(topic).readers > 0; }, 1min));
  bus_->publish(topic, Bytes(16));
  ASSERT_TRUE(bus_->run_until([&] { return noticed_; }, 2min));
  EXPECT_GE(callback_thread().times, 1u);
  EXPECT_GE(callback_thread().longest, 2s);
}

TEST_F(StuckBus, ATimerIsNamedAndCounted) {
  const Handle timer = bus_->every(1ms, {"exchange", [&] { block("timer exchange"); }});
  ASSERT_TRUE(bus_->run_until([&] { return noticed_; }, 2min));
  EXPECT_EQ(callback_thread().thread, "callback thread");
  EXPECT_GE(callback_thread().times, 1u);
  EXPECT_GE(callback_thread().longest, 2s);
}

TEST(WorkWatchdog, SeesWhatExecutorAndWorkersDo) {
  const auto executor = std::make_shared<Executor>();
  Worker worker(executor, 1h);
  std::promise<std::string> name;
  ASSERT_TRUE(
      worker.add({"registration", [&] { name.set_value(worker.record()->take().under_way->name); }}, [] {}));
  EXPECT_EQ(name.get_future().get(), "registration");
  std::string after;
  executor->post([&] { after = executor->record()->take().under_way->name; });
  while (after.empty()) ASSERT_TRUE(executor->run_one(Executor::Clock::time_point::max()));
  EXPECT_EQ(after, "work without a name");
}

}  // namespace
}  // namespace fleetmap::bus::testing
