#include "formats/obj/polygon.h"

#include <cmath>

namespace tenebra::formats {
namespace {

using Points = std::vector<glm::dvec2>;

/// Newell's normal: twice the area vector, right for concave and slightly bent polygons too.
glm::dvec3 area_vector(std::span<const glm::vec3> corners) {
  glm::dvec3 sum(0);
  const glm::dvec3 origin(corners[0]);
  for (std::size_t i = 0; i < corners.size(); ++i)
    sum +=
        glm::cross(glm::dvec3(corners[i]) - origin, glm::dvec3(corners[(i + 1) % corners.size()]) - origin);
  return sum;
}

/// Drops the axis along which the normal is longest; keeps the turning counter-clockwise.
Points flatten(std::span<const glm::vec3> corners) {
  const glm::dvec3 n = area_vector(corners), size = glm::abs(n);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  Points points;
  for (const glm::vec3& p : corners)
    points.emplace_back(n[axis] < 0 ? glm::dvec2(p[v], p[u]) : glm::dvec2(p[u], p[v]));
  return points;
}

double turn(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool is_ear(const Points& points, const std::vector<std::uint32_t>& ring, std::size_t i,
            std::uint64_t& work) {
  const std::size_t n = ring.size();
  const auto a = points[ring[(i + n - 1) % n]], b = points[ring[i]], c = points[ring[(i + 1) % n]];
  if (!(turn(a, b, c) > 0)) return false;
  for (std::size_t k = 0; k < n; ++k) {
    const auto p = points[ring[k]];
    ++work;
    if (p == a || p == b || p == c) continue;
    if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
  }
  return true;
}

}  // namespace

std::vector<glm::uvec3> triangulate(std::span<const glm::vec3> corners, std::uint64_t& work) {
  std::vector<glm::uvec3> triangles;
  if (corners.size() < 3) return triangles;
  std::vector<std::uint32_t> ring(corners.size());
  for (std::size_t i = 0; i < ring.size(); ++i) ring[i] = static_cast<std::uint32_t>(i);
  const Points points = corners.size() > 3 ? flatten(corners) : Points{};
  std::size_t at = 1, failed = 0;
  while (ring.size() > 3) {
    const std::size_t n = ring.size();
    at %= n;
    // A whole round without an ear: the polygon crosses itself or has no area; any corner will do.
    if (failed < n && !is_ear(points, ring, at, work)) {
      ++at;
      ++failed;
      continue;
    }
    triangles.emplace_back(ring[(at + n - 1) % n], ring[at], ring[(at + 1) % n]);
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(at));
    failed = 0;
  }
  triangles.emplace_back(ring[0], ring[1], ring[2]);
  return triangles;
}

}  // namespace tenebra::formats
