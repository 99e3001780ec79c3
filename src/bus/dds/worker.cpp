#include "worker.hpp"

#include <utility>

namespace fleetmap::bus {

Worker::Worker(std::shared_ptr<Executor> executor, Duration stuck_after)
    : executor_(std::move(executor)),
      record_(std::make_shared<WorkRecord>(stuck_after)),
      thread_([this] { loop(); }) {}

Worker::~Worker() { finish(); }

void Worker::finish() {
  {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_one();
  if (thread_.joinable()) thread_.join();
}

bool Worker::add(Work work, std::function<void()> done) {
  {
    const std::scoped_lock lock(mutex_);
    if (items_.size() >= Bus::kMaxWork) return false;
    items_.push_back({std::move(work), std::move(done)});
  }
  changed_.notify_one();
  return true;
}

void Worker::loop() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stopping_ || !items_.empty(); });
    if (stopping_) return;
    Item item = std::move(items_.front());
    items_.pop_front();
    lock.unlock();
    record_->run(item.work);
    executor_->post({"what follows " + item.work.name, std::move(item.done)});
    lock.lock();
  }
}

}  // namespace fleetmap::bus
