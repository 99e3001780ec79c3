#include "bus/dds/worker.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <functional>
#include <future>
#include <vector>

#include "bus/deadlines.hpp"

namespace fleetmap::bus {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::kAtLast, testing::kAtOnce;

class WorkerTest : public ::testing::Test {
 protected:
  /// Keeps the worker's thread until release(), and returns once it is kept.
  void block() {
    std::promise<void> begun;
    ASSERT_TRUE(worker_.add({"block",
                             [this, &begun] {
                               begun.set_value();
                               gate_.get_future().wait();
                             }},
                            [this] { done_.push_back(0); }));
    begun.get_future().wait();
  }
  void release() { gate_.set_value(); }
  void run_done(std::size_t count) {
    while (done_.size() < count) ASSERT_TRUE(executor_->run_one(kAtLast));
  }

  std::shared_ptr<Executor> executor_ = std::make_shared<Executor>();
  std::promise<void> gate_;
  std::vector<int> worked_, done_;
  Worker worker_{executor_, 1h};
};

TEST_F(WorkerTest, DoesItemsInOrderAndWhatFollowsComesOnTheCallbackThread) {
  std::vector<std::thread::id> work_threads, done_threads;
  for (int k = 0; k < 5; ++k) {
    ASSERT_TRUE(worker_.add(
        [&, k] {
          worked_.push_back(k);
          work_threads.push_back(std::this_thread::get_id());
        },
        [&, k] {
          done_.push_back(k);
          done_threads.push_back(std::this_thread::get_id());
        }));
  }
  run_done(5);
  EXPECT_THAT(worked_, ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(done_, ElementsAre(0, 1, 2, 3, 4));
  for (const auto& thread : done_threads) EXPECT_EQ(thread, std::this_thread::get_id());
  for (const auto& thread : work_threads) {
    EXPECT_EQ(thread, work_threads[0]);
    EXPECT_NE(thread, std::this_thread::get_id());
  }
}

TEST_F(WorkerTest, FollowUpWorkHasTheNameOfItsWork) {
  std::string name;
  ASSERT_TRUE(worker_.add({"odometry", [] {}}, [&] {
    name = executor_->record()->take().under_way->name;
    done_.push_back(1);
  }));
  run_done(1);
  EXPECT_EQ(name, "what follows odometry");
}

TEST_F(WorkerTest, TakesNoMoreThanMayWaitAndThenAgain) {
  block();
  std::size_t taken = 0;
  for (std::size_t k = 0; k < Bus::kMaxWork + 10; ++k)
    taken += worker_.add([] {}, [this] { done_.push_back(1); });
  EXPECT_EQ(taken, Bus::kMaxWork) << "the one under way does not wait";
  release();
  run_done(1 + Bus::kMaxWork);
  EXPECT_TRUE(worker_.add([] {}, [] {}));
}

TEST_F(WorkerTest, FinishWaitsForTheItemUnderWayAndLetsTheOthersGo) {
  constexpr int kMany = 2'000'000;  // seconds of work
  std::atomic<int> worked = 0;
  std::promise<void> begun;
  const std::function<void()> again = [&] {
    if (++worked == 1) begun.set_value();
    if (worked < kMany) worker_.add(again, [] {});
  };
  ASSERT_TRUE(worker_.add(again, [] {}));
  begun.get_future().wait();
  worker_.finish();
  const int at_end = worked;
  EXPECT_LT(at_end, kMany);
  EXPECT_TRUE(worker_.add(again, [this] { done_.push_back(1); }));
  while (executor_->run_one(kAtOnce)) {
  }
  EXPECT_EQ(worked, at_end) << "the thread has ended";
  EXPECT_THAT(done_, IsEmpty());
}

}  // namespace
}  // namespace fleetmap::bus
