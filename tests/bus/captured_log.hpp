#pragma once

#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>

namespace fleetmap::bus::testing {

/// All that is logged while it lives, by any thread.
class CapturedLog {
 public:
  CapturedLog() : before_(spdlog::default_logger()) {
    spdlog::set_default_logger(std::make_shared<spdlog::logger>("test", sink_));
  }
  ~CapturedLog() { spdlog::set_default_logger(before_); }
  std::string text() const { return sink_->text(); }
  int count(const std::string& what) const {
    int times = 0;
    const std::string all = text();
    for (auto at = all.find(what); at != std::string::npos; at = all.find(what, at + 1)) ++times;
    return times;
  }
  /// Blocks until `what` has been logged by another thread; false after a minute.
  bool wait_for(const std::string& what) const { return sink_->wait_for(what); }

 private:
  class TextSink final : public spdlog::sinks::base_sink<std::mutex> {
   public:
    std::string text() {
      const std::scoped_lock lock(mutex_);
      return text_;
    }
    bool wait_for(const std::string& what) {
      std::unique_lock lock(mutex_);
      return changed_.wait_for(lock, std::chrono::minutes(1),
                               [&] { return text_.find(what) != std::string::npos; });
    }

   private:
    void sink_it_(const spdlog::details::log_msg& message) override {
      spdlog::memory_buf_t line;
      formatter_->format(message, line);
      text_.append(line.data(), line.size());
      changed_.notify_all();
    }
    void flush_() override {}
    std::string text_;  ///< guarded by the sink's mutex
    std::condition_variable changed_;
  };

  std::shared_ptr<TextSink> sink_ = std::make_shared<TextSink>();
  std::shared_ptr<spdlog::logger> before_;
};

}  // namespace fleetmap::bus::testing
