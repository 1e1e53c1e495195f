// A light's polygon is planar and convex "up to rounding": each vertex may lie tau = sqrt(3) 2^-24 M off its
// ideal place, M the largest |coordinate|. All bounds here follow from tau.
#include <tenebra/area_light.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/fail.h"
#include "math/vertex_rounding.h"
#include "soft/light/even_emission.h"

namespace tenebra {
namespace {

using glm::dvec2;
using glm::dvec3;
using glm::vec3;

constexpr std::size_t min_vertices = 3;
constexpr std::size_t max_vertices = 14;

// n corners at radius R enclose n/2 R^2 sin(2 pi / n): with n = 12, R^2 = pi/3 r^2.
constexpr double twelve_gon_radius = 1.0233267079464885;  // sqrt(pi / 3)
constexpr double root = 0.86602540378443865;
constexpr std::array<double, 12> twelfths{1,  root,  0.5,  0, -0.5, -root,
                                          -1, -root, -0.5, 0, 0.5,  root};  // cosines

dvec3 cross(const dvec3& a, const dvec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double cross(const dvec2& a, const dvec2& b) {
  return a.x * b.y - a.y * b.x;
}
double dot(const dvec3& a, const dvec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// tau; floats below 2^-126 lie as far apart as there.
double rounding_of(std::span<const vec3> vertices) {
  double largest = 0;
  for (const vec3& v : vertices)
    for (int axis = 0; axis < 3; ++axis) largest = std::max(largest, std::abs(static_cast<double>(v[axis])));
  return math::vertex_rounding * std::max(largest, 0x1p-126);
}

std::optional<std::size_t> first_infinite(std::span<const vec3> vertices) {
  for (std::size_t i = 0; i < vertices.size(); ++i)
    if (!std::isfinite(vertices[i].x) || !std::isfinite(vertices[i].y) || !std::isfinite(vertices[i].z))
      return i;
  return std::nullopt;
}

/// Newell's sum: length = area of the polygon. Displacing vertices by tau moves it by tau * perimeter at
/// most.
dvec3 area_vector(std::span<const vec3> vertices) {
  const dvec3 origin(vertices[0]);
  dvec3 sum(0.0);
  for (std::size_t i = 1; i + 1 < vertices.size(); ++i)
    sum += cross(dvec3(vertices[i]) - origin, dvec3(vertices[i + 1]) - origin);
  return 0.5 * sum;
}

double perimeter_of(std::span<const vec3> vertices) {
  double sum = 0;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const dvec3 edge = dvec3(vertices[(i + 1) % vertices.size()]) - dvec3(vertices[i]);
    sum += std::sqrt(dot(edge, edge));
  }
  return sum;
}

dvec3 mean_of(std::span<const vec3> vertices) {
  const dvec3 origin(vertices[0]);
  dvec3 sum(0.0);
  for (const vec3& v : vertices) sum += dvec3(v) - origin;
  return origin + sum / static_cast<double>(vertices.size());
}

/// Sets ex along the longest edge and ey to its left, as seen from the front.
void set_axes(AreaLight& light) {
  const std::size_t count = light.vertices.size();
  double longest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    dvec3 edge = dvec3(light.vertices[(i + 1) % count]) - dvec3(light.vertices[i]);
    edge -= light.normal * dot(light.normal, edge);
    const double length = std::sqrt(dot(edge, edge));
    if (length <= longest) continue;
    longest = length;
    light.ex = edge / length;
  }
  light.ey = cross(light.normal, light.ex);
}

double distance_to_segment(const dvec2& p, const dvec2& a, const dvec2& b) {
  const dvec2 edge = b - a;
  const double square = edge.x * edge.x + edge.y * edge.y;
  const double along = (p.x - a.x) * edge.x + (p.y - a.y) * edge.y;
  const double t = square > 0 ? std::clamp(along / square, 0.0, 1.0) : 0.0;
  const dvec2 off = p - (a + t * edge);
  return std::hypot(off.x, off.y);
}

/// Indices of the corners that are left when vertices on the straight line between their neighbours are
/// dropped. A line that bends by at most 2 tau counts as straight (a vertex and its neighbours may each be
/// off by tau). The bend is measured at all vertices between the two that stay, so that many small bends do
/// not add up.
std::vector<std::size_t> corners_of(const std::vector<dvec2>& points, double tolerance) {
  std::vector<std::size_t> kept(points.size());
  for (std::size_t i = 0; i < kept.size(); ++i) kept[i] = i;
  const auto straight = [&](std::size_t from, std::size_t to) {
    for (std::size_t i = (from + 1) % points.size(); i != to; i = (i + 1) % points.size())
      if (distance_to_segment(points[i], points[from], points[to]) > tolerance) return false;
    return true;
  };
  for (std::size_t k = 0; k < kept.size() && kept.size() > min_vertices;) {
    const std::size_t count = kept.size();
    if (straight(kept[(k + count - 1) % count], kept[(k + 1) % count]))
      kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(k));
    else
      ++k;
  }
  return kept;
}

struct Bend {
  std::size_t from, to;  ///< an edge
  std::size_t vertex;    ///< a corner that does not lie to its left
  double outside_m;
};

/// The corner that lies farthest outside an edge of others, of those not strictly to the left of one. None:
/// every edge lies on the hull, so the polygon is its own hull, walked round once.
std::optional<Bend> worst_bend(const std::vector<dvec2>& points, const std::vector<std::size_t>& corners) {
  std::optional<Bend> worst;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const std::size_t from = corners[k], to = corners[(k + 1) % corners.size()];
    const dvec2 edge = points[to] - points[from];
    const double length = std::hypot(edge.x, edge.y);
    for (const std::size_t vertex : corners) {
      if (vertex == from || vertex == to) continue;
      const double left = cross(edge, points[vertex] - points[from]);
      if (left > 0) continue;
      const double outside = length > 0 ? -left / length : 0.0;
      if (!worst || outside > worst->outside_m) worst = Bend{from, to, vertex, outside};
    }
  }
  return worst;
}

