// The maps between square, sphere, disk and hemisphere: inverse to each other, true to areas, the same bits
// in packs as one by one.
#include "ao/cast/sphere_maps.h"

#include <gtest/gtest.h>

#include <vector>

#include "ao/cast/sphere_maps-inl.h"
#include "support/seeded_random.h"

namespace tenebra {
namespace {

using glm::vec2;
using glm::vec3;
using testing::Random;

TEST(SphereMaps, OctantAngleIsTheArcTangent) {
  for (int i = -10000; i <= 10000; ++i) {
    const double t = i / 10000.0;
    EXPECT_NEAR(ao::octant_angle(static_cast<float>(t)), 4 / M_PI * std::atan(t), 8e-7) << t;
  }
}

TEST(SphereMaps, SquareAndSphereAreInverse) {
  Random random(1);
  for (int i = 0; i < 100000; ++i) {
    const vec3 d(random.direction());
    const vec2 square = ao::square_from_direction(d);
    ASSERT_LE(std::abs(square.x), 1.0f);
    ASSERT_LE(std::abs(square.y), 1.0f);
    EXPECT_LT(glm::length(ao::direction_from_square(square) - d), 5e-4) << d.x << " " << d.y << " " << d.z;
    if (std::abs(d.z) < 0.99f) {
      EXPECT_LT(glm::length(ao::direction_from_square(square) - d), 1e-5);
    }
  }
}

TEST(SphereMaps, CellsFindThemselves) {
  for (const int side : {2, 3, 17, 24, 33, 46, 65, 128}) {
    for (int i = 0; i < side * side; ++i) {
      const vec2 centre = ao::cell_point(i, side);
      EXPECT_EQ(ao::cell_index(centre, side), i);
      EXPECT_EQ(ao::cell_index(ao::square_from_direction(ao::direction_from_square(centre)), side), i)
          << side;
      EXPECT_EQ(ao::cell_index(ao::square_from_disk(ao::disk_from_square(centre)), side), i) << side;
      const vec3 h = ao::hemisphere_from_square(centre);
      EXPECT_NEAR(glm::length(h), 1, 1e-6);
      EXPECT_EQ(ao::cell_index(ao::square_from_disk({h.x, h.y}), side), i);
    }
  }
}

TEST(SphereMaps, CellsAreOfOneSize) {
  // Directions drawn evenly fall into all cells alike: chi-square within five standard deviations.
  Random random(2);
  constexpr int side = 17, cells = side * side, draws = 400 * cells;
  std::vector<int> sphere(cells), disk(cells), cosine(cells);
  for (int i = 0; i < draws; ++i) {
    const vec3 d(random.direction());
    ++sphere[static_cast<std::size_t>(ao::cell_index(ao::square_from_direction(d), side))];
    const double r = std::sqrt(random.unit()), phi = random.in(0, 2 * M_PI);
    const vec2 p(r * std::cos(phi), r * std::sin(phi));
    ++disk[static_cast<std::size_t>(ao::cell_index(ao::square_from_disk(p), side))];
    // Lambert: a unit vector plus the normal, normalised, is distributed by the cosine.
    const vec3 lambert = glm::normalize(vec3(random.direction()) * 0.999999f + vec3(0, 0, 1));
    ++cosine[static_cast<std::size_t>(ao::cell_index(ao::square_from_disk({lambert.x, lambert.y}), side))];
  }
  for (const auto& counts : {sphere, disk, cosine}) {
    double chi = 0;
    for (const int count : counts) chi += (count - 400.0) * (count - 400.0) / 400.0;
    EXPECT_LT(chi, cells + 5 * std::sqrt(2.0 * cells));
  }
}

TEST(SphereMaps, LatticeFillsTheSquare) {
  for (const int n : {1, 16, 64, 255, 256, 4096}) {
    glm::dvec2 sum(0);
    std::vector<int> quarters(16);
    for (int i = 0; i < n; ++i) {
      const vec2 p = ao::lattice_point(i, n);
      ASSERT_LT(std::max(std::abs(p.x), std::abs(p.y)), 1.0001f);
      sum += glm::dvec2(p);
      ++quarters[static_cast<std::size_t>(ao::cell_index(p, 4))];
    }
    if (n < 64) continue;
    EXPECT_LT(glm::length(sum) / n, 0.02) << n;
    for (const int count : quarters) EXPECT_NEAR(count, n / 16.0, 2) << n;
  }
}

TEST(SphereMaps, FramesAreOrthonormal) {
  Random random(3);
  for (int i = 0; i < 10000; ++i) {
    const vec3 n = i < 2 ? vec3(0, 0, i ? 1 : -1) : vec3(random.direction());
    const ao::Frame f = ao::frame_around(n);
    EXPECT_NEAR(glm::length(f.x), 1, 1e-5);
    EXPECT_LT(glm::length(glm::cross(f.x, f.y) - n), 1e-5);
  }
}

TEST(SphereMaps, NothingBreaksAtPolesEdgesAndNan) {
  const float nan = NAN, infinity = INFINITY;
  for (const float x : {-1.0f, -0.0f, 0.0f, 1.0f, nan, infinity, -infinity, 1e-40f}) {
    for (const float y : {-1.0f, -0.0f, 0.0f, 1.0f, nan, infinity, -infinity, 1e-40f}) {
      for (const float z : {-1.0f, -0.0f, 0.0f, 1.0f, nan, infinity, -infinity, 1e-40f}) {
        for (const int side : {1, 2, 65}) {
          const int cell = ao::cell_index(ao::square_from_direction({x, y, z}), side);
          EXPECT_GE(cell, 0);
          EXPECT_LT(cell, side * side);
          const int disk_cell = ao::cell_index(ao::square_from_disk({x, y}), side);
          EXPECT_GE(disk_cell, 0);
          EXPECT_LT(disk_cell, side * side);
        }
      }
    }
  }
}

TEST(SphereMaps, PacksGiveTheSameBits) {
  namespace pack = tenebra::ao::HWY_NAMESPACE;
  namespace lanes = tenebra::simd::HWY_NAMESPACE;
  Random random(4);
  for (int i = 0; i < 20000; ++i) {
    float x[16], y[16], z[16], x2[16], y2[16], z2[16], u[16], v[16], s[16], t[16];
    std::int32_t cell[16];
    for (int k = 0; k < 16; ++k) {
      vec3 d(random.direction());
      if (random.chance(0.2)) d[static_cast<int>(random.index(3))] = random.chance(0.5) ? 0.0f : -0.0f;
      x[k] = d.x, y[k] = d.y, z[k] = d.z;
    }
    using P = lanes::Float16;
    const pack::Square16 sphere =
        pack::square_from_direction({lanes::load<P>(x), lanes::load<P>(y), lanes::load<P>(z)});
    const pack::Square16 disk = pack::square_from_disk(lanes::load<P>(x), lanes::load<P>(y));
    lanes::store(sphere.u, u), lanes::store(sphere.v, v), lanes::store(disk.u, s), lanes::store(disk.v, t);
    const pack::Cell16 cells = pack::cell_of(sphere, 46);
    lanes::store(pack::cell_index(cells, 46), cell);
    const pack::Pack3<P> back = pack::direction_from_square(pack::cell_point(cells, 46));
    lanes::store(back.x, x2), lanes::store(back.y, y2), lanes::store(back.z, z2);
    for (int k = 0; k < 16; ++k) {
      const vec2 square = ao::square_from_direction({x[k], y[k], z[k]});
      ASSERT_EQ(square, vec2(u[k], v[k]));
      ASSERT_EQ(ao::square_from_disk({x[k], y[k]}), vec2(s[k], t[k]));
      ASSERT_EQ(ao::cell_index(square, 46), cell[k]);
      ASSERT_EQ(ao::direction_from_square(ao::cell_point(cell[k], 46)), vec3(x2[k], y2[k], z2[k]));
    }
  }
}

}  // namespace
}  // namespace tenebra
