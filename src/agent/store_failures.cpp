#include "fleetmap/agent/store_failures.hpp"

#include <spdlog/spdlog.h>

#include <chrono>
#include <utility>

namespace fleetmap::agent {
namespace {

constexpr Duration kPause = std::chrono::seconds(30);

}  // namespace

StoreFailures::StoreFailures(std::string agent, std::string store)
    : agent_(std::move(agent)), store_(std::move(store)), log_(kPause) {}

void StoreFailures::on_failure(const Error& error, std::uint64_t added, Stamp now) {
  added_before_failure_ = added;
  if (!log_.on_failure(now)) return;
  spdlog::error(
      "{}: {}; until it works nothing new is kept, and this is not said again; what others have is "
      "fetched then",
      agent_, error.message);
}

void StoreFailures::check(std::uint64_t added) {
  if (!log_.failing() || added == added_before_failure_) return;
  if (const std::uint64_t failures = log_.on_success(); failures > 0)
    spdlog::warn("{}: {} works again; {} writes were refused", agent_, store_, failures);
}

}  // namespace fleetmap::agent
