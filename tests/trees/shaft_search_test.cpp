// Triangles in shafts: all that may meet one, the same for any tree over them, also after they have moved.
#include "trees/shaft_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>

#include "support/seeded_random.h"

namespace tenebra {
namespace {

using glm::dvec3;
using testing::Random;

struct Cloud {
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;

  math::Box<double> box_of(std::size_t triangle) const {
    math::Box<double> box;
    for (int k = 0; k < 3; ++k) box.add(dvec3(positions[triangles[triangle][k]]));
    return box;
  }
  math::Box<double> box() const {
    math::Box<double> all;
    for (std::size_t t = 0; t < triangles.size(); ++t) all.add(box_of(t));
    return all;
  }
};

void move(Cloud& cloud, Random& random) {
  for (std::size_t t = 0; t < cloud.triangles.size(); ++t) {
    const dvec3 at = random.in_cube(1);
    for (int k = 0; k < 3; ++k) cloud.positions[cloud.triangles[t][k]] = glm::vec3(at + random.in_cube(0.05));
  }
}

Cloud cloud_of(int count, Random& random) {
  Cloud cloud;
  cloud.positions.resize(static_cast<std::size_t>(3 * count));
  for (std::uint32_t t = 0; t < static_cast<std::uint32_t>(count); ++t)
    cloud.triangles.emplace_back(3 * t, 3 * t + 1, 3 * t + 2);
  move(cloud, random);
  return cloud;
}

math::Box<double> small_box(Random& random) {
  math::Box<double> box;
  const dvec3 at = random.in_cube(1.5);
  box.add(at), box.add(at + random.in_cube(0.1));
  return box;
}

std::vector<std::uint32_t> found_in(const trees::TriangleBvh& tree, const trees::BoxShaft& shaft,
                                    double reach, SimdLevel level) {
  std::vector<trees::BlockTriangles> blocks;
  trees::shaft_search(level).find(tree, {shaft, reach}, blocks);
  std::vector<std::uint32_t> found;
  for (const trees::BlockTriangles& some : blocks)
    for (std::uint32_t lanes = some.lanes; lanes != 0; lanes &= lanes - 1)
      found.push_back(tree.blocks[some.block].triangle[std::countr_zero(lanes)]);
  std::sort(found.begin(), found.end());
  return found;
}

bool meets(const Cloud& cloud, std::size_t triangle, const dvec3& from, const dvec3& to) {
  const math::Box<double> box = cloud.box_of(triangle);
  double first = 0, last = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = to[axis] - from[axis];
    const double a = (box.low[axis] - from[axis]) / d, b = (box.high[axis] - from[axis]) / d;
    first = std::max(first, std::min(a, b)), last = std::min(last, std::max(a, b));
  }
  return first <= last;
}

/// What lines between the two boxes of a shaft meet is found.
void expect_all(const Cloud& cloud, const trees::TriangleBvh& tree, Random& random) {
  const double reach = cloud.box().largest_coordinate();
  for (int shafts = 0; shafts < 50; ++shafts) {
    const math::Box<double> a = small_box(random), b = small_box(random);
    const auto shaft = trees::shaft_between(a, b);
    const auto found = found_in(tree, shaft, reach, SimdLevel::automatic);
    EXPECT_EQ(trees::shaft_search(SimdLevel::automatic).any(tree, {shaft, reach}), !found.empty());
    for (int lines = 0; lines < 8; ++lines) {
      const auto in = [&](const math::Box<double>& box) {
        return glm::mix(box.low, box.high, 0.5 * (random.in_cube(1) + 1.0));
      };
      const dvec3 from = in(a), to = in(b);
      for (std::uint32_t t = 0; t < cloud.triangles.size(); ++t)
        if (meets(cloud, t, from, to)) {
          EXPECT_TRUE(std::binary_search(found.begin(), found.end(), t)) << t;
        }
    }
  }
}

TEST(ShaftSearch, FindsWhatLiesInAShaft) {
  Random random(1);
  const Cloud cloud = cloud_of(500, random);
  expect_all(cloud, trees::build_triangle_bvh(cloud.positions, cloud.triangles), random);
}

TEST(ShaftSearch, FindsTheSameAfterTrianglesMovedAsInANewTree) {
  Random random(2);
  Cloud cloud = cloud_of(500, random);
  for (int k = 0; k < 3; ++k) cloud.positions[static_cast<std::size_t>(k)] = glm::vec3(0.5f);  // flat for now
  auto tree = *trees::build_triangle_bvh(cloud.positions, cloud.triangles, nullptr, trees::BvhHolds::all);
  EXPECT_EQ(tree.triangles, 500u);
  move(cloud, random);
  trees::refit_triangle_bvh(cloud.positions, cloud.triangles, tree);
  expect_all(cloud, tree, random);
  const auto made_anew = trees::build_triangle_bvh(cloud.positions, cloud.triangles);
  for (const SimdLevel level : {SimdLevel::scalar, SimdLevel::sse4, SimdLevel::avx2, SimdLevel::avx512}) {
    for (int shafts = 0; shafts < 50; ++shafts) {
      const auto shaft = trees::shaft_between(small_box(random), small_box(random));
      EXPECT_EQ(found_in(tree, shaft, 1.1, level), found_in(made_anew, shaft, 1.1, level));
    }
  }
}

TEST(ShaftSearch, FindsNothingAmongNoTriangles) {
  const trees::BoxShaft shaft = trees::shaft_between({dvec3(0), dvec3(1)}, {dvec3(2), dvec3(3)});
  EXPECT_TRUE(found_in({}, shaft, 1, SimdLevel::automatic).empty());
  EXPECT_FALSE(trees::shaft_search(SimdLevel::automatic).any({}, {shaft, 1}));
}

}  // namespace
}  // namespace tenebra
