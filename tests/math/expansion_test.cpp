#include "math/expansion.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <cmath>

#include "math/predicates.h"
#include "support/seeded_random.h"

namespace tenebra {
namespace {

using glm::dvec3;
using glm::vec3;

mpq_class determinant(const mpq_class m[3][3]) {
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

int rational_edge_side(const vec3& l, const vec3& a, const vec3& b, const dvec3& p) {
  mpq_class m[3][3];
  for (int k = 0; k < 3; ++k) {
    m[0][k] = mpq_class(a[k]) - mpq_class(l[k]);
    m[1][k] = mpq_class(b[k]) - mpq_class(l[k]);
    m[2][k] = mpq_class(p[k]) - mpq_class(l[k]);
  }
  return sgn(determinant(m));
}

TEST(Expansion, SignOfASumThatCancelsInDouble) {
  const math::Expansion big(1e30), small(1e-30);
  EXPECT_EQ(((big + small) - big).sign(), 1);
  EXPECT_EQ(((big - small) - big).sign(), -1);
  EXPECT_EQ(((big + small) - big - small).sign(), 0);
  EXPECT_EQ((math::Expansion::product(1 + 0x1p-52, 1 + 0x1p-52) - math::Expansion(1 + 0x1p-51)).sign(), 1);
}

TEST(Predicates, EdgeSideEqualsRationalArithmetic) {
  testing::Random random(7);
  int zeros = 0;
  for (int i = 0; i < 20000; ++i) {
    const bool wide = i % 2 == 0;
    const auto point = [&] { return wide ? vec3(random.wide(-26, 26)) : vec3(random.grid(4)); };
    const vec3 l = point(), a = point(), b = point();
    const dvec3 p = i % 4 == 0 ? dvec3(l) + random.unit() * (dvec3(a) - dvec3(l)) : dvec3(point());
    const int expected = rational_edge_side(l, a, b, p);
    zeros += expected == 0;
    ASSERT_EQ(math::edge_side(l, a, b, p), expected) << "case " << i;
  }
  EXPECT_GT(zeros, 100) << "the degenerate half of the cases is missing";
}

TEST(Predicates, PointSideEqualsRationalArithmetic) {
  testing::Random random(8);
  for (int i = 0; i < 20000; ++i) {
    const auto point = [&] { return i % 2 == 0 ? vec3(random.wide(-99, 99)) : vec3(random.grid(3)); };
    const vec3 a = point(), b = point(), c = point(), p = point();
    ASSERT_EQ(math::point_side(a, b, c, p), rational_edge_side(a, b, c, p)) << "case " << i;
    ASSERT_EQ(math::plane_excess(a, b, c, p, 1, 0.0), rational_edge_side(a, b, c, p)) << "case " << i;
    ASSERT_EQ(math::plane_excess(a, b, c, p, -1, 0.0), -rational_edge_side(a, b, c, p)) << "case " << i;
  }
}

}  // namespace
}  // namespace tenebra
