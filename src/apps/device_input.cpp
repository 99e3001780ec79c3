#include "device_input.hpp"

#include <spdlog/spdlog.h>

#include <array>
#include <condition_variable>
#include <mutex>
#include <utility>

#include "fleetmap/core/utc.hpp"

namespace fleetmap::apps {
namespace {

constexpr auto kRetry = std::chrono::seconds(1);
constexpr Duration kRequestPeriod = std::chrono::seconds(1);
constexpr Duration kSilence = std::chrono::seconds(5);

/// Until the next try, or until the input ends.
void wait(const std::stop_token& stop) {
  std::mutex mutex;
  std::unique_lock lock(mutex);
  std::condition_variable_any().wait_for(lock, stop, kRetry, [] { return false; });
}

}  // namespace

DeviceInput::DeviceInput(agent::DevicePlace place, Handlers handlers)
    : place_(std::move(place)),
      handlers_(std::move(handlers)),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

void DeviceInput::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    auto stream = DeviceStream::open(place_);
    const Error error = stream ? serve(*stream, stop) : stream.error();
    if (stop.stop_requested()) return;
    say(error.message, "; tried again every second");
    wait(stop);
  }
}

Error DeviceInput::serve(DeviceStream& stream, const std::stop_token& stop) {
  const std::string name = to_string(place_);
  if (handlers_.greeting) {
    if (const Status sent = stream.write(handlers_.greeting()); !sent) return sent.error();
  }
  std::array<std::uint8_t, 4096> buffer{};
  const auto begun = std::chrono::steady_clock::now();
  auto heard = begun, asked = begun - kRequestPeriod;
  bool any = false;
  while (!stop.stop_requested()) {
    const auto size = stream.read(buffer);
    if (!size) return size.error();
    const auto moment = std::chrono::steady_clock::now();
    if (*size > 0) {
      if (!std::exchange(any, true) || moment - heard > kSilence) {
        spdlog::info("{}: heard", name);
        hear();
      }
      heard = moment;
      handlers_.on_bytes(ByteView(buffer).first(*size), system_now());
    } else if (moment - heard > kSilence) {
      say(name + ": sends nothing; check its power, its settings and the baud rate", "");
    }
    if (!handlers_.request || !any || moment - asked < kRequestPeriod) continue;
    asked = moment;
    if (const Status sent = stream.write(handlers_.request(system_now())); !sent) return sent.error();
  }
  return {};
}

void DeviceInput::say(const std::string& trouble, const char* then) {
  const std::scoped_lock lock(mutex_);
  if (trouble != std::exchange(trouble_, trouble)) spdlog::warn("{}{}", trouble, then);
}

void DeviceInput::hear() {
  const std::scoped_lock lock(mutex_);
  trouble_.clear();
}

std::string DeviceInput::trouble() const {
  const std::scoped_lock lock(mutex_);
  return trouble_;
}

}  // namespace fleetmap::apps
