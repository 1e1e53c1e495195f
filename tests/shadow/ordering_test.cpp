#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "shadow/shadow_rays.h"
#include "support/random.h"

namespace tenebra {
namespace {

TEST(HilbertIndex, NeighboursAlongTheCurveAreNeighboursInTheGrid) {
  // The first 128 x 128 cells along the curve fill a square; each step moves by one cell.
  constexpr std::uint32_t side = 128;
  std::vector<std::pair<int, int>> cells(side * side, {-1, -1});
  for (std::uint32_t x = 0; x < side; ++x) {
    for (std::uint32_t y = 0; y < side; ++y) {
      const std::uint32_t index = hilbert_index(x, y);
      ASSERT_LT(index, cells.size());
      ASSERT_EQ(cells[index].first, -1) << "cell taken twice";
      cells[index] = {static_cast<int>(x), static_cast<int>(y)};
    }
  }
  for (std::size_t i = 1; i < cells.size(); ++i) {
    ASSERT_EQ(std::abs(cells[i].first - cells[i - 1].first) + std::abs(cells[i].second - cells[i - 1].second), 1) << i;
  }
}

TEST(HilbertIndex, UsesTheWholeGrid) {
  const std::uint32_t last = (1u << 14) - 1;
  EXPECT_EQ(hilbert_index(0, 0), 0u);
  EXPECT_EQ(hilbert_index(last, 0), (1u << 28) - 1);
}

TEST(RadixSort, EqualsAStableSortByKey) {
  test::Random random(3);
  for (const std::size_t size : {0, 1, 2, 1000, 200000}) {
    std::vector<std::uint64_t> keys(size);
    for (auto& key : keys) key = (random.bits() % 5000) << 41 | (random.bits() & 0xffffffffu);
    std::vector<std::uint64_t> expected = keys;
    std::stable_sort(expected.begin(), expected.end(), [](auto a, auto b) { return a >> 32 < b >> 32; });
    RayKeys scratch;
    radix_sort(keys, scratch);
    EXPECT_EQ(keys, expected) << size;
  }
}

}  // namespace
}  // namespace tenebra