/// Moves the origin of `polygon` to its centroid and returns where that lay; sets the area.
dvec2 centre_polygon(std::vector<dvec2>& polygon, double& area) {
  const dvec2 origin = polygon[0];
  dvec2 moment(0.0);
  double doubled = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const dvec2 b = polygon[i] - origin, c = polygon[i + 1] - origin;
    const double part = cross(b, c);
    doubled += part;
    moment += part / 3 * (b + c);
  }
  area = 0.5 * doubled;
  const dvec2 centroid = origin + moment / doubled;
  for (dvec2& p : polygon) p -= centroid;
  return centroid;
}

/// Keeps the polygon's corners and derives everything that depends on them.
Expected<AreaLight> finish(AreaLight light, double tau) {
  std::vector<dvec2> points;
  for (const vec3& v : light.vertices)
    points.emplace_back(dot(dvec3(v) - light.centre, light.ex), dot(dvec3(v) - light.centre, light.ey));
  const std::vector<std::size_t> corners = corners_of(points, 2 * tau);
  if (const auto bend = worst_bend(points, corners))
    return base::fail(
        "area light: vertex {} lies {:.3g} m outside the edge from vertex {} to {}, expected a convex "
        "polygon "
        "that does not cross itself",
        bend->vertex, bend->outside_m, bend->from, bend->to);
  std::vector<vec3> vertices;
  for (const std::size_t i : corners) {
    vertices.push_back(light.vertices[i]);
    light.polygon.push_back(points[i]);
  }
  light.vertices = std::move(vertices);
  const dvec2 centroid = centre_polygon(light.polygon, light.area_m2);
  light.centre += centroid.x * light.ex + centroid.y * light.ey;
  return light;
}

}  // namespace

