#include "parallel/job_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <new>
#include <vector>

#include "base/fail.h"

namespace tenebra {
namespace {

TEST(JobQueue, DoesJobsInOrderAndFinishWaits) {
  std::vector<int> done;
  parallel::JobQueue queue(2);
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(queue.add([&done, i]() -> Expected<void> {
      done.push_back(i);
      return {};
    }));
  }
  ASSERT_TRUE(queue.finish());
  ASSERT_EQ(done.size(), 100u);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(done[static_cast<std::size_t>(i)], i);
}

TEST(JobQueue, HoldsNoMoreJobsThanItMay) {
  std::atomic<int> added{0}, begun{0}, most{0};
  parallel::JobQueue queue(2);
  for (int i = 0; i < 50; ++i) {
    ASSERT_TRUE(queue.add([&]() -> Expected<void> {
      ++begun;
      return {};
    }));
    ++added;
    most = std::max(most.load(), added - begun);
  }
  ASSERT_TRUE(queue.finish());
  EXPECT_LE(most, 3) << "two wait, one is about to begin";
}

TEST(JobQueue, TheFirstFailureIsToldAndWhatFollowsIsDropped) {
  std::atomic<int> done{0};
  parallel::JobQueue queue(4);
  ASSERT_TRUE(queue.add([]() -> Expected<void> { return base::fail("disk full"); }));
  Expected<void> added;
  for (int i = 0; i < 1000 && added; ++i) {
    added = queue.add([&done]() -> Expected<void> {
      ++done;
      return base::fail("never seen");
    });
  }
  const auto finished = queue.finish();
  ASSERT_FALSE(finished);
  EXPECT_EQ(finished.error().message, "disk full");
  EXPECT_EQ(done, 0);
}

TEST(JobQueue, AJobWithoutMemoryHasFailed) {
  parallel::JobQueue queue(1);
  ASSERT_TRUE(queue.add([]() -> Expected<void> { throw std::bad_alloc(); }));
  EXPECT_THROW(static_cast<void>(queue.finish()), std::bad_alloc);
}

TEST(JobQueue, EndsWithWhatWasAddedDone) {
  std::atomic<int> done{0};
  {
    parallel::JobQueue queue(8);
    for (int i = 0; i < 8; ++i) {
      ASSERT_TRUE(queue.add([&done]() -> Expected<void> {
        ++done;
        return {};
      }));
    }
  }
  EXPECT_EQ(done, 8);
}

}  // namespace
}  // namespace tenebra
