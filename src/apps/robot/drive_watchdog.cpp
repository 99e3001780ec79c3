#include "drive_watchdog.hpp"

#include <spdlog/spdlog.h>

#include <chrono>
#include <condition_variable>
#include <mutex>

#include "fleetmap/ros_codec/samples.hpp"
#include "fleetmap/ros_codec/topics.hpp"

namespace fleetmap::apps {
namespace {

constexpr Duration kPeriod = std::chrono::milliseconds(20);
constexpr Duration kPatience = std::chrono::milliseconds(200);

std::int64_t steady_ns() { return Duration(std::chrono::steady_clock::now().time_since_epoch()).count(); }

}  // namespace

DriveWatchdog::DriveWatchdog(bus::DdsBus& bus, const std::atomic<bool>& stop)
    : bus_(bus), stop_(stop), last_beat_(steady_ns()) {
  bus_.advertise(ros_codec::topics::cmd_vel());
  beat_ = bus_.every(kPeriod, {"drive watchdog", [this] { last_beat_ = steady_ns(); }});
  thread_ = std::jthread([this](const std::stop_token& end) { run(end); });
}

bool DriveWatchdog::stalled() const { return steady_ns() - last_beat_ > kPatience.count(); }

void DriveWatchdog::run(const std::stop_token& end) {
  const Bytes zero = ros_codec::encode(ros_codec::VelocityCommand{});
  std::mutex mutex;
  std::condition_variable_any ended;
  std::unique_lock lock(mutex);
  bool was_stalled = false;
  while (!ended.wait_for(lock, end, kPeriod, [&] { return end.stop_requested(); })) {
    const bool is_stalled = stalled();
    const bool ending = stop_ || driving_stopped_;
    if (is_stalled && !was_stalled && !ending)
      spdlog::warn("the robot stands still: the program was busy for more than {:.1f} s",
                   to_seconds(kPatience));
    was_stalled = is_stalled;
    if (is_stalled || ending) bus_.publish(ros_codec::topics::cmd_vel(), zero);
  }
}

}  // namespace fleetmap::apps
