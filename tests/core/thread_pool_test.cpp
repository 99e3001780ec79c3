#include "fleetmap/core/thread_pool.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

namespace fleetmap {
namespace {

TEST(ThreadPool, DoesAllWorkWithAnyNumberOfThreads) {
  for (const unsigned threads : {0u, 1u, 3u}) {
    std::atomic<int> sum = 0;
    {
      ThreadPool pool(threads);
      for (int k = 1; k <= 100; ++k) pool.run([&sum, k] { sum += k; });
    }
    EXPECT_EQ(sum, 5050) << threads;
  }
}

TEST(ThreadPool, TheFutureHoldsWhatTheWorkThrew) {
  for (const unsigned threads : {0u, 1u}) {
    ThreadPool pool(threads);
    auto failed = pool.run([] { throw std::runtime_error("no"); });
    EXPECT_THROW(failed.get(), std::runtime_error);
    EXPECT_NO_THROW(pool.run([] {}).get());
  }
}

TEST(ThreadPool, WithoutThreadsTheWorkIsDoneWhenRunReturns) {
  ThreadPool pool(0);
  bool done = false;
  pool.run([&] { done = true; });
  EXPECT_TRUE(done);
}

}  // namespace
}  // namespace fleetmap
