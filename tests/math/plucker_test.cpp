#include "math/plucker.h"

#include <gtest/gtest.h>

#include <vector>

#include "reference/dyadic.h"
#include "support/seeded_random.h"

namespace tenebra {
namespace {

using glm::dvec3;
using reference::Dyadic;

// The paper's coordinates l0..l5 written out, and its side operator.
template <class N>
N paper_side(const dvec3& p, const dvec3& q, const dvec3& a, const dvec3& b) {
  const auto coordinates = [](const dvec3& s, const dvec3& t, N l[6]) {
    const N px = s.x, py = s.y, pz = s.z, qx = t.x, qy = t.y, qz = t.z;
    l[0] = qx - px, l[1] = qy - py, l[2] = qz - pz;
    l[3] = qz * py - qy * pz, l[4] = qx * pz - qz * px, l[5] = qy * px - qx * py;
  };
  N l[6], r[6];
  coordinates(p, q, l);
  coordinates(a, b, r);
  return l[3] * r[0] + l[4] * r[1] + l[5] * r[2] + l[0] * r[3] + l[1] * r[4] + l[2] * r[5];
}

// The x axis, and a line along y one above it: 1 * (-1) summed by hand.
TEST(Plucker, SideOfTwoSkewLinesByHand) {
  const math::PluckerLine x = math::line_through({0, 0, 0}, {1, 0, 0}),
                          y = math::line_through({0, 0, 1}, {0, 1, 1});
  EXPECT_EQ(x.moment, dvec3(0));
  EXPECT_EQ(y.moment, dvec3(-1, 0, 0));  // (0,0,1) x (0,1,1)
  EXPECT_EQ(math::side(x, y), -1);
  EXPECT_EQ(math::side(y, x), -1);
  EXPECT_EQ(math::side(x, math::line_through({0, 1, 1}, {0, 0, 1})), 1)
      << "a line turned around changes sides";
  EXPECT_EQ(math::side_sign({0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 1, 1}), -1);
}

TEST(Plucker, SideIsZeroWhereLinesMeetOrAreParallel) {
  EXPECT_EQ(math::side(math::line_through({1, 2, 3}, {4, 5, 6}), math::line_through({1, 2, 3}, {-7, 2, 9})),
            0);
  EXPECT_EQ(math::side(math::line_through({1, 2, 3}, {2, 2, 3}), math::line_through({5, 0, 0}, {9, 0, 0})),
            0);
  EXPECT_EQ(math::side_sign({1, 2, 3}, {4, 5, 6}, {1, 2, 3}, {-7, 2, 9}), 0);
  EXPECT_EQ(math::side_sign({1, 2, 3}, {2, 2, 3}, {5, 0, 0}, {9, 0, 0}), 0);
}

TEST(Plucker, SideIsThatOfThePaper) {
  testing::Random random(31);
  for (int i = 0; i < 2000; ++i) {
    const dvec3 p = random.grid(50), q = random.grid(50), a = random.grid(50), b = random.grid(50);
    EXPECT_EQ(math::side(math::line_through(p, q), math::line_through(a, b)),
              (paper_side<double>(p, q, a, b)))
        << i;
  }
}

// Whole numbers (many lie in one plane), wide ranges, and points a rounding off a common plane.
TEST(Plucker, SideSignIsExact) {
  testing::Random random(32);
  int zeros = 0, close = 0;
  for (int i = 0; i < 30000; ++i) {
    dvec3 v[4];
    for (dvec3& x : v)
      x = i % 3 == 0 ? random.grid(2) : i % 3 == 1 ? random.wide(-40, 40) : random.in_cube(1);
    if (i % 3 == 2) {  // b nearly in the plane of the others
      v[3] = v[0] + random.unit() * (v[1] - v[0]) + random.unit() * (v[2] - v[0]);
      ++close;
    }
    const int expected = paper_side<Dyadic>(v[0], v[1], v[2], v[3]).sign();
    zeros += expected == 0;
    ASSERT_EQ(math::side_sign(v[0], v[1], v[2], v[3]), expected) << "case " << i;
  }
  EXPECT_GT(zeros, 500);
  EXPECT_GT(close, 5000);
}

TEST(Plucker, MomentsKeepTheirBound) {
  testing::Random random(34);
  for (int i = 0; i < 20000; ++i) {
    const dvec3 p = random.wide(-30, 30), q = i % 2 == 0 ? random.wide(-30, 30) : p * random.in(0.5, 2);
    const dvec3 moment = math::line_through(p, q).moment;
    const double bound = 0x1p-52 * (std::abs(p.x) + std::abs(p.y) + std::abs(p.z)) *
                         (std::abs(q.x) + std::abs(q.y) + std::abs(q.z));
    for (int k = 0; k < 3; ++k) {
      const int j = (k + 1) % 3, l = (k + 2) % 3;
      const Dyadic error = Dyadic(p[j]) * Dyadic(q[l]) - Dyadic(p[l]) * Dyadic(q[j]) - Dyadic(moment[k]);
      ASSERT_LE((error - Dyadic(bound)).sign(), 0) << "case " << i;
      ASSERT_GE((error + Dyadic(bound)).sign(), 0) << "case " << i;
    }
  }
}

std::vector<dvec3> polygon(testing::Random& random, int kind) {
  std::vector<dvec3> vertices;
  const dvec3 centre = kind == 0 ? random.grid(3) : 2.0 * random.in_cube(1);
  for (int k = 0; k < 4; ++k) vertices.push_back(centre + (kind == 0 ? random.grid(1) : random.in_cube(0.5)));
  return vertices;
}
dvec3 within(const std::vector<dvec3>& vertices, testing::Random& random) {
  dvec3 sum(0);
  double weight = 0;
  for (const dvec3& v : vertices) {
    const double w = random.index(8);  // whole weights: often on a face, an edge or a vertex
    sum += w * v, weight += w;
  }
  return weight > 0 ? sum / weight : vertices[0];
}

// Theorem 1: where the vertices' lines agree, so do all lines between the hulls; where they do not, neither
// sign holds for all.
TEST(Plucker, VertexLinesDecideForAllLines) {
  testing::Random random(33);
  int decided = 0;
  for (int i = 0; i < 4000; ++i) {
    const auto from = polygon(random, i % 2), to = polygon(random, i % 2);
    const dvec3 a = 3.0 * random.in_cube(1), b = 3.0 * random.in_cube(1);
    const math::Orientation all = math::orientation(from, to, a, b);
    if (all == math::Orientation::mixed) {
      bool negative = false, positive = false;
      for (const dvec3& p : from)
        for (const dvec3& q : to) {
          const int sign = math::side_sign(p, q, a, b);
          negative |= sign <= 0, positive |= sign >= 0;
        }
      EXPECT_TRUE(negative && positive) << "case " << i;
      continue;
    }
    ++decided;
    for (int line = 0; line < 30; ++line)
      ASSERT_EQ(math::side_sign(within(from, random), within(to, random), a, b),
                all == math::Orientation::positive ? 1 : -1)
          << "case " << i;
  }
  EXPECT_GT(decided, 300);
}

TEST(Plucker, NoLinesHaveNoOrientation) {
  const std::vector<dvec3> one{dvec3(1, 2, 3)};
  EXPECT_EQ(math::orientation({}, one, {0, 0, 0}, {1, 0, 0}), math::Orientation::mixed);
  EXPECT_EQ(math::orientation(one, one, {0, 0, 0}, {1, 0, 0}), math::Orientation::mixed)
      << "a point is no line";
}

}  // namespace
}  // namespace tenebra
