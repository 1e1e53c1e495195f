#include "render/light_casters.h"

#include <algorithm>

#include "scene/frame_parts.h"

namespace tenebra::render {
namespace {

/// Sets the casters of the mesh at node `left_out` to 0.
void leave_out(const Scene& scene, const FrameGeometry& geometry, int left_out,
               std::vector<std::uint8_t>& casters) {
  std::size_t part = 0;  // of FrameGeometry::parts: one for each node with a mesh
  for (int i = 0; i < left_out; ++i) part += scene.nodes[static_cast<std::size_t>(i)].mesh >= 0;
  if (part >= geometry.parts.size()) return;
  const auto [first, end] = scene::triangles_of_part(geometry, part);
  std::fill(casters.begin() + static_cast<std::ptrdiff_t>(first),
            casters.begin() + static_cast<std::ptrdiff_t>(end), std::uint8_t{0});
}

}  // namespace

TriangleView casters_of(const Scene& scene, const FrameGeometry& geometry, const DrawnLight& light,
                        std::vector<std::uint8_t>& storage) {
  TriangleView triangles = triangle_view(geometry);
  const std::vector<int>& left_out = light.light.left_out_nodes;
  const bool in_plane = light.area && casters_off_plane(geometry, *light.area, storage);
  if (!in_plane && left_out.empty()) return triangles;
  if (!in_plane) storage = geometry.casts_shadow;
  for (const int node : left_out) leave_out(scene, geometry, node, storage);
  triangles.casts_shadow = storage;
  return triangles;
}

}  // namespace tenebra::render
