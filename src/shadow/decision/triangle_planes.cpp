#include "shadow/decision/triangle_planes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/predicates.h"
#include "parallel/parallel.h"
#include "points/contact_rule.h"
#include "points/triangle_corners.h"
#include "shadow/decision/lifted_points.h"

namespace tenebra::shadow {

namespace {

using glm::dvec3;
using glm::vec3;

constexpr std::size_t triangles_a_range = 2048;

float round_up(double x) {
  return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity());
}
float round_down(double x) {
  return std::nextafter(static_cast<float>(x), -std::numeric_limits<float>::infinity());
}

bool lexicographically_less(const vec3& a, const vec3& b) {
  if (a.x != b.x) return a.x < b.x;
  if (a.y != b.y) return a.y < b.y;
  return a.z < b.z;
}

void set_plane(TrianglePlanes& t, int k, const dvec3& m, double d, double rho) {
  t.mx[k] = m.x;
  t.my[k] = m.y;
  t.mz[k] = m.z;
  t.d[k] = d;
  t.rho[k] = rho;
}

// Plane through the light and the edge a-b. The ends are taken in canonical order so that triangles that
// share the edge get the same bits. rho: A x (B - A) has an error of 4 sqrt(3) v |a||e|; with the
// normalisation and the evaluation 18 v |a||e| / |m| < 2^-48 |a||e| / |m| (v = 2^-53). An edge that points at
// the light has rho = inf. Where positions are relative to another point than the light, the plane goes
// through a: its normal is off by 11 v |a||e| / |m| with a relative to the light, hence m.(p - a) by that
// much of |p - a|, d = m.a and m.p by 5 v |a| and 5 v |p| more: the same rho, times |p| + reach.
void set_edge(TrianglePlanes& t, int k, vec3 a, vec3 b, const RaySource& source, double side) {
  if (!lexicographically_less(a, b)) {
    std::swap(a, b);
    side = -side;
  }
  const dvec3 edge = dvec3(b) - dvec3(a);
  const dvec3 from = dvec3(a) - source.origin;
  const dvec3 other = source.directional ? dvec3(source.light)
                      : source.distant   ? dvec3(a) - dvec3(source.light)
                                         : from;
  const dvec3 m = source.directional ? glm::cross(edge, other) : glm::cross(other, edge);
  const double length = std::sqrt(glm::dot(m, m));
  if (!(length > 0)) {
    set_plane(t, k, dvec3(0), 0, std::numeric_limits<double>::infinity());
    return;
  }
  const dvec3 unit = m * (side / length);
  const double rho = 0x1p-48 * std::sqrt(glm::dot(other, other)) * std::sqrt(glm::dot(edge, edge)) / length;
  set_plane(t, k, unit, source.directional || source.distant ? glm::dot(unit, from) : 0.0, rho);
}

void set_own_plane(TrianglePlanes& t, const vec3 v[3], const dvec3& origin, double tau) {
  const dvec3 e1 = dvec3(v[1]) - dvec3(v[0]), e2 = dvec3(v[2]) - dvec3(v[0]);
  const dvec3 n = glm::cross(e1, e2);
  const double length = std::sqrt(glm::dot(n, n));
  if (!(length > 0)) {
    set_plane(t, 3, dvec3(0), 0, std::numeric_limits<double>::infinity());
    return;
  }
  const dvec3 unit = n * (t.side / length);
  const double rho = 0x1p-48 * std::sqrt(glm::dot(e1, e1)) * std::sqrt(glm::dot(e2, e2)) / length;
  set_plane(t, 3, unit, glm::dot(unit, dvec3(v[0]) - origin) + tau, rho);
}

/// Around a triangle's corners; rounded up.
struct Sphere {
  dvec3 centre;
  double radius;
};

Sphere sphere_around(const vec3 v[3], const dvec3& centre) {
  double radius = 0;
  for (int k = 0; k < 3; ++k) radius = std::max(radius, glm::length(dvec3(v[k]) - centre));
  return {centre, radius * (1 + 0x1p-40)};
}

/// The smallest, up to rounding: over the longest edge of an obtuse triangle, else through the corners. Of
/// both centres the one nearer to its farthest corner, so a circumcentre that is lost in rounding does no
/// harm.
Sphere smallest_sphere(const vec3 v[3]) {
  dvec3 middle(0);
  double longest = -1;
  for (int k = 0; k < 3; ++k) {
    const dvec3 p = v[k], q = v[(k + 1) % 3];
    const double length2 = glm::dot(p - q, p - q);
    if (length2 > longest) longest = length2, middle = 0.5 * (p + q);
  }
  const Sphere over_edge = sphere_around(v, middle);
  const dvec3 a = v[0], b = dvec3(v[1]) - a, c = dvec3(v[2]) - a, n = glm::cross(b, c);
  if (!(glm::dot(n, n) > 0)) return over_edge;
  const dvec3 from_a = glm::dot(c, c) * glm::cross(n, b) + glm::dot(b, b) * glm::cross(c, n);
  const Sphere through_corners = sphere_around(v, a + from_a / (2 * glm::dot(n, n)));
  return through_corners.radius < over_edge.radius ? through_corners : over_edge;
}

void set_sphere(TriangleBounds& b, const vec3 v[3], const RaySource& source) {
  const auto [centre, radius] = smallest_sphere(v);
  const dvec3 c = centre - source.origin;
  if (source.directional) {
    const double height = glm::dot(c, source.travel);
    const vec3 across = c - height * source.travel;
    b.sx = across.x, b.sy = across.y, b.sz = across.z;
    b.sphere_chord = round_up(radius);
    b.sphere_near = round_down(height - radius);
    return;
  }
  const double distance = glm::length(c);
  const vec3 direction = distance > 0 ? c / distance : dvec3(0);
  b.sx = direction.x, b.sy = direction.y, b.sz = direction.z;
  const double sine = distance > 0 ? radius / distance : 2.0;
  // Half-angle asin(sine) of the cap; its chord is 2 sin(half of it) = sqrt(2 (1 - cos)).
  b.sphere_chord =
      sine < 1 ? round_up(std::sqrt(2.0) * sine / std::sqrt(1 + std::sqrt(1 - sine * sine)) * (1 + 0x1p-40))
               : 2.0f;
  b.sphere_near = round_down(std::max(0.0, distance - radius) * (1 - 0x1p-40));
}

void set_corners(TriangleBounds& b, const vec3 v[3], const RaySource& source) {
  for (int k = 0; k < 3; ++k) {
    const dvec3 p = dvec3(v[k]) - source.origin;
    const vec3 corner = source.directional ? vec3(p - glm::dot(p, source.travel) * source.travel)
                                           : vec3(p / std::sqrt(glm::dot(p, p)));
    b.cx[k] = corner.x, b.cy[k] = corner.y, b.cz[k] = corner.z;
  }
}

float blocker_extent(const vec3 v[3], const RaySource& source) {
  const dvec3 n = glm::cross(dvec3(v[1]) - dvec3(v[0]), dvec3(v[2]) - dvec3(v[0]));
  if (source.directional) return static_cast<float>(0.5 * std::abs(glm::dot(n, source.travel)));
  const dvec3 centre = (dvec3(v[0]) + dvec3(v[1]) + dvec3(v[2])) / 3.0 - source.origin;
  const double distance = glm::length(centre);
  return static_cast<float>(0.5 * std::abs(glm::dot(n, centre)) /
                            std::max(1e-300, distance * distance * distance));
}

TriangleBounds bounds_of(const TrianglePlanes& t, const vec3 v[3], const RaySource& source) {
  TriangleBounds b{};
  for (int k = 0; k < 4; ++k) {
    b.mx[k] = static_cast<float>(t.mx[k]);
    b.my[k] = static_cast<float>(t.my[k]);
    b.mz[k] = static_cast<float>(t.mz[k]);
    b.d[k] = static_cast<float>(t.d[k]);
  }
  b.rho = round_up(std::max({t.rho[0], t.rho[1], t.rho[2], t.rho[3]}));
  b.climb =
      static_cast<float>(t.mx[3] * source.travel.x + t.my[3] * source.travel.y + t.mz[3] * source.travel.z);
  set_corners(b, v, source);
  set_sphere(b, v, source);
  return b;
}

}  // namespace

