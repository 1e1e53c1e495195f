#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "shadow/rays/direction_keys.h"
#include "shadow/rays/shadow_rays.h"
#include "support/seeded_random.h"

namespace tenebra {
namespace {

// The direction through cell (x, y) of the 2^14 x 2^14 grid on the cube's +Z face, in steps of 2^shift cells.
std::uint32_t key_of_cell(int x, int y, SimdLevel simd) {
  float dx[16], dy[16], dz[16];
  std::uint32_t keys[16];
  for (int i = 0; i < 16; ++i) {
    dx[i] = (static_cast<float>(x) + 0.5f) / 8192 - 1;
    dy[i] = (static_cast<float>(y) + 0.5f) / 8192 - 1;
    dz[i] = 1;
  }
  shadow::direction_keys_kernel(simd)(dx, dy, dz, keys);
  return keys[0];
}

constexpr SimdLevel levels[] = {SimdLevel::scalar, SimdLevel::sse4, SimdLevel::avx2, SimdLevel::avx512};

TEST(DirectionKeys, NeighboursAlongTheCurveAreNeighboursInTheGrid) {
  // The first 64 x 64 cells along the curve fill a square; each step moves by one cell.
  constexpr int side = 64;
  const std::uint32_t face = 4u << 28;
  for (const SimdLevel simd : levels) {
    if (!simd_level_supported(simd)) continue;
    std::vector<std::pair<int, int>> cells(side * side, {-1, -1});
    for (int x = 0; x < side; ++x) {
      for (int y = 0; y < side; ++y) {
        const std::uint32_t index = key_of_cell(x, y, simd) - face;
        ASSERT_LT(index, cells.size());
        ASSERT_EQ(cells[index].first, -1) << "cell taken twice";
        cells[index] = {x, y};
      }
    }
    for (std::size_t i = 1; i < cells.size(); ++i) {
      ASSERT_EQ(
          std::abs(cells[i].first - cells[i - 1].first) + std::abs(cells[i].second - cells[i - 1].second), 1)
          << i;
    }
    EXPECT_EQ(key_of_cell(0, 0, simd), face);
    EXPECT_EQ(key_of_cell((1 << 14) - 1, 0, simd), face + (1u << 28) - 1);
  }
}

TEST(DirectionKeys, NameTheCubeFace) {
  const float x[16] = {2, -2, 1, 1, 1, 1, 3, 0, 0}, y[16] = {1, 1, 2, -2, 1, 1, 3, 0, 1},
              z[16] = {1, 1, 1, 1, 2, -2, 3, 1, 0};
  const std::uint32_t faces[] = {0, 1, 2, 3, 4, 5, 0, 4, 2};
  std::uint32_t keys[16];
  for (const SimdLevel simd : levels) {
    if (!simd_level_supported(simd)) continue;
    shadow::direction_keys_kernel(simd)(x, y, z, keys);
    for (int i = 0; i < 9; ++i) EXPECT_EQ(keys[i] >> 28, faces[i]) << i << ' ' << simd_level_name(simd);
  }
}

TEST(RadixSort, EqualsAStableSortByKey) {
  testing::Random random(3);
  for (const std::size_t size : {0, 1, 2, 1000, 200000}) {
    std::vector<std::uint64_t> keys(size);
    for (auto& key : keys) key = (random.bits() % 5000) << 41 | (random.bits() & 0xffffffffu);
    std::vector<std::uint64_t> expected = keys;
    std::stable_sort(expected.begin(), expected.end(), [](auto a, auto b) { return a >> 32 < b >> 32; });
    shadow::RayKeys scratch;
    shadow::radix_sort(keys, scratch);
    EXPECT_EQ(keys, expected) << size;
  }
}

}  // namespace
}  // namespace tenebra
