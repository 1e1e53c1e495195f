// Emissive meshes as lights: flat convex ones shine to their front.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include <tenebra/area_light.h>
#include <tenebra/frame_geometry.h>
#include <tenebra/scene.h>

namespace tenebra::render {

struct EmissivePolygon {
  AreaLight area;
  glm::vec3 radiance{0.0f};  ///< the material's emissive colour
  std::string mesh;          ///< name, for messages
};

/// The parts of visible meshes with an emissive material, one per node and material in their order. A part
/// shines if its triangles make one planar convex polygon of at most 14 corners without overlap, all turned
/// to one side; the others are named in `notes`, one sentence each.
std::vector<EmissivePolygon> emissive_polygons(const Scene& scene, const FrameGeometry& geometry,
                                               std::vector<std::string>& notes);

}  // namespace tenebra::render