int light_side(const vec3 v[3], const RaySource& source) {
  return source.directional ? -math::direction_side(v[0], v[1], v[2], source.light)
                            : -math::point_side(v[0], v[1], v[2], source.light);
}

TrianglePlanes planes_of(const vec3 v[3], std::uint32_t id, int side, const RaySource& source, double tau) {
  TrianglePlanes t{};
  t.triangle = id;
  t.side = side;
  for (int k = 0; k < 3; ++k) set_edge(t, k, v[k], v[(k + 1) % 3], source, side);
  set_own_plane(t, v, source.origin, tau);
  for (int k = 0; k < 3; ++k) t.reach = std::max(t.reach, glm::length(dvec3(v[k]) - source.origin));
  return t;
}

RaySource ray_source(const ShadowLight& light) {
  RaySource source;
  source.directional = light.directional;
  source.light = light.directional ? light.to_light : light.position;
  if (light.directional) {
    source.travel = -glm::normalize(dvec3(light.to_light));
  } else {
    source.origin = light.position;
  }
  return source;
}

void build_triangle_set(const TriangleView& triangles, const RaySource& source,
                        const HardShadowConfig& config, TriangleSet& out) {
  const std::size_t count = triangles.triangles.size();
  const bool use_tau = config.contact == ContactRule::triangle_ids;
  out.facing.resize(count);
  out.tau.resize(count);
  out.planes.resize(count);
  out.bounds.resize(count);
  out.extent.resize(count);
  out.chunk_counts.assign(2 * ((count + triangles_a_range - 1) / triangles_a_range), 0);

  // Each range packs its casters at its own start; the ranges are then closed up.
  parallel::parallel_ranges(count, triangles_a_range, [&](std::size_t first, std::size_t last) {
    std::size_t kept = first;
    std::uint32_t degenerate = 0;
    for (std::size_t id = first; id < last; ++id) {
      const points::Corners c = points::corners_of(triangles, id);
      const int side = light_side(c.v, source);
      const double tau = use_tau ? points::rounding_tolerance(c.v) : 0.0;
      out.tau[id] = round_up(tau);
      const auto faces_from = [&](int own) {
        if (side == -own) return static_cast<unsigned>(Faces::light);
        return use_tau ? static_cast<unsigned>(
                             faces_beyond(triangles, static_cast<std::uint32_t>(id), own, source))
                       : 0u;
      };
      out.facing[id] = static_cast<std::uint8_t>(faces_from(1) | faces_from(-1) << 2);
      if (!triangles.casts_shadow.empty() && triangles.casts_shadow[id] == 0) continue;
      degenerate += side == 0;
      if (side == 0 || (config.cull_front && side < 0)) continue;
      out.planes[kept] = planes_of(c.v, static_cast<std::uint32_t>(id), side, source, tau);
      out.bounds[kept] = bounds_of(out.planes[kept], c.v, source);
      out.extent[kept] = blocker_extent(c.v, source);
      ++kept;
    }
    out.chunk_counts[2 * (first / triangles_a_range)] = static_cast<std::uint32_t>(kept - first);
    out.chunk_counts[2 * (first / triangles_a_range) + 1] = degenerate;
  });

  std::size_t kept = 0;
  out.degenerate = 0;
  for (std::size_t chunk = 0; chunk < out.chunk_counts.size() / 2; ++chunk) {
    const std::size_t first = chunk * triangles_a_range, size = out.chunk_counts[2 * chunk];
    if (first != kept) {
      std::copy_n(out.planes.begin() + first, size, out.planes.begin() + kept);
      std::copy_n(out.bounds.begin() + first, size, out.bounds.begin() + kept);
      std::copy_n(out.extent.begin() + first, size, out.extent.begin() + kept);
    }
    kept += size;
    out.degenerate += out.chunk_counts[2 * chunk + 1];
  }
  out.planes.resize(kept);
  out.bounds.resize(kept);
  out.extent.resize(kept);
  out.casting = triangles.casts_shadow.empty()
                    ? count
                    : static_cast<std::uint64_t>(
                          std::count_if(triangles.casts_shadow.begin(), triangles.casts_shadow.end(),
                                        [](std::uint8_t casts) { return casts != 0; }));
}

}  // namespace tenebra::shadow