// Planarity. Let every vertex lie within tau of an ideal plane, c be the mean of the vertices, A the length
// of Newell's sum and n its unit vector. With heights h_j over the ideal plane, vertex i lies h_i - mean(h) -
// dn.(v_i - c) / A off the plane through c with normal n, where dn = 1/2 sum h_j n x (v_j+1 - v_j-1). So
// |dn.(v_i - c)| <= tau sum |e_j x (v_i - c)| over the edges e_j = 2 tau w |v_i - c|, w the width of the
// polygon across v_i - c. A convex polygon contains c, a chord through it along v_i - c, and a point on
// either side of the chord, w apart: A >= w |v_i - c| / 2. Hence at most (1 + 1 + 4) tau.
Expected<AreaLight> make_area_light(std::span<const vec3> vertices) {
  if (vertices.size() < min_vertices || vertices.size() > max_vertices)
    return base::fail("area light: found a polygon of {} vertices, expected {} to {}", vertices.size(),
                      min_vertices, max_vertices);
  if (const auto i = first_infinite(vertices))
    return base::fail("area light: vertex {} is ({}, {}, {}), expected finite coordinates", *i,
                      vertices[*i].x, vertices[*i].y, vertices[*i].z);
  const double tau = rounding_of(vertices);
  const dvec3 n = area_vector(vertices);
  const double area = std::sqrt(dot(n, n)), least = tau * perimeter_of(vertices);
  if (!(area > least))
    return base::fail(
        "area light: the polygon encloses {:.3g} m2, expected more than {:.3g} m2, which its rounded "
        "coordinates leave uncertain",
        area, least);
  AreaLight light;
  light.vertices.assign(vertices.begin(), vertices.end());
  light.normal = n / area;
  light.centre = mean_of(vertices);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const double off = std::abs(dot(light.normal, dvec3(vertices[i]) - light.centre));
    if (off > 6 * tau)
      return base::fail(
          "area light: vertex {} lies {:.3g} m off the plane of the polygon, expected at most {:.3g} m (the "
          "rounding of its coordinates)",
          i, off, 6 * tau);
  }
  set_axes(light);
  return finish(std::move(light), tau);
}

Expected<AreaLight> make_rectangle_light(vec3 centre, vec3 half_x, vec3 half_y) {
  const dvec3 c(centre), x(half_x), y(half_y);
  const std::array<vec3, 4> corners{vec3(c - x - y), vec3(c + x - y), vec3(c + x + y), vec3(c - x + y)};
  return make_area_light(corners);
}

Expected<AreaLight> make_disc_light(vec3 centre, vec3 half_x, vec3 half_y) {
  std::array<vec3, 12> corners;
  for (std::size_t i = 0; i < corners.size(); ++i)
    corners[i] = vec3(dvec3(centre) + twelve_gon_radius * (twelfths[i] * dvec3(half_x) +
                                                           twelfths[(i + 9) % 12] * dvec3(half_y)));
  return make_area_light(corners);
}

Expected<AreaLight> make_sun(vec3 to_sun, double diameter_deg) {
  if (!std::isfinite(to_sun.x) || !std::isfinite(to_sun.y) || !std::isfinite(to_sun.z) || to_sun == vec3(0))
    return base::fail("sun: found the direction ({}, {}, {}), expected finite coordinates, not all zero",
                      to_sun.x, to_sun.y, to_sun.z);
  // The sum over the edges is off by 1e-13 of their lengths: for smaller suns that is more than 1e-5 of the
  // light.
  constexpr double least = 1e-6;
  if (!(diameter_deg >= least && diameter_deg <= 90))
    return base::fail("sun: found a diameter of {} degrees, expected one from {} to 90", diameter_deg, least);
  AreaLight light;
  light.at_infinity = true;
  // Rounded to float: the last bits of a tangent are not the same on every machine.
  const double radius =
      static_cast<float>(twelve_gon_radius * std::tan(diameter_deg * (std::numbers::pi / 360)));
  for (std::size_t i = 0; i < twelfths.size(); ++i)
    light.polygon.emplace_back(radius * twelfths[i], radius * twelfths[(i + 9) % 12]);
  // The area is found with the sun along an axis: there the sum over the edges loses nothing, however small
  // they are.
  light.ey = {0, -1, 0}, light.centre = {0, 0, 1}, light.normal = -light.centre;
  light.area_m2 = soft::whole_irradiance(light, dvec3(0), light.centre);
  const dvec3 way(to_sun);
  light.centre = way / std::max({std::abs(way.x), std::abs(way.y), std::abs(way.z)});
  light.centre /= std::sqrt(dot(light.centre, light.centre));
  light.normal = -light.centre;
  const dvec3 side = std::abs(light.normal.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(0, 0, -1);
  light.ex = cross(side, light.normal);
  light.ex /= std::sqrt(dot(light.ex, light.ex));
  light.ey = cross(light.normal, light.ex);
  return light;
}

}  // namespace tenebra
