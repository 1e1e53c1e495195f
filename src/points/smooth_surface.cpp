#include "points/smooth_surface.h"

#include <algorithm>
#include <cmath>

#include "points/contact_rule.h"

namespace tenebra::points {
namespace {

using glm::dvec3;
using glm::vec3;

/// An edge falls away from the plane at its end by half its length at most: 30 degrees, as on a hexagonal
/// prism, the coarsest shape that is meant to be round. Of sharper corners (a cone's tip) it is this much.
constexpr double steepest = 0.5;

// A normal is rounded to float twice, in the file and here: 2 sqrt(3)/2 2^-24, below 2^-22.
constexpr double normal_rounding = 0x1p-22;

/// The length of the longest edge.
double size_of(const dvec3 (&v)[3]) {
  return std::sqrt(std::max({glm::dot(v[1] - v[0], v[1] - v[0]), glm::dot(v[2] - v[1], v[2] - v[1]),
                             glm::dot(v[0] - v[2], v[0] - v[2])}));
}

/// Normals on the side of `face`; false where they are not all on one side. Zero stays: the face normal,
/// which nothing is below.
bool turn(const vec3 (&normals)[3], const dvec3& face, dvec3 (&out)[3]) {
  bool same = false, other = false;
  for (const vec3& n : normals) {
    const double along = glm::dot(dvec3(n), face);
    if (n == vec3(0.0f)) continue;
    same |= along > 0, other |= !(along > 0);
    if (along == 0) return false;
  }
  for (int i = 0; i < 3; ++i) out[i] = same ? dvec3(normals[i]) : -dvec3(normals[i]);
  return same != other;
}

/// A triangle whose normals differ.
struct SmoothTriangle {
  dvec3 v[3], normal[3], face;
  double area2 = 0;
};

/// False where it is flat, or its normals contradict it.
bool find(const TriangleView& triangles, std::uint32_t id, int side, SmoothTriangle& out) {
  const glm::uvec3 t = triangles.triangles[id];
  const vec3 normals[3] = {triangles.normals[t.x], triangles.normals[t.y], triangles.normals[t.z]};
  if (normals[0] == normals[1] && normals[0] == normals[2]) return false;
  for (int k = 0; k < 3; ++k) out.v[k] = dvec3(triangles.positions[t[k]]);
  out.face = glm::cross(out.v[1] - out.v[0], out.v[2] - out.v[0]);
  out.area2 = glm::dot(out.face, out.face);
  return side != 0 && out.area2 > 0 && turn(normals, static_cast<double>(side) * out.face, out.normal);
}

/// How far vertex i + 1 + k lies below the plane at vertex i.
double fall_of(const SmoothTriangle& t, int i, int k) {
  return glm::dot(t.v[i] - t.v[(i + 1 + k) % 3], t.normal[i]);
}

// What the rounding of vertices and normals makes of a flat triangle is no curve.
bool lifts(const SmoothTriangle& t) {
  double most = 0, largest = 0;
  for (int i = 0; i < 3; ++i) {
    most = std::max({most, fall_of(t, i, 0), fall_of(t, i, 1)});
    largest = std::max({largest, std::abs(t.v[i].x), std::abs(t.v[i].y), std::abs(t.v[i].z)});
  }
  return most > 2 * contact_tau * largest + normal_rounding * size_of(t.v);
}

}  // namespace

SmoothSurface smooth_surface(const TriangleView& triangles, std::uint32_t id, int side) {
  SmoothSurface out;
  if (triangles.normals.empty()) return out;
  SmoothTriangle t;
  if (!find(triangles, id, side, t) || !lifts(t)) return out;
  out.lifts = true;
  out.a = t.v[0];
  out.du = glm::cross(t.v[2] - t.v[0], t.face) / t.area2;
  out.dv = glm::cross(t.face, t.v[1] - t.v[0]) / t.area2;
  for (int i = 0; i < 3; ++i) {
    out.normal[i] = t.normal[i];
    for (int k = 0; k < 2; ++k) {
      const dvec3 edge = t.v[i] - t.v[(i + 1 + k) % 3];
      out.fall[i][k] = std::min(fall_of(t, i, k), steepest * std::sqrt(glm::dot(edge, edge)));
    }
  }
  return out;
}

bool is_before(const TriangleView& triangles, std::uint32_t id, int side, const SmoothLight& light) {
  SmoothTriangle t;
  if (triangles.normals.empty() || !find(triangles, id, side, t)) return false;
  const dvec3 at(light.at);
  for (int i = 0; i < 3; ++i)
    if (glm::dot(t.normal[i], light.directional ? at : at - t.v[i]) > 0) return lifts(t);
  return false;
}

}  // namespace tenebra::points
