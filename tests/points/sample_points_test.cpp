#include "points/sample_points.h"

#include <gtest/gtest.h>

#include <set>

#include "support/seeded_random.h"

namespace tenebra {
namespace {

using glm::vec3;

TEST(SamplePoints, AreThoseOfPixelsWhereTheyLieAtTheirCentres) {
  testing::Random random(11);
  const std::vector<vec3> corners{{-5, -5, 1}, {5, -5, 2}, {0, 5, 0}, {-5, 5, -1}, {5, 5, 1}, {0, -5, 2}};
  const std::vector<glm::uvec3> triangles{{0, 1, 2}, {3, 4, 5}};
  constexpr int width = 61, height = 37;
  for (const bool orthographic : {false, true}) {
    const ViewRays view{.eye = {0.1f, 0.2f, 9},
                        .d0 = {-1, 0.7f, -2},
                        .dx = {0.03f, 0.001f, 0},
                        .dy = {0, -0.04f, 0.002f},
                        .orthographic = orthographic};
    std::vector<std::uint32_t> ids(width * height);
    for (auto& id : ids) id = random.index(5) == 0 ? no_triangle : random.index(2);
    VisiblePoints expected, found;
    compute_visible_points(ids, width, height, view, {corners, triangles, {}}, expected);
    const points::SampleGrid grid(ids.size());
    std::vector<std::uint32_t> listed(grid.pixels(), no_triangle);
    std::vector<glm::vec2> places(grid.pixels());
    std::set<std::size_t> taken;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      ASSERT_TRUE(taken.insert(grid.pixel(i)).second);
      listed[grid.pixel(i)] = ids[i];
      places[grid.pixel(i)] = {static_cast<float>(i % width) + 0.5f, static_cast<float>(i / width) + 0.5f};
    }
    points::compute_sample_points(listed, places, ids.size(), view, {corners, triangles, {}}, found);
    ASSERT_EQ(found.triangles.size(), grid.pixels());
    for (std::size_t i = 0; i < ids.size(); ++i) {
      ASSERT_EQ(found.triangles[grid.pixel(i)], expected.triangles[i]);
      if (ids[i] == no_triangle) continue;
      ASSERT_EQ(found.positions[grid.pixel(i)], expected.positions[i]) << i;
    }
  }
}

TEST(SamplePoints, SixteenOfAListMakeATile) {
  const points::SampleGrid grid(70000);
  for (std::size_t i = 0; i < 70000; i += 16) {
    const std::size_t first = grid.pixel(i), width = static_cast<std::size_t>(grid.width());
    EXPECT_EQ(first % width % 4, 0u);
    EXPECT_EQ(first / width % 4, 0u);
    for (std::size_t k = 0; k < 16; ++k) EXPECT_EQ(grid.pixel(i + k), first + k / 4 * width + k % 4);
  }
  EXPECT_LE(70000u, grid.pixels());
}

TEST(SamplePoints, TakenOnesKeepTheirPlaces) {
  VisiblePoints from;
  from.width = 4, from.height = 2;
  from.triangles = {0, 1, 2, 3, 4, no_triangle, 6, 7};
  for (int i = 0; i < 8; ++i) from.positions.emplace_back(i, -i, 2 * i);
  const std::vector<std::uint32_t> wanted{7, 0, 4};
  VisiblePoints found;
  points::take_points(from, wanted, found);
  const points::SampleGrid grid(3);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(found.triangles[grid.pixel(i)], from.triangles[wanted[i]]);
    EXPECT_EQ(found.positions[grid.pixel(i)], from.positions[wanted[i]]);
  }
  EXPECT_EQ(found.triangles[grid.pixel(3)], no_triangle);
}

}  // namespace
}  // namespace tenebra
