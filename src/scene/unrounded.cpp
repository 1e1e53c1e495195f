#include "scene/unrounded.h"

#include <limits>

#include "scene/deform.h"
#include "scene/pose.h"

namespace tenebra::scene {
namespace {

/// Vertex `v` of a mesh in the space of its node; of one that deforms, from `buffers`.
glm::dvec3 unrounded_in_node(const Mesh& mesh, const DeformBuffers& buffers, std::size_t v) {
  if (deforms(mesh)) return buffers.positions[v];
  return mesh.unrounded.size() == mesh.positions.size() ? mesh.unrounded[v] : glm::dvec3(mesh.positions[v]);
}

}  // namespace

void each_unrounded(const Scene& scene, int clip, double time_s,
                    const std::function<void(std::size_t, const glm::dvec3&)>& visit) {
  const bool at_rest = clip < 0 || static_cast<std::size_t>(clip) >= scene.clips.size();
  const double shape_time_s = at_rest ? -std::numeric_limits<double>::infinity() : time_s;
  Pose pose;
  evaluate_pose(scene, clip, time_s, pose);
  DeformBuffers buffers;
  std::size_t vertex = 0;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    if (scene.nodes[i].mesh < 0) continue;
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(scene.nodes[i].mesh)];
    const NodePose& node = pose.nodes[i];
    if (deforms(mesh))
      deform_mesh(mesh, {pose.weights.data() + node.first_weight, mesh.morph_targets.size()}, shape_time_s,
                  buffers);
    const Skin* skin = skin_of(scene, scene.nodes[i], mesh);
    if (skin) evaluate_joints(*skin, pose, buffers);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      const glm::dmat4 place = skin ? blend_joints(mesh, v, buffers) : node.to_world;
      visit(vertex++, glm::dmat3(place) * unrounded_in_node(mesh, buffers, v) + glm::dvec3(place[3]));
    }
  }
}

}  // namespace tenebra::scene
