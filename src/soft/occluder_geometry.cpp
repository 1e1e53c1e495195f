#include "soft/occluder_geometry.h"

#include <cmath>

#include "points/contact_rule.h"
#include "points/triangle_corners.h"

namespace tenebra {

using glm::dvec2;
using glm::dvec3;

Triangle3 triangle_in_double(const TriangleView& triangles, std::uint32_t id) {
  const Corners c = corners_of(triangles, id);
  Triangle3 r;
  for (int k = 0; k < 3; ++k) r.v[k] = c.v[k];
  r.normal = glm::cross(r.v[1] - r.v[0], r.v[2] - r.v[0]);
  r.tau = rounding_tolerance(c.v);
  return r;
}

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

double size_of(const MovingLine& line, const dvec3& half) {
  double size = sum_of(line.c[0]);
  for (int k = 0; k < 3; ++k) size += sum_of(line.c[k + 1]) * half[k];
  return size;
}

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

PlaneHeight plane_height(const Triangle3& t, const GroupFrame& group) {
  const double length = std::sqrt(glm::dot(t.normal, t.normal));
  return {glm::dot(t.normal, group.centre - t.v[0]), t.normal, t.tau * length, length};
}

int size_class(const Triangle3& t, const dvec3& centre) {
  const dvec3 middle = (t.v[0] + t.v[1] + t.v[2]) / 3.0 - centre;
  const double distance = std::sqrt(glm::dot(middle, middle));
  const double volume = std::abs(glm::dot(t.normal, t.v[0] - centre));
  const double solid_angle = distance > 0 ? volume / (distance * distance * distance) : 0.0;
  return solid_angle > 0 ? std::ilogb(solid_angle) : -5000;
}

}  // namespace tenebra
