// Ambient occlusion of hard cases, against rays in double through every triangle.
#include <tenebra/ambient_occlusion.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "hard_cases.h"

namespace tenebra {
namespace {

using namespace testing;
using glm::dvec3;

constexpr int catalogue_width = 64, catalogue_height = 48;
constexpr int step = 7;  // one of so many pixels is looked at

/// Distance of the first triangle that a ray meets, at most `reach`. Nothing is culled, and no tree is built.
double first_hit(const std::vector<std::array<dvec3, 3>>& triangles, const dvec3& origin, const dvec3& way,
                 double reach) {
  for (const auto& [a, b, c] : triangles) {
    const dvec3 u = b - a, v = c - a, p = glm::cross(way, v);
    const double det = glm::dot(u, p);
    if (det == 0) continue;
    const dvec3 from = origin - a, q = glm::cross(from, u);
    const double s = glm::dot(from, p) / det, t = glm::dot(way, q) / det, hit = glm::dot(v, q) / det;
    if (s >= 0 && t >= 0 && s + t <= 1 && hit > 0 && hit < reach) reach = hit;
  }
  return reach;
}

/// Share of the ambient light at a point, by 32 x 32 rays spread evenly under the cosine; those below the
/// face are mirrored at it.
double openness(const std::vector<std::array<dvec3, 3>>& triangles, const dvec3& point, const dvec3& normal,
                const dvec3& face, double reach) {
  constexpr int side = 32;
  const dvec3 across =
      glm::normalize(glm::cross(normal, std::abs(normal.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
  const dvec3 up = glm::cross(normal, across);
  double sum = 0;
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      const double r = std::sqrt((i + 0.5) / side),
                   a = 2 * std::numbers::pi * (j + 0.5 + 0.5 * (i % 2)) / side;
      dvec3 way = r * std::cos(a) * across + r * std::sin(a) * up + std::sqrt(1 - r * r) * normal;
      if (glm::dot(way, face) < 0) way -= 2 * glm::dot(way, face) * face;
      sum += first_hit(triangles, point, way, reach) / reach;
    }
  }
  return sum / (side * side);
}

/// A pixel's value by rays in double. They start off the face, by a few of the floats' steps, as rays of the
/// library do; so triangles in one plane do not hide each other.
double truth_at(const AoView& view, std::size_t pixel, double reach) {
  const dvec3 at = view.points.positions[pixel];
  const glm::uvec3 own = view.geometry.triangles[view.points.triangles[pixel]];
  const auto corner = [&](const glm::uvec3& t, int k) { return dvec3(view.geometry.positions[t[k]]); };
  dvec3 face = glm::normalize(glm::cross(corner(own, 1) - corner(own, 0), corner(own, 2) - corner(own, 0)));
  const dvec3 normal(view.normals[pixel]);
  if (glm::dot(face, normal) < 0) face = -face;
  double largest = 0;
  for (const glm::vec3& p : view.geometry.positions)
    largest = std::max({largest, std::abs(double{p.x}), std::abs(double{p.y}), std::abs(double{p.z})});
  std::vector<std::array<dvec3, 3>> near;
  for (const glm::uvec3& t : view.geometry.triangles) {
    const dvec3 a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
    const dvec3 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
    if (glm::length(glm::max(dvec3(0.0), glm::max(low - at, at - high))) <= reach) near.push_back({a, b, c});
  }
  return openness(near, at + 8 * 0x1p-24 * largest * face, glm::normalize(normal), face, reach);
}

struct Bound {
  double rms_255, most_255;
};

/// `crowd`: of two thousand bodies that touch.
void expect_truth(AoConfig config, const Bound& bound_of_most, const Bound& crowd) {
  for (const HardCase& hard : hard_cases()) {
    const Bound& bound = std::string_view(hard.name) == "two thousand instances" ? crowd : bound_of_most;
    const AoView view(hard.scene, 0, hard.view, catalogue_width, catalogue_height);
    config.distance_m = hard.distance_m;
    const std::vector<float> found = occlude(hard.scene, view, config);
    double squares = 0, most = 0;
    int count = 0;
    for (std::size_t i = 0; i < found.size(); i += step) {
      if (view.points.triangles[i] == no_triangle) continue;
      const double off = 255 * (double{found[i]} - truth_at(view, i, hard.distance_m));
      squares += off * off, most = std::max(most, std::abs(off)), ++count;
    }
    ASSERT_GT(count, 20) << hard.name;
    EXPECT_LT(std::sqrt(squares / count), bound.rms_255) << hard.name << " " << hard.distance_m;
    EXPECT_LT(most, bound.most_255) << hard.name << " " << hard.distance_m;
  }
}

TEST(AoCatalogue, AdaptiveMeetsTheErrorAskedFor) {
  AoConfig config;
  config.mode = AoMode::adaptive;
  config.error_255 = 1;
  expect_truth(config, {1.3, 8}, {1.3, 8});
}

/// Fields have the bias that docs/architecture.md states, and a little more where thousands of bodies touch,
/// as these do not hide independently of one another (7.9 when written).
TEST(AoCatalogue, FieldsStayWithinTheirBias) {
  AoConfig config;
  config.mode = AoMode::field;
  config.rays = 256;
  config.positions = config.directions = 576;
  expect_truth(config, {1.5, 8}, {8.5, 32});
}

}  // namespace
}  // namespace tenebra
