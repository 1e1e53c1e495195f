// Whether a shadow ray crosses a see-through triangle: exact, and of triangles that share an edge or a vertex
// only those that a ray beside it would cross.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include <tenebra/hard_config.h>
#include <tenebra/visible_points.h>
#include "shadow/decision/triangle_planes.h"

namespace tenebra::tint {

inline constexpr int tile_samples = 16;

/// Sixteen samples of one light.
struct alignas(64) SampleTile {
  double x[tile_samples], y[tile_samples], z[tile_samples];  ///< relative to the source's origin
  double size[tile_samples];                                 ///< length of these
  double tau[tile_samples];                                  ///< rounding tolerance of the sample's triangle
  glm::dvec3 points[tile_samples];                           ///< exact
  std::uint32_t own[tile_samples];                           ///< the triangle that it lies on
};

/// What all samples of a light share.
struct CrossingFrame {
  const TriangleView& triangles;
  const shadow::RaySource& source;
  ContactRule contact;
};

/// Lanes of a tile, by what doubles say of a triangle.
struct LanesFound {
  std::uint32_t sure = 0;  ///< that cross it
  std::uint32_t open = 0;  ///< that may
};

/// Of the lanes found those whose rays cross the triangle. Adds to `exact` those that doubles left open.
std::uint32_t lanes_crossing(const CrossingFrame& frame, const shadow::TrianglePlanes& planes,
                             const SampleTile& tile, const LanesFound& found, std::uint64_t& exact);

/// The same for one sample, decided by exact signs alone.
bool crosses(const CrossingFrame& frame, const shadow::TrianglePlanes& planes, const glm::dvec3& point,
             std::uint32_t own);

}  // namespace tenebra::tint
