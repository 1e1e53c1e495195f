// Prepares a scene for baking, and puts the baked values into it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <tenebra/expected.h>
#include <tenebra/frame_geometry.h>
#include "bake/baked_map.h"
#include "bake/texel_coverage.h"

namespace tenebra::bake {

/// Gives each node that has a mesh one of its own: light differs from instance to instance.
void separate_meshes(Scene& scene);

/// Gives each corner at a vertex without a normal (none at all, or 0) a vertex of its own, so that light ends
/// at the edges of its triangle. The others stay shared.
void separate_flat_corners(Scene& scene);

/// Samples for the vertices of FrameGeometry: one near the corner of each triangle, weighed by its area.
std::vector<Sample> vertex_samples(const FrameGeometry& frame);

/// The mean of each vertex's samples; white and open without any.
std::vector<Light> vertex_light(std::span<const Sample> samples, std::span<const Light> light,
                                std::size_t vertices);

/// Vertex light that is brighter than vertex colours may be.
struct Clipped {
  std::size_t vertices = 0;
  float brightest = 1;  ///< the largest channel
};
/// Multiplies the colours of the scene's vertices, in FrameGeometry's order, by `light` times `exposure`
/// (`openness_only`: by the openness), cut off at 1 as glTF wants it. With light, materials that do not shine
/// themselves become unlit: it is in the colours now.
Clipped colour_vertices(Scene& scene, std::span<const Light> light, float exposure, bool openness_only);

/// The scene's triangles in a lightmap.
struct ScenePlaces {
  std::vector<MapTriangle> triangles;
  std::vector<std::string> parts_without;  ///< meshes that have no second set
  std::size_t flat = 0;                    ///< triangles without an area there
  std::size_t outside = 0;                 ///< triangles that reach beyond 0 to 1
  bool own_squares = false;                ///< meshes overlapped: TEXCOORD_1 of the scene was rewritten
};
/// Finds them by TEXCOORD_1. Where meshes at nodes lie in the same places, as they do where one is used twice
/// or each was unwrapped by itself, every one gets a square of the map of its own. Meshes are separate. Fails
/// where no mesh has a second set, or there is no room.
Expected<ScenePlaces> place_in_map(Scene& scene, const FrameGeometry& frame, int size);

/// The largest |coordinate| of the frame, and what samples keep from the edges of their triangles.
double extent_of(const FrameGeometry& frame);
/// Moves samples inside their triangles; drops those whose triangle has no area.
void move_inside(const FrameGeometry& frame, double margin_m, std::vector<Sample>& samples);

}  // namespace tenebra::bake
