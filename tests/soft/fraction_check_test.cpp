// check_fractions finds all wrong fractions, and no others.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "oracle/fraction_check.h"

namespace tenebra::testing {
namespace {

TEST(FractionCheck, NamesASampleThatIsOffByMoreThanIsPromised) {
  // A square light above a floor; the left half of what the point sees of it is covered.
  const std::array positions{glm::vec3(-9, 0, -9), glm::vec3(0, 0, 9), glm::vec3(9, 0, -9),
                             glm::vec3(0, 1, -9),  glm::vec3(0, 1, 9), glm::vec3(-9, 1, 0)};
  const std::array triangles{glm::uvec3(0, 1, 2), glm::uvec3(3, 4, 5)};
  TriangleView view;
  view.positions = positions;
  view.triangles = triangles;
  ViewRays rays;
  rays.eye = {0, 5, 0};
  const auto light = make_rectangle_light({0, 2, 0}, {1, 0, 0}, {0, 0, 1});  // shines down
  ASSERT_TRUE(light);
  const oracle::ExactSoft exact(rays, view, *light);
  VisiblePoints points;
  points.positions.assign(3, glm::dvec3(0));
  points.triangles.assign(3, 0);
  const std::array<float, 3> fractions{0.5f, 0.5f + 1e-4f, 0.25f};
  const std::array<std::size_t, 3> pixels{0, 1, 2};
  const auto check = [&](double promise) {
    return oracle::check_fractions({.front = &exact, .promise = promise}, points, fractions, pixels);
  };
  const oracle::FractionCheck found = check(1e-6);
  EXPECT_EQ(found.stats.samples, 3u);
  EXPECT_EQ(found.stats.penumbra, 3u);
  EXPECT_DOUBLE_EQ(found.stats.largest_error, 0.25);
  ASSERT_EQ(found.wrong_count, 2u);
  EXPECT_EQ(found.wrong[0].pixel, 1u);
  EXPECT_EQ(found.wrong[1].exact, 0.5);
  EXPECT_EQ(check(1e-3).wrong_count, 1u);
  EXPECT_EQ(
      oracle::check_fractions({.front = &exact, .promise = 1, .most_occluders = 0}, points, fractions, pixels)
          .stats.skipped,
      3u);
  std::vector<std::size_t> many(10'000, 0);  // more than are looked at in one go
  std::fill(many.begin() + 4000, many.end(), 2);
  const auto all = oracle::check_fractions({.front = &exact, .promise = 1e-6}, points, fractions, many);
  EXPECT_EQ(all.stats.samples, many.size());
  EXPECT_EQ(all.wrong_count, 6000u);
  EXPECT_EQ(all.wrong.size(), std::size_t{oracle::FractionCheck::most_named});
}

}  // namespace
}  // namespace tenebra::testing
