// Vertices of a mesh before its node places them: BART's shapes, glTF's morph targets, and skinning matrices.
#pragma once

#include <span>

#include <tenebra/frame_geometry.h>

namespace tenebra::scene {

/// True if the mesh's own positions are not what is drawn.
inline bool deforms(const Mesh& mesh) {
  return !mesh.shapes.empty() || !mesh.morph_targets.empty();
}

/// Fills out.positions, out.normals and out.tangents (empty if the mesh has none). `weights`: one per morph
/// target.
void deform_mesh(const Mesh& mesh, std::span<const double> weights, double time_s, DeformBuffers& out);

/// Fills out.joints: each takes a vertex at rest to world space.
void evaluate_joints(const Skin& skin, const Pose& pose, DeformBuffers& out);
/// The joints' matrices mixed by the weights of vertex `v` of a skinned mesh.
glm::dmat4 blend_joints(const Mesh& mesh, std::size_t v, const DeformBuffers& buffers);
/// The skin that moves a node's mesh, or null.
const Skin* skin_of(const Scene& scene, const Node& node, const Mesh& mesh);

}  // namespace tenebra::scene
