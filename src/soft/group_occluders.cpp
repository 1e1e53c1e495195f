#include "soft/group_occluders.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "points/contact_rule.h"
#include "points/triangle_corners.h"

namespace tenebra {

namespace {

using glm::dvec2;
using glm::dvec3;

// Rounding of the sums of products below, relative to the sum of their magnitudes: fewer than 16 operations
// on inputs that carry one rounding each.
constexpr double rounding = 0x1p-48;

struct Corner3 {
  dvec3 v[3];
  dvec3 normal;
  double tau = 0;
};

Corner3 corners_in_double(const TriangleView& triangles, std::uint32_t id) {
  const Corners c = corners_of(triangles, id);
  Corner3 r;
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

struct WideLine {
  dvec3 c[4];  // at the centre, and its change with x, y, z
};

WideLine edge_line(const LightFrame& light, const dvec3& centre, const dvec3& a, const dvec3& b,
                   double sign) {
  const dvec3 d = b - a, n = glm::cross(a - centre, d);
  const dvec3 to_origin = light.origin - a;
  WideLine line;
  line.c[0] = sign * trace_of(light, n, to_origin);
  const dvec3 du = glm::cross(d, light.ex), dv = glm::cross(d, light.ey), dw = glm::cross(d, to_origin);
  for (int k = 0; k < 3; ++k) line.c[k + 1] = -sign * dvec3(du[k], dv[k], dw[k]);
  return line;
}

enum class Side { negative, mixed, positive };

// Which side all of the light lies on for all points of the group. Theorem 1 of Mora et al. 2012: the values
// at the light's vertices and the box's corners decide (each value is affine in the point).
Side side_of(const WideLine& line, const LightFrame& light, const dvec3& half) {
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

// How much the rounding of the coefficients moves the line, in units of the light, over their own rounding.
double condition_of(const WideLine& line, const dvec3& half) {
  double size = sum_of(line.c[0]);
  double slope = std::abs(line.c[0].x) + std::abs(line.c[0].y);
  for (int k = 0; k < 3; ++k) {
    size += sum_of(line.c[k + 1]) * half[k];
    slope -= (std::abs(line.c[k + 1].x) + std::abs(line.c[k + 1].y)) * half[k];
  }
  return slope > 0 ? size / slope : std::numeric_limits<double>::infinity();
}

template <class T>
MovingLine<T> narrow(const WideLine& line, const dvec3& half) {
  double size = sum_of(line.c[0]);
  for (int k = 0; k < 3; ++k) size += sum_of(line.c[k + 1]) * half[k];
  const double scale = size > 0 ? 1 / size : 1.0;
  MovingLine<T> result{};
  for (int k = 0; k < 4; ++k) {
    for (int i = 0; i < 3; ++i) result.c[k][i] = static_cast<T>(scale * line.c[k][i]);
  }
  return result;
}

// On which sides of an occluder's plane the group and the light lie.
struct PlaneSides {
  int points =
      0;  // +1, -1: all points lie beyond the contact threshold on this side of the normal; 0: not all
  Side light = Side::mixed;
  bool never = false;  // no point lies beyond the threshold on any side
};

PlaneSides plane_sides(const Corner3& t, const LightFrame& light, const GroupFrame& group) {
  const dvec3 from = group.centre - t.v[0];
  const double height = glm::dot(t.normal, from);
  const double length = std::sqrt(glm::dot(t.normal, t.normal));
  const double spread = std::abs(t.normal.x) * group.half.x + std::abs(t.normal.y) * group.half.y +
                        std::abs(t.normal.z) * group.half.z;
  const double margin = rounding * (length * (sum_of(group.centre) + sum_of(t.v[0]) + sum_of(group.half)));
  const double threshold = (t.tau + group.receiver_tau) * length;
  PlaneSides sides;
  if (std::abs(height) - spread > threshold + margin) sides.points = height > 0 ? 1 : -1;
  sides.never = std::abs(height) + spread < t.tau * length - margin;
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

double solid_angle(const Corner3& t, const dvec3& centre) {
  const dvec3 middle = (t.v[0] + t.v[1] + t.v[2]) / 3.0 - centre;
  const double distance = std::sqrt(glm::dot(middle, middle));
  const double volume = std::abs(glm::dot(t.normal, t.v[0] - centre));
  return distance > 0 ? volume / (distance * distance * distance) : 0.0;
}

// Adds the lines of a definite occluder; false if it does not block.
template <class T>
bool add_lines(const Corner3& t, const LightFrame& light, const GroupFrame& group, const PlaneSides& sides,
               GroupOccluders<T>& out) {
  const double sign = -sides.points;
  for (int k = 0; k < 3; ++k) {
    const WideLine line = edge_line(light, group.centre, t.v[k], t.v[(k + 1) % 3], sign);
    const Side side = side_of(line, light, group.half);
    if (side == Side::negative) return false;
    if (side == Side::positive) continue;
    out.condition = std::max(out.condition, condition_of(line, group.half));
    out.lines.push_back(narrow<T>(line, group.half));
    const dvec3 a = t.v[k] - group.centre, along = sign * (t.v[(k + 1) % 3] - t.v[k]);
    out.planes.push_back({a, along, glm::cross(a, along)});
  }
  if (sides.light == Side::mixed) {
    WideLine plane{};
    plane.c[0] = sign * trace_of(light, t.normal, light.origin - t.v[0]);
    out.condition = std::max(out.condition, condition_of(plane, group.half));
    out.lines.push_back(narrow<T>(plane, group.half));
    out.planes.push_back({});
  }
  return true;
}

}  // namespace

template <class T>
void set_up_occluders(const LightFrame& light, const TriangleView& triangles, const GroupFrame& group,
                      std::span<const std::uint32_t> candidates, GroupOccluders<T>& out) {
  out.occluders.clear();
  out.lines.clear();
  out.planes.clear();
  out.indefinite.clear();
  out.condition = 0;
  for (const std::uint32_t id : candidates) {
    const Corner3 t = corners_in_double(triangles, id);
    const PlaneSides sides = plane_sides(t, light, group);
    if (sides.never) continue;
    if (sides.points == 0 || contains(group.receivers, id)) {
      out.indefinite.push_back(id);
      continue;
    }
    if (sides.light == (sides.points > 0 ? Side::positive : Side::negative)) continue;
    const auto first = static_cast<std::uint32_t>(out.lines.size());
    if (!add_lines(t, light, group, sides, out)) {
      out.lines.resize(first);
      out.planes.resize(first);
      continue;
    }
    out.occluders.push_back(
        {id, first, static_cast<std::uint32_t>(out.lines.size()) - first, solid_angle(t, group.centre)});
  }
  std::sort(out.occluders.begin(), out.occluders.end(), [](const Occluder& a, const Occluder& b) {
    return a.size != b.size ? a.size > b.size : a.triangle < b.triangle;
  });
}

int occluder_lines_at(const LightFrame& light, const TriangleView& triangles, std::uint32_t occluder,
                      const dvec3& point, std::uint32_t receiver, double receiver_tau, dvec3 lines[4]) {
  if (occluder == receiver) return 0;
  const Corner3 t = corners_in_double(triangles, occluder);
  const double height = glm::dot(t.normal, point - t.v[0]);
  const double threshold = contact_threshold(corners_of(triangles, occluder).v, t.tau, receiver_tau);
  if (!(std::abs(height) > threshold)) return 0;
  const double sign = height > 0 ? -1 : 1;
  for (int k = 0; k < 3; ++k) {
    const dvec3 &a = t.v[k], &b = t.v[(k + 1) % 3];
    lines[k] = sign * trace_of(light, glm::cross(a - point, b - a), light.origin - a);
  }
  lines[3] = sign * trace_of(light, t.normal, light.origin - t.v[0]);
  return 4;
}

dvec3 horizon_line(const LightFrame& light, const TriangleView& triangles, std::uint32_t receiver,
                   int seen_side) {
  const Corner3 t = corners_in_double(triangles, receiver);
  return static_cast<double>(seen_side) * trace_of(light, t.normal, light.origin - t.v[0]);
}

template void set_up_occluders<float>(const LightFrame&, const TriangleView&, const GroupFrame&,
                                      std::span<const std::uint32_t>, GroupOccluders<float>&);
template void set_up_occluders<double>(const LightFrame&, const TriangleView&, const GroupFrame&,
                                       std::span<const std::uint32_t>, GroupOccluders<double>&);

}  // namespace tenebra
