#pragma once

#include <concepts>
#include <functional>
#include <string>
#include <utility>

namespace fleetmap::bus {

/// A callback, and its name in the log while it blocks its thread. Any callable converts to one without a
/// name.
struct Work {
  std::string name;
  std::function<void()> run;

  Work(std::string name, std::function<void()> run) : name(std::move(name)), run(std::move(run)) {}
  template <std::invocable Callback>
  Work(Callback callback) : run(std::move(callback)) {}
};

}  // namespace fleetmap::bus
