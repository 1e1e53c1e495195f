#include "soft/group_occluders.h"

#include <algorithm>
#include <cmath>

#include "soft/occluder_geometry.h"

namespace tenebra {

namespace {

using glm::dvec3;

void add_line(MovingLine line, const EdgePlane& plane, const dvec3& half, GroupOccluders& out) {
  const double size = size_of(line, half);
  for (dvec3& c : line.c) c /= size > 0 ? size : 1.0;
  out.lines.push_back(line);
  out.planes.push_back(plane);
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

bool larger(const Occluder& a, const Occluder& b) {
  return comes_before(a.size, a.triangle, b.size, b.triangle);
}

}  // namespace

void set_up_occluders(const LightFrame& light, const TriangleView& triangles, const GroupFrame& group,
                      std::span<const std::uint32_t> candidates, GroupOccluders& out) {
  out.occluders.clear();
  out.indefinite.clear();
  out.lines.clear();
  out.planes.clear();
  for (const std::uint32_t id : candidates) {
    const Triangle3 t = triangle_in_double(triangles, id);
    const PlaneSides sides = plane_sides(t, light, group);
    if (sides.never) continue;
    const auto first = static_cast<std::uint32_t>(out.lines.size());
    if (sides.points == 0 || contains(group.receivers, id)) {
      out.indefinite.push_back(id);
      continue;
    }
    if (sides.light == (sides.points > 0 ? Side::positive : Side::negative)) continue;
    if (add_definite(t, light, group, sides, out)) {
      const auto count = static_cast<std::uint32_t>(out.lines.size()) - first;
      out.occluders.push_back({id, first, count, size_class(t, group.centre)});
    } else {
      out.lines.resize(first);
      out.planes.resize(first);
    }
  }
  std::sort(out.occluders.begin(), out.occluders.end(), larger);
}

dvec3 horizon_line(const LightFrame& light, const TriangleView& triangles, std::uint32_t receiver,
                   int seen_side) {
  const Triangle3 t = triangle_in_double(triangles, receiver);
  return static_cast<double>(seen_side) * trace_of(light, t.normal, light.origin - t.v[0]);
}

}  // namespace tenebra
