#include "soft/bsp/group_occluders.h"

#include <algorithm>
#include <cmath>

#include "math/l1_norm.h"
#include "points/triangle_corners.h"

namespace tenebra::soft {

namespace {

using glm::dvec2;
using glm::dvec3;

struct Triangle3 {
  dvec3 v[3];
  dvec3 normal;  // not unit
};

Triangle3 triangle_in_double(const TriangleView& triangles, std::uint32_t id) {
  const points::Corners c = points::corners_of(triangles, id);
  Triangle3 r;
  for (int k = 0; k < 3; ++k) r.v[k] = c.v[k];
  r.normal = glm::cross(r.v[1] - r.v[0], r.v[2] - r.v[0]);
  return r;
}

// The line of the edge from a to b, times `sign`.
MovingLine edge_line(const LightFrame& light, const dvec3& centre, const dvec3& a, const dvec3& b,
                     double sign) {
  const dvec3 d = b - a, n = glm::cross(a - centre, d);
  const dvec3 to_origin = light.way_from(a);
  MovingLine line;
  line.c[0] = sign * line_of_plane(light, n, to_origin);
  const dvec3 du = glm::cross(d, light.ex), dv = glm::cross(d, light.ey), dw = glm::cross(d, to_origin);
  for (int k = 0; k < 3; ++k) line.c[k + 1] = -sign * dvec3(du[k], dv[k], dw[k]);
  return line;
}

enum class Side { negative, mixed, positive };

// Which side all of the light lies on for all points of the group. Theorem 1 of Mora et al. 2012: the values
// at the light's vertices and the box's corners decide (each value is affine in the point). Conservative:
// margins cover the rounding of double.
Side side_of(const MovingLine& line, const LightFrame& light, const dvec3& half) {
  bool positive = true, negative = true;
  for (const dvec2& at : light.polygon) {
    double spread = 0, size = math::l1_norm(line.c[0]);
    const dvec3 vertex(at, 1.0);
    for (int k = 0; k < 3; ++k) {
      spread += std::abs(glm::dot(line.c[k + 1], vertex)) * half[k];
      size += math::l1_norm(line.c[k + 1]) * half[k];
    }
    const double value = glm::dot(line.c[0], vertex);
    const double margin = spread + product_rounding * size;
    positive &= value > margin;
    negative &= value < -margin;
  }
  return positive ? Side::positive : negative ? Side::negative : Side::mixed;
}

// Largest sum of coefficients over the group's box, at most.
double size_of(const MovingLine& line, const dvec3& half) {
  double size = math::l1_norm(line.c[0]);
  for (int k = 0; k < 3; ++k) size += math::l1_norm(line.c[k + 1]) * half[k];
  return size;
}

void add_line(MovingLine line, const EdgePlane& plane, const dvec3& half, GroupOccluders& out) {
  const double size = size_of(line, half);
  for (dvec3& c : line.c) c /= size > 0 ? size : 1.0;
  out.lines.push_back(line);
  out.planes.push_back(plane);
}

MovingLine plane_line(const Triangle3& t, const LightFrame& light, double sign) {
  MovingLine line{};
  line.c[0] = sign * line_of_plane(light, t.normal, light.way_from(t.v[0]));
  return line;
}

EdgePlane edge_plane(const Triangle3& t, int edge, const dvec3& centre, double sign) {
  const dvec3 a = t.v[edge] - centre, along = sign * (t.v[(edge + 1) % 3] - t.v[edge]);
  return {a, along, glm::cross(a, along)};
}

// Adds the lines of a definite occluder; false if it does not block.
bool add_definite(const Triangle3& t, const LightFrame& light, const GroupFrame& group, double sign,
                  bool has_plane, GroupOccluders& out) {
  for (int k = 0; k < 3; ++k) {
    const MovingLine line = edge_line(light, group.centre, t.v[k], t.v[(k + 1) % 3], sign);
    const Side side = side_of(line, light, group.half);
    if (side == Side::negative) return false;
    if (side == Side::mixed) add_line(line, edge_plane(t, k, group.centre, sign), group.half, out);
  }
  if (has_plane) add_line(plane_line(t, light, sign), {}, group.half, out);
  return true;
}

bool larger(const Occluder& a, const Occluder& b) {
  return comes_before(a.size, a.triangle, b.size, b.triangle);
}

}  // namespace

void set_up_occluders(const LightFrame& light, const TriangleView& triangles, const GroupFrame& group,
                      const GroupCandidates& candidates, GroupOccluders& out) {
  out.occluders.clear();
  out.indefinite.clear();
  out.lines.clear();
  out.planes.clear();
  out.occluders.reserve(candidates.all.size());
  out.indefinite.reserve(candidates.all.size());
  out.lines.reserve(GroupOccluders::most_lines * candidates.all.size());
  out.planes.reserve(GroupOccluders::most_lines * candidates.all.size());
  for (std::uint32_t place = 0; place < candidates.all.size(); ++place) {
    const Candidate& c = candidates.all[place];
    if (c.sign == 0) {
      out.indefinite.push_back(place);
      continue;
    }
    const Triangle3 t = triangle_in_double(triangles, c.triangle);
    const auto first = static_cast<std::uint32_t>(out.lines.size());
    if (add_definite(t, light, group, c.sign * candidates.axes.turn, c.has_plane, out)) {
      const auto count = static_cast<std::uint32_t>(out.lines.size()) - first;
      out.occluders.push_back({c.triangle, first, count, c.size});
    } else {
      out.lines.resize(first);
      out.planes.resize(first);
    }
  }
  std::sort(out.occluders.begin(), out.occluders.end(), larger);
}

}  // namespace tenebra::soft
