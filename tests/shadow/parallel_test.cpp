// Tasks that free threads take in order.
#include "parallel/parallel.h"

#include <gtest/gtest.h>

#include <mutex>
#include <vector>

namespace tenebra {
namespace {

TEST(Parallel, InOrderCallsEachOnceAndOnOneThreadInOrder) {
  for (const int threads : {1, 2, 5}) {
    for (const int count : {0, 1, 3, 400}) {
      std::vector<int> begun;
      std::mutex mutex;
      with_threads(threads, [&] {
        parallel::parallel_in_order(count, [&](int i) {
          const std::lock_guard lock(mutex);
          begun.push_back(i);
        });
      });
      ASSERT_EQ(begun.size(), static_cast<std::size_t>(count));
      std::vector<bool> seen(begun.size(), false);
      for (std::size_t k = 0; k < begun.size(); ++k) {
        const auto i = static_cast<std::size_t>(begun[k]);
        EXPECT_FALSE(seen[i]) << i;
        seen[i] = true;
        if (threads == 1) {
          EXPECT_EQ(i, k);
        }
      }
    }
  }
}

}  // namespace
}  // namespace tenebra
