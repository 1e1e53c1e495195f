#include "scene/deform.h"

#include <algorithm>

namespace tenebra::scene {
namespace {

using Floats = std::vector<glm::vec3>;
using Doubles = std::vector<glm::dvec3>;

void widen(const std::vector<glm::vec4>& from, std::vector<glm::dvec4>& out) {
  out.assign(from.begin(), from.end());
}

void widen(const Floats& from, Doubles& out) {
  out.assign(from.begin(), from.end());
}

void mix(const Floats& a, const Floats& b, double u, Doubles& out) {
  out.resize(std::min(a.size(), b.size()));
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = glm::dvec3(a[i]) + u * (glm::dvec3(b[i]) - glm::dvec3(a[i]));
  }
}

void evaluate_shapes(const std::vector<Mesh::Shape>& shapes, double time_s, DeformBuffers& out) {
  const auto later = std::upper_bound(shapes.begin(), shapes.end(), time_s,
                                      [](double t, const Mesh::Shape& shape) { return t < shape.time_s; });
  if (later == shapes.begin() || later == shapes.end()) {
    const Mesh::Shape& held = later == shapes.begin() ? shapes.front() : shapes.back();
    widen(held.positions, out.positions);
    widen(held.normals, out.normals);
    return;
  }
  const Mesh::Shape& a = *(later - 1);
  const double u = (time_s - a.time_s) / (later->time_s - a.time_s);
  mix(a.positions, later->positions, u, out.positions);
  mix(a.normals, later->normals, u, out.normals);
}

template <class Vector>
void add(const Floats& displacements, double weight, std::vector<Vector>& out) {
  const std::size_t count = std::min(displacements.size(), out.size());
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec3 step = weight * glm::dvec3(displacements[i]);
    for (int c = 0; c < 3; ++c) out[i][c] += step[c];
  }
}

}  // namespace

void deform_mesh(const Mesh& mesh, std::span<const double> weights, double time_s, DeformBuffers& out) {
  out.tangents.clear();
  if (!mesh.shapes.empty()) return evaluate_shapes(mesh.shapes, time_s, out);
  widen(mesh.positions, out.positions);
  widen(mesh.normals, out.normals);
  widen(mesh.tangents, out.tangents);
  for (std::size_t k = 0; k < mesh.morph_targets.size(); ++k) {
    if (weights[k] == 0.0) continue;
    add(mesh.morph_targets[k].positions, weights[k], out.positions);
    add(mesh.morph_targets[k].normals, weights[k], out.normals);
    add(mesh.morph_targets[k].tangents, weights[k], out.tangents);
  }
}

void evaluate_joints(const Skin& skin, const Pose& pose, DeformBuffers& out) {
  out.joints.resize(skin.joints.size());
  for (std::size_t j = 0; j < skin.joints.size(); ++j) {
    const glm::dmat4& to_world = pose.nodes[static_cast<std::size_t>(skin.joints[j])].to_world;
    out.joints[j] = j < skin.inverse_bind.size() ? to_world * glm::dmat4(skin.inverse_bind[j]) : to_world;
  }
}

glm::dmat4 blend_joints(const Mesh& mesh, std::size_t v, const DeformBuffers& buffers) {
  glm::dmat4 blend(0.0);
  const auto add = [&](const glm::u16vec4& joints, const glm::vec4& weights) {
    for (int k = 0; k < 4; ++k) {
      const double weight = weights[k];
      if (weight != 0.0) blend += buffers.joints[joints[k]] * weight;
    }
  };
  add(mesh.joints[v], mesh.weights[v]);
  if (!mesh.more_joints.empty()) add(mesh.more_joints[v], mesh.more_weights[v]);
  return blend;
}

const Skin* skin_of(const Scene& scene, const Node& node, const Mesh& mesh) {
  if (node.skin < 0 || mesh.joints.empty()) return nullptr;
  const Skin& skin = scene.skins[static_cast<std::size_t>(node.skin)];
  return skin.joints.empty() ? nullptr : &skin;
}

}  // namespace tenebra::scene
