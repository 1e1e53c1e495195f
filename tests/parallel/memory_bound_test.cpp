// Memory that threads share: what is done at any time, in turn, and not at all.
#include "parallel/memory_bound.h"

#include <gtest/gtest.h>

namespace tenebra {
namespace {

struct Counted {
  int done = 0, released = 0;
};
Counted run(parallel::MemoryBound& bound, std::size_t bytes) {
  Counted counted;
  bound.run(
      bytes, [&] { ++counted.done; }, [&] { ++counted.released; });
  return counted;
}

TEST(MemoryBound, DoesAllWithoutABound) {
  parallel::MemoryBound bound;
  bound.begin(std::nullopt, 4);
  EXPECT_EQ(run(bound, std::size_t{1} << 60).done, 1);
  EXPECT_EQ(bound.least_bound(), 0u);
}

TEST(MemoryBound, GivesBackTheBuffersOfLargeWorkAlone) {
  parallel::MemoryBound bound;
  bound.begin(3200, 4);  // an eighth of it for four: 100 each
  EXPECT_EQ(run(bound, 100).released, 0);
  const Counted large = run(bound, 101);
  EXPECT_EQ(large.done, 1);
  EXPECT_EQ(large.released, 1);
}

TEST(MemoryBound, RefusesMoreThanThreeQuartersAndSaysWhatIsEnough) {
  parallel::MemoryBound bound;
  bound.begin(3200, 1);
  EXPECT_EQ(run(bound, 2400).done, 1);
  EXPECT_EQ(run(bound, 3001).done, 0);
  EXPECT_EQ(run(bound, 2700).done, 0);
  EXPECT_EQ(run(bound, 1).done, 0) << "the frame is lost";
  const std::size_t enough = bound.least_bound();
  EXPECT_GE(enough, 4001u);
  bound.begin(enough, 1);
  EXPECT_EQ(run(bound, 3001).done, 1);
}

}  // namespace
}  // namespace tenebra
