#include "query/point_surfaces.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/fail.h"
#include "parallel/parallel.h"
#include "points/triangle_corners.h"

namespace tenebra::query {

namespace {

using glm::dvec3;

/// The first of 0 .. count - 1 that is bad, or `count`.
template <class Bad>
std::size_t first_bad(std::size_t count, const Bad& bad) {
  constexpr std::size_t grain = 1 << 14;
  std::vector<std::size_t> found((count + grain - 1) / grain, count);
  parallel::parallel_ranges(count, grain, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last && found[first / grain] == count; ++i)
      if (bad(i)) found[first / grain] = i;
  });
  return found.empty() ? count : *std::min_element(found.begin(), found.end());
}

template <class Vector>
bool finite(const Vector& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool in_range(const dvec3& p) {
  return finite(p) && std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= largest_coordinate;
}

Expected<void> check_sizes(const QueryPoints& points) {
  const std::size_t count = points.positions.size();
  const auto check = [count](const char* what, std::size_t size) -> Expected<void> {
    if (size == 0 || size == count) return {};
    return base::fail("points: found {} {}, expected one for each of {} points, or none", size, what, count);
  };
  if (auto checked = check("triangles", points.triangles.size()); !checked) return checked;
  if (auto checked = check("normals", points.normals.size()); !checked) return checked;
  if (auto checked = check("sides", points.sides.size()); !checked) return checked;
  if (points.width < 0 || (points.width > 0 && count % static_cast<std::size_t>(points.width) != 0))
    return base::fail("points: found {} points and a width of {}, expected whole rows", count, points.width);
  return {};
}

}  // namespace

Expected<void> check_points(const QueryPoints& points, const GeometryData& geometry) {
  if (auto checked = check_sizes(points); !checked) return checked;
  const std::size_t count = points.positions.size();
  const std::size_t far = first_bad(count, [&](std::size_t i) { return !in_range(points.positions[i]); });
  if (far < count) {
    const dvec3& p = points.positions[far];
    return base::fail("points: point {} is at ({}, {}, {}), expected finite coordinates of at most 1e18", far,
                      p.x, p.y, p.z);
  }
  const std::size_t triangles = geometry.triangles.size();
  const std::size_t lost = first_bad(points.triangles.size(), [&](std::size_t i) {
    return points.triangles[i] >= triangles && points.triangles[i] != no_triangle;
  });
  if (lost < points.triangles.size())
    return base::fail("points: point {} lies on triangle {}, expected a number below {} or none", lost,
                      points.triangles[lost], triangles);
  const std::size_t bent =
      first_bad(points.normals.size(), [&](std::size_t i) { return !finite(points.normals[i]); });
  if (bent < points.normals.size())
    return base::fail("points: the normal of point {} is not finite, expected a direction or zero", bent);
  const std::size_t odd = first_bad(
      points.sides.size(), [&](std::size_t i) { return points.sides[i] < -1 || points.sides[i] > 1; });
  if (odd < points.sides.size())
    return base::fail("points: the side of point {} is {}, expected 1, -1 or 0", odd, points.sides[odd]);
  return {};
}

bool some_free(const QueryPoints& points) {
  const auto& on = points.triangles;
  return on.empty() || std::find(on.begin(), on.end(), no_triangle) != on.end();
}

dvec3 face_normal(const TriangleView& triangles, std::uint32_t triangle) {
  const points::Corners c = points::corners_of(triangles, triangle);
  const dvec3 a(c.v[0]), n = glm::cross(dvec3(c.v[1]) - a, dvec3(c.v[2]) - a);
  const double length = glm::length(n);
  return length > 0 ? n / length : dvec3(0.0);
}

int said_side(const QueryPoints& points, std::size_t i, const TriangleView& triangles) {
  if (!points.sides.empty() && points.sides[i] != 0) return points.sides[i];
  const glm::vec3 normal = normal_of(points, i);
  if (normal == glm::vec3(0.0f)) return 0;
  const double cosine = glm::dot(face_normal(triangles, points.triangles[i]), dvec3(normal));
  return cosine > 0 ? 1 : cosine < 0 ? -1 : 0;
}

}  // namespace tenebra::query
