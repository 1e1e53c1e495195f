#include "formats/polygon.h"

#include <cmath>

#include "formats/import_failure.h"

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
  points.reserve(corners.size());
  for (const glm::vec3& p : corners)
    points.emplace_back(n[axis] < 0 ? glm::dvec2(p[v], p[u]) : glm::dvec2(p[u], p[v]));
  return points;
}

double turn(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// What is left of a polygon while its ears are cut off.
class Remains {
public:
  explicit Remains(const Points& points)
      : points_(points), next_(points.size()), previous_(points.size()), is_bent_in_(points.size(), false) {
    const auto size = static_cast<std::uint32_t>(points.size());
    for (std::uint32_t i = 0; i < size; ++i) {
      next_[i] = (i + 1) % size;
      previous_[i] = (i + size - 1) % size;
    }
    for (std::uint32_t i = 0; i < size; ++i) note_bend(i);
  }

  std::uint32_t next(std::uint32_t i) const { return next_[i]; }
  std::uint32_t previous(std::uint32_t i) const { return previous_[i]; }

  /// Whether the triangle at corner `i` lies inside and no other corner in it. It is enough to look at
  /// corners that are not convex: if any lies in it, one of these does.
  bool is_ear(std::uint32_t i, std::uint64_t& work) const {
    const auto a = points_[previous_[i]], b = points_[i], c = points_[next_[i]];
    ++work;
    if (!(turn(a, b, c) > 0)) return false;
    for (const std::uint32_t k : bent_in_) {
      const auto p = points_[k];
      ++work;
      if (!is_bent_in_[k] || p == a || p == b || p == c) continue;
      if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
    }
    return true;
  }

  void cut(std::uint32_t i) {
    const std::uint32_t before = previous_[i], after = next_[i];
    next_[before] = after;
    previous_[after] = before;
    forget(i);
    note_bend(before);
    note_bend(after);
    if (2 * forgotten_ <= bent_in_.size()) return;
    std::erase_if(bent_in_, [&](std::uint32_t k) { return !is_bent_in_[k]; });
    forgotten_ = 0;
  }

private:
  void note_bend(std::uint32_t i) {
    const bool convex = turn(points_[previous_[i]], points_[i], points_[next_[i]]) > 0;
    if (convex) return forget(i);
    if (!is_bent_in_[i]) bent_in_.push_back(i);
    is_bent_in_[i] = true;
  }
  void forget(std::uint32_t i) {
    forgotten_ += is_bent_in_[i];
    is_bent_in_[i] = false;
  }

  const Points& points_;
  std::vector<std::uint32_t> next_, previous_;  ///< of each corner that is left
  std::vector<std::uint32_t> bent_in_;          ///< corners that are not convex, and forgotten ones
  std::vector<bool> is_bent_in_;
  std::size_t forgotten_ = 0;  ///< entries of bent_in_ that are not any more
};

}  // namespace

std::vector<glm::uvec3> triangulate(std::span<const glm::vec3> corners, std::uint64_t& work) {
  if (corners.size() < 3) return {};
  if (corners.size() == 3) return {{0, 1, 2}};
  const Points points = flatten(corners);
  Remains remains(points);
  std::vector<glm::uvec3> triangles;
  triangles.reserve(corners.size() - 2);
  std::uint32_t at = 1, first = 0;  // first: the smallest corner that is left
  std::size_t left = corners.size(), failed = 0;
  while (left > 3) {
    // A whole round without an ear: the polygon crosses itself or has no area; any corner will do. So it will
    // where the work is too much.
    if (failed < left && work <= most_polygon_work && !remains.is_ear(at, work)) {
      at = remains.next(at);
      ++failed;
      continue;
    }
    const std::uint32_t after = remains.next(at);
    triangles.emplace_back(remains.previous(at), at, after);
    remains.cut(at);
    if (at == first) first = after;
    at = after;
    --left;
    failed = 0;
  }
  triangles.emplace_back(first, remains.next(first), remains.previous(first));
  return triangles;
}

void add_polygon(std::span<const std::uint32_t> corners, std::uint64_t& work, Mesh& mesh) {
  if (corners.size() == 3) return void(mesh.triangles.emplace_back(corners[0], corners[1], corners[2]));
  const auto check = [&](bool fits) {
    if (!fits)
      refuse(
          "face of '{}': found a polygon of {} corners, expected simpler ones: cut it into triangles at the "
          "export",
          shown(mesh.name), corners.size());
  };
  check(corners.size() <= most_polygon_corners);
  std::vector<glm::vec3> points;
  points.reserve(corners.size());
  for (const std::uint32_t corner : corners) points.push_back(mesh.positions[corner]);
  const std::vector<glm::uvec3> triangles = triangulate(points, work);
  check(work <= most_polygon_work);
  for (const glm::uvec3& t : triangles) mesh.triangles.emplace_back(corners[t.x], corners[t.y], corners[t.z]);
}

}  // namespace tenebra::formats
