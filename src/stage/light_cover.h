// Finds meshes that hide a light from everything else in a scene: a sky between the city and its sun.
#pragma once

#include <span>
#include <vector>

#include <tenebra/frame_geometry.h>

namespace tenebra::stage {

struct LightCover {
  std::size_t light = 0;  ///< index into the lights
  int node = -1;          ///< whose mesh it is
  bool is_sky =
      false;  ///< flat or open, nearly all other casters stand in front of it, and it looks like one
};

/// Meshes at their nodes that alone cross the ways from nearly all (99 %) vertices of all other casters, or
/// of those in front of a sky, to one of `lights`; where vertices are very many, of some spread evenly among
/// them. See-through triangles count as casters.
std::vector<LightCover> find_light_covers(const Scene& scene, const FrameGeometry& frame,
                                          std::span<const WorldLight> lights);

}  // namespace tenebra::stage
