#include "soft/group_occluders.h"

#include <algorithm>
#include <cmath>

#include "points/contact_rule.h"
#include "points/triangle_corners.h"

namespace tenebra {

namespace {

using glm::dvec2;
using glm::dvec3;

// Rounding of the sums of products below, relative to the sum of their magnitudes: fewer than 16 operations
// on inputs that carry one rounding each.
constexpr double rounding = 0x1p-48;

struct Triangle3 {
  dvec3 v[3];
  dvec3 normal;
  double tau = 0;
};

Triangle3 triangle_in_double(const TriangleView& triangles, std::uint32_t id) {
  const Corners c = corners_of(triangles, id);
  Triangle3 r;
  for (int k = 0; k < 3; ++k) r.v[k] = c.v[k];
  r.normal = glm::cross(r.v[1] - r.v[0], r.v[2] - r.v[0]);
  r.tau = rounding_tolerance(c.v);
  return r;
}

double sum_of(const dvec3& v) {
  return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

// {n.ex, n.ey, n.from} : the line where the plane through `from` (seen from the light's origin) meets the
// light.
dvec3 trace_of(const LightFrame& light, const dvec3& n, const dvec3& to_origin) {
  return {glm::dot(n, light.ex), glm::dot(n, light.ey), glm::dot(n, to_origin)};
}

MovingLine edge_line(const LightFrame& light, const dvec3& centre, const dvec3& a, const dvec3& b,
                     double sign) {
  const dvec3 d = b - a, n = glm::cross(a - centre, d);
  const dvec3 to_origin = light.origin - a;
  MovingLine line;
  line.c[0] = sign * trace_of(light, n, to_origin);
  const dvec3 du = glm::cross(d, light.ex), dv = glm::cross(d, light.ey), dw = glm::cross(d, to_origin);
  for (int k = 0; k < 3; ++k) line.c[k + 1] = -sign * dvec3(du[k], dv[k], dw[k]);
  return line;
}

enum class Side { negative, mixed, positive };

// Which side all of the light lies on for all points of the group. Theorem 1 of Mora et al. 2012: the values
// at the light's vertices and the box's corners decide (each value is affine in the point).
Side side_of(const MovingLine& line, const LightFrame& light, const dvec3& half) {
  bool positive = true, negative = true;
  for (const dvec2& at : light.outline) {
    double spread = 0, size = sum_of(line.c[0]);
    const dvec3 vertex(at, 1.0);
    for (int k = 0; k < 3; ++k) {
      spread += std::abs(glm::dot(line.c[k + 1], vertex)) * half[k];
      size += sum_of(line.c[k + 1]) * half[k];
    }
    const double value = glm::dot(line.c[0], vertex);
    const double margin = spread + rounding * size;
    positive &= value > margin;
    negative &= value < -margin;
  }
  return positive ? Side::positive : negative ? Side::negative : Side::mixed;
}

// Largest coefficient over the group's box, at most.
double size_of(const MovingLine& line, const dvec3& half) {
  double size = sum_of(line.c[0]);
  for (int k = 0; k < 3; ++k) size += sum_of(line.c[k + 1]) * half[k];
  return size;
}

void add_line(MovingLine line, const EdgePlane& plane, const dvec3& half, GroupOccluders& out) {
  const double size = size_of(line, half);
  for (dvec3& c : line.c) c /= size > 0 ? size : 1.0;
  out.lines.push_back(line);
  out.planes.push_back(plane);
}

// On which sides of an occluder's plane the group and the light lie.
struct PlaneSides {
  int points =
      0;  // +1, -1: all points lie beyond the contact threshold on this side of the normal; 0: not all
  Side light = Side::mixed;
  bool never = false;  // no point lies beyond the threshold on any side
};

PlaneSides plane_sides(const Triangle3& t, const LightFrame& light, const GroupFrame& group) {
  const dvec3 from = group.centre - t.v[0];
  const double height = glm::dot(t.normal, from);
  const double length = std::sqrt(glm::dot(t.normal, t.normal));
  const double spread = std::abs(t.normal.x) * group.half.x + std::abs(t.normal.y) * group.half.y +
                        std::abs(t.normal.z) * group.half.z;
  const double margin = rounding * (length * (sum_of(group.centre) + sum_of(t.v[0]) + sum_of(group.half)));
  const double threshold = (t.tau + group.receiver_tau) * length;
  PlaneSides sides;
  if (std::abs(height) - spread > threshold + margin) sides.points = height > 0 ? 1 : -1;
  sides.never = !(length > 0) || std::abs(height) + spread < t.tau * length - margin;
  bool positive = true, negative = true;
  for (const dvec2& at : light.outline) {
    const dvec3 vertex = light.point(at);
    const double value = glm::dot(t.normal, vertex - t.v[0]);
    const double slack = rounding * length * (sum_of(vertex) + sum_of(t.v[0]));
    positive &= value > slack;
    negative &= value < -slack;
  }
  sides.light = positive ? Side::positive : negative ? Side::negative : Side::mixed;
  return sides;
}

bool contains(std::span<const std::uint32_t> list, std::uint32_t id) {
  return std::find(list.begin(), list.end(), id) != list.end();
}

int size_class(const Triangle3& t, const dvec3& centre) {
  const dvec3 middle = (t.v[0] + t.v[1] + t.v[2]) / 3.0 - centre;
  const double distance = std::sqrt(glm::dot(middle, middle));
  const double volume = std::abs(glm::dot(t.normal, t.v[0] - centre));
  const double solid_angle = distance > 0 ? volume / (distance * distance * distance) : 0.0;
  return solid_angle > 0 ? std::ilogb(solid_angle) : -5000;
}

MovingLine plane_line(const Triangle3& t, const LightFrame& light, double sign) {
  MovingLine line{};
  line.c[0] = sign * trace_of(light, t.normal, light.origin - t.v[0]);
  return line;
}

EdgePlane edge_plane(const Triangle3& t, int edge, const dvec3& centre, double sign) {
  const dvec3 a = t.v[edge] - centre, along = sign * (t.v[(edge + 1) % 3] - t.v[edge]);
  return {a, along, glm::cross(a, along)};
}

// Adds the lines of a definite occluder; false if it does not block.
bool add_definite(const Triangle3& t, const LightFrame& light, const GroupFrame& group,
                  const PlaneSides& sides, GroupOccluders& out) {
  const double sign = -sides.points;
  for (int k = 0; k < 3; ++k) {
    const MovingLine line = edge_line(light, group.centre, t.v[k], t.v[(k + 1) % 3], sign);
    const Side side = side_of(line, light, group.half);
    if (side == Side::negative) return false;
    if (side == Side::mixed) add_line(line, edge_plane(t, k, group.centre, sign), group.half, out);
  }
  if (sides.light == Side::mixed) add_line(plane_line(t, light, sign), {}, group.half, out);
  return true;
}

void add_indefinite(const Triangle3& t, const LightFrame& light, const GroupFrame& group,
                    GroupOccluders& out) {
  for (int k = 0; k < 3; ++k) {
    add_line(edge_line(light, group.centre, t.v[k], t.v[(k + 1) % 3], 1), {}, group.half, out);
  }
  add_line(plane_line(t, light, 1), {}, group.half, out);
  const double length = std::sqrt(glm::dot(t.normal, t.normal));
  out.heights.push_back({glm::dot(t.normal, group.centre - t.v[0]), t.normal, t.tau * length, length});
}

void add_corners(const Triangle3& t, const LightFrame& light, const GroupFrame& group, GroupOccluders& out) {
  for (const dvec3& v : t.v) out.corners.push_back(light_coordinates(light, group.centre, v));
}

bool larger(const Occluder& a, const Occluder& b) {
  return comes_before(a.size, a.triangle, b.size, b.triangle);
}

}  // namespace

void set_up_occluders(const LightFrame& light, const TriangleView& triangles, const GroupFrame& group,
                      std::span<const std::uint32_t> candidates, GroupOccluders& out) {
  out.occluders.clear();
  out.indefinite.clear();
  out.heights.clear();
  out.corners.clear();
  out.lines.clear();
  out.planes.clear();
  for (const std::uint32_t id : candidates) {
    const Triangle3 t = triangle_in_double(triangles, id);
    const PlaneSides sides = plane_sides(t, light, group);
    if (sides.never) continue;
    const auto first = static_cast<std::uint32_t>(out.lines.size());
    const auto corner = static_cast<std::uint32_t>(out.corners.size());
    const Occluder occluder{id, first, 4, corner, size_class(t, group.centre)};
    if (sides.points == 0 || contains(group.receivers, id)) {
      add_indefinite(t, light, group, out);
      out.indefinite.push_back(occluder);
      add_corners(t, light, group, out);
      continue;
    }
    if (sides.light == (sides.points > 0 ? Side::positive : Side::negative)) continue;
    if (add_definite(t, light, group, sides, out)) {
      out.occluders.push_back(occluder);
      add_corners(t, light, group, out);
      out.occluders.back().line_count = static_cast<std::uint32_t>(out.lines.size()) - first;
    } else {
      out.lines.resize(first);
      out.planes.resize(first);
    }
  }
  std::sort(out.occluders.begin(), out.occluders.end(), larger);
}

dvec3 light_coordinates(const LightFrame& light, const dvec3& group_centre, const dvec3& place) {
  const dvec3 from = place - light.origin;
  const double square = glm::dot(light.ex, light.ex);
  return {glm::dot(from, light.ex) / square, glm::dot(from, light.ey) / square,
          glm::dot(group_centre - place, light.normal)};
}

dvec3 horizon_line(const LightFrame& light, const TriangleView& triangles, std::uint32_t receiver,
                   int seen_side) {
  const Triangle3 t = triangle_in_double(triangles, receiver);
  return static_cast<double>(seen_side) * trace_of(light, t.normal, light.origin - t.v[0]);
}

}  // namespace tenebra
