#include "base/until_stopped.h"

#include <gtest/gtest.h>

#include <numeric>

namespace tenebra::base {
namespace {

constexpr std::size_t many = 3 * look_after + 5;

TEST(UntilStopped, VisitsAllInOrder) {
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, look_after, many}) {
    std::vector<std::size_t> visited;
    const StopFlag stop;
    EXPECT_TRUE(each_until_stopped(2, 2 + count, &stop, [&](std::size_t i) { visited.push_back(i); }));
    std::vector<std::size_t> expected(count);
    std::iota(expected.begin(), expected.end(), 2);
    EXPECT_EQ(visited, expected);
  }
}

TEST(UntilStopped, EndsBeforeTheNextLook) {
  StopFlag stop;
  std::size_t visited = 0;
  EXPECT_FALSE(each_until_stopped(0, many, &stop, [&](std::size_t i) {
    if (i == look_after + 1) stop.request();
    ++visited;
  }));
  EXPECT_EQ(visited, 2 * look_after);
}

TEST(UntilStopped, ResizesAndCopiesWholeLists) {
  std::vector<int> values(many);
  std::iota(values.begin(), values.end(), 0);
  std::vector<int> copy{7, 7};
  EXPECT_TRUE(copy_until_stopped(std::span<const int>(values), copy, nullptr));
  EXPECT_EQ(copy, values);
  EXPECT_TRUE(resize_until_stopped(copy, many + look_after, nullptr));
  values.resize(many + look_after);
  EXPECT_EQ(copy, values);
  EXPECT_TRUE(resize_until_stopped(copy, 3, nullptr));
  EXPECT_EQ(copy, (std::vector<int>{0, 1, 2}));
}

TEST(UntilStopped, AStopLeavesListsUnfinished) {
  StopFlag stop;
  stop.request();
  const std::vector<int> values(many, 1);
  std::vector<int> list{7};
  EXPECT_FALSE(resize_until_stopped(list, many, &stop));
  EXPECT_EQ(list.size(), 1u);
  EXPECT_FALSE(copy_until_stopped(std::span<const int>(values), list, &stop));
  EXPECT_TRUE(list.empty());
}

}  // namespace
}  // namespace tenebra::base
