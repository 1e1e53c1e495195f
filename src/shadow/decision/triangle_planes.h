// A triangle as seen from one light: four unit planes (three through the light and an edge, and its own),
// their error bounds, and what the cone tests need.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include <tenebra/hard_config.h>
#include <tenebra/visible_points.h>

namespace tenebra::shadow {

/// The source of a light's rays. Positions are taken relative to `origin`: the light, 0 for directional
/// lights, or a point amid the rays.
struct RaySource {
  bool directional = false;
  bool distant = false;   ///< `origin` is a point amid the rays
  glm::vec3 light{0.0f};  ///< position, or direction towards the light
  glm::dvec3 origin{0.0};
  glm::dvec3 travel{0.0};  ///< directional: unit direction of the light's travel, rounded
};
RaySource ray_source(const ShadowLight& light);

/// Planes m.p - d with p relative to the source's origin, oriented so that the blocked region (behind the
/// triangle, inside its edges) is positive. In double with the relative errors `rho`: the exact value of
/// plane k differs from the one computed in double by at most rho[k] (|p| + reach).
struct TrianglePlanes {
  double mx[4], my[4], mz[4];  ///< 0..2: edges AB, BC, CA; 3: own plane
  double d[4];  ///< 0 for edges where the origin is the light; plane 3 holds tau of the triangle
  double rho[4];
  double reach;            ///< largest |vertex - origin|
  std::uint32_t triangle;  ///< id
  std::int32_t side;       ///< s of the contract: +1 or -1
};

/// Planes in float for the conservative node tests, and the triangle's corners as seen from the light. Two
/// cache lines: lists of triangles are walked at the speed of memory.
struct alignas(64) TriangleBounds {
  float mx[4], my[4], mz[4];
  float d[4];
  float cx[3], cy[3],
      cz[3];           ///< corners: unit directions from a point light; positions across a directional one
  float sx, sy, sz;    ///< bounding sphere: unit direction of the centre, or its position across
  float sphere_chord;  ///< chord of the sphere's cap (2: light inside), or its radius; rounded up
  float sphere_near;   ///< nearest distance (or height along travel); rounded down
  float rho;           ///< largest of the planes'; rounded up
  float climb;         ///< directional: m3.travel
};
static_assert(sizeof(TriangleBounds) == 128);

/// Casting triangles of one light. Triangles that can block nothing (zero area, edge-on, culled) are left
/// out.
struct TriangleSet {
  std::vector<TrianglePlanes> planes;
  std::vector<TriangleBounds> bounds;
  std::vector<float>
      extent;  ///< about the solid angle, or the area across a directional light: choice of blockers
  std::vector<std::uint8_t> facing;  ///< one per triangle id: Faces (lifted_points.h) of points in front of
                                     ///< it and, shifted by two bits, of those behind
  std::vector<float> tau;            ///< one per triangle id: rounding tolerance, rounded up
  std::uint64_t degenerate = 0;      ///< left out for zero area or for being edge-on
  std::uint64_t casting = 0;         ///< triangles that were to cast

  std::vector<std::uint32_t> chunk_counts;  ///< scratch
};

/// s of the contract: on which side of the triangle the light is; 0: the triangle blocks nothing. Exact.
int light_side(const glm::vec3 corners[3], const RaySource& source);
/// Planes of a triangle on side `side` (not 0); `tau` is its rounding tolerance.
TrianglePlanes planes_of(const glm::vec3 corners[3], std::uint32_t id, int side, const RaySource& source,
                         double tau);

/// Fills `out` for one light. Order of `planes` is the order of ids.
void build_triangle_set(const TriangleView& triangles, const RaySource& source,
                        const HardShadowConfig& config, TriangleSet& out);

}  // namespace tenebra::shadow
