// Shading normals at visible points: those of the vertices, interpolated linearly over the triangle, in
// double.
#include <cmath>

#include <tenebra/visible_points.h>
#include "parallel/parallel.h"
#include "points/positions.h"
#include "points/triangle_corners.h"

namespace tenebra {

namespace {

using glm::dvec3;
using glm::vec3;

// Weights of the second and third vertex for point p: w = g.(p - a).
struct Weights {
  dvec3 a{0.0}, normal{0.0}, du{0.0}, dv{0.0};
  bool flat = true;  // no area in double
};

Weights weights_of(const points::Corners& c) {
  Weights w;
  w.a = c.v[0];
  const dvec3 e1 = dvec3(c.v[1]) - w.a, e2 = dvec3(c.v[2]) - w.a;
  w.normal = glm::cross(e1, e2);
  const double area2 = glm::dot(w.normal, w.normal);
  w.flat = !(area2 > 0);
  if (w.flat) return w;
  w.du = glm::cross(e2, w.normal) / area2;
  w.dv = glm::cross(w.normal, e1) / area2;
  return w;
}

vec3 unit_or_zero(const dvec3& v) {
  const double length = std::sqrt(glm::dot(v, v));
  return length > 0 && std::isfinite(length) ? vec3(v / length) : vec3(0.0f);
}

/// The side of the triangle that a point is on, by its face normal: in double, as seen from the point itself.
class FaceSide {
public:
  explicit FaceSide(const VisiblePoints& points)
      : points_(points), view_(points::ViewOfSamples::of(points.seen_from)) {}
  bool behind(const dvec3& normal, const dvec3& p, std::size_t i) const {
    if (!points_.sides.empty() || view_ == nullptr) return !points_.sides.empty() && points_.sides[i] < 0;
    return glm::dot(normal, view_->orthographic ? -dvec3(view_->d0) : dvec3(view_->eye) - p) < 0;
  }

private:
  const VisiblePoints& points_;
  const ViewRays* view_;
};

}  // namespace

void compute_shading_normals(const VisiblePoints& points, std::span<const glm::vec3> normals,
                             const TriangleView& triangles, std::vector<glm::vec3>& out) {
  const parallel::FloatEnvironment ieee;
  VisiblePoints made;
  const std::vector<dvec3>& positions = points::with_positions(points, triangles, made).positions;
  const FaceSide side(points);
  out.resize(positions.size());
  parallel::parallel_ranges(out.size(), 4096, [&](std::size_t first, std::size_t last) {
    std::uint32_t known = no_triangle;
    Weights w;
    for (std::size_t i = first; i < last; ++i) {
      const std::uint32_t id = points.triangles[i];
      out[i] = vec3(0.0f);
      if (id == no_triangle) continue;
      if (id != known) w = weights_of(points::corners_of(triangles, id));
      known = id;
      if (w.flat) continue;
      const dvec3 p = positions[i];
      const dvec3 face = side.behind(w.normal, p, i) ? -w.normal : w.normal;
      dvec3 n = face;
      if (!normals.empty()) {
        const glm::uvec3 t = triangles.triangles[id];
        const double u = glm::dot(w.du, p - w.a), v = glm::dot(w.dv, p - w.a);
        n = (1 - u - v) * dvec3(normals[t.x]) + u * dvec3(normals[t.y]) + v * dvec3(normals[t.z]);
        const double side = glm::dot(n, face);
        if (side < 0) n = -n;
        if (!(glm::dot(n, n) > 1e-12) || !std::isfinite(side)) n = face;
      }
      out[i] = unit_or_zero(n);
    }
  });
}

}  // namespace tenebra
