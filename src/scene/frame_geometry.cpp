#include <tenebra/frame_geometry.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/deform.h"
#include "scene/pose.h"

namespace tenebra {
namespace {

constexpr double largest_coordinate =
    1.8e18f;  // beyond it, products of coordinates leave the range of floats
constexpr float dropped = std::numeric_limits<float>::quiet_NaN();

/// What to apply to normals for positions under `m`: its inverse transpose up to a positive factor, from
/// cofactors, so that flat transforms work too.
glm::dmat3 normal_matrix(const glm::dmat3& m) {
  const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
  double largest = 0;
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) largest = std::max(largest, std::abs(cofactors[c][r]));
  }
  if (!(largest > 0.0) || !std::isfinite(largest)) return glm::dmat3(1.0);
  return cofactors * ((glm::dot(m[0], cofactors[0]) < 0.0 ? -1.0 : 1.0) / largest);
}

bool mirrors(const glm::dmat3& m) {
  return glm::dot(m[0], glm::cross(m[1], m[2])) < 0.0;
}

/// The rounding to float that makes the geometry. A vertex out of range becomes NaN for now.
bool store_position(const glm::dvec3& p, glm::vec3& out) {
  const bool in_range = std::abs(p.x) <= largest_coordinate && std::abs(p.y) <= largest_coordinate &&
                        std::abs(p.z) <= largest_coordinate;
  out = in_range ? glm::vec3(p) : glm::vec3(dropped);
  return in_range;
}

template <class Vector>
glm::vec3 unit_or_zero(const Vector& n) {
  const auto square = glm::dot(n, n);
  if (!(square > 0) || !std::isfinite(square)) return glm::vec3(0.0f);
  return glm::vec3(n / std::sqrt(square));
}

/// A tangent under `m`; a mirror turns the cross product of two directions around.
template <class Vector>
glm::vec4 tangent_under(const glm::dmat3& m, const Vector& tangent) {
  const double side = tangent.w < 0 ? -1.0 : 1.0;
  return {unit_or_zero(m * glm::dvec3(tangent)), static_cast<float>(mirrors(m) ? -side : side)};
}

/// One mesh at one node: where its part of the frame's arrays begins, and what places its vertices.
struct Instance {
  const Mesh& mesh;
  std::size_t first_vertex;
  std::size_t first_triangle;
  bool visible;
  const glm::dmat4& to_world;
  const Skin* skin;
};

/// Transforms a mesh's vertices into the frame; returns how many are out of range.
template <class Vector, class Tangent>
std::size_t place_rigid(const Instance& instance, const std::vector<Vector>& positions,
                        const std::vector<Vector>& normals, const std::vector<Tangent>& tangents,
                        FrameGeometry& out) {
  const glm::dmat3 linear(instance.to_world);
  const glm::dvec3 origin(instance.to_world[3]);
  std::size_t bad = 0;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const glm::dvec3 p = linear * glm::dvec3(positions[v]) + origin;
    bad += !store_position(p, out.positions[instance.first_vertex + v]);
  }
  const glm::mat3 turn(normal_matrix(linear));
  for (std::size_t v = 0; v < normals.size(); ++v) {
    out.normals[instance.first_vertex + v] = unit_or_zero(turn * glm::vec3(normals[v]));
  }
  for (std::size_t v = 0; v < tangents.size(); ++v)
    out.tangents[instance.first_vertex + v] = tangent_under(linear, tangents[v]);
  return bad;
}

template <class Vector, class Tangent>
std::size_t place_skinned(const Instance& instance, const std::vector<Vector>& positions,
                          const std::vector<Vector>& normals, const std::vector<Tangent>& tangents,
                          FrameGeometry& out) {
  const Mesh& mesh = instance.mesh;
  std::size_t bad = 0;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const glm::dmat4 blend = scene::blend_joints(mesh, v, out.deformed);
    const glm::dvec3 p(blend * glm::dvec4(glm::dvec3(positions[v]), 1.0));
    bad += !store_position(p, out.positions[instance.first_vertex + v]);
    if (!tangents.empty())
      out.tangents[instance.first_vertex + v] = tangent_under(glm::dmat3(blend), tangents[v]);
    if (normals.empty()) continue;
    const glm::dvec3 normal = normal_matrix(glm::dmat3(blend)) * glm::dvec3(normals[v]);
    out.normals[instance.first_vertex + v] = unit_or_zero(normal);
  }
  return bad;
}

template <class Vector, class Tangent>
std::size_t place(const Instance& instance, const std::vector<Vector>& positions,
                  const std::vector<Vector>& normals, const std::vector<Tangent>& tangents,
                  FrameGeometry& out) {
  if (normals.empty()) {
    const auto first = out.normals.begin() + static_cast<std::ptrdiff_t>(instance.first_vertex);
    std::fill_n(first, positions.size(), glm::vec3(0.0f));
  }
  if (tangents.empty() && !out.tangents.empty()) {
    const auto first = out.tangents.begin() + static_cast<std::ptrdiff_t>(instance.first_vertex);
    std::fill_n(first, positions.size(), glm::vec4(0.0f));
  }
  return instance.skin ? place_skinned(instance, positions, normals, tangents, out)
                       : place_rigid(instance, positions, normals, tangents, out);
}

bool is_dropped(const glm::uvec3& triangle, const FrameGeometry& out) {
  return std::isnan(out.positions[triangle.x].x) || std::isnan(out.positions[triangle.y].x) ||
         std::isnan(out.positions[triangle.z].x);
}

/// Triangles keep their place in every frame: hidden and dropped ones become (0, 0, 0).
void write_triangles(const Instance& instance, bool mirrored, bool has_bad_vertices, FrameGeometry& out) {
  const auto base = static_cast<std::uint32_t>(instance.first_vertex);
  const std::vector<glm::uvec3>& triangles = instance.mesh.triangles;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const glm::uvec3 corners = triangles[t] + base;
    glm::uvec3 triangle = mirrored ? glm::uvec3(corners.x, corners.z, corners.y) : corners;
    if (!instance.visible) {
      triangle = glm::uvec3(0);
    } else if (has_bad_vertices && is_dropped(corners, out)) {
      triangle = glm::uvec3(0);
      ++out.dropped_non_finite;
    }
    out.triangles[instance.first_triangle + t] = triangle;
  }
}

void write_materials(const Scene& scene, const Instance& instance, FrameGeometry& out) {
  for (std::size_t t = 0; t < instance.mesh.triangles.size(); ++t) {
    const std::uint32_t index = instance.mesh.materials[t];
    const Material& material = scene.materials[index];
    const std::size_t triangle = instance.first_triangle + t;
    out.materials[triangle] = index;
    const bool casts = instance.mesh.casts_shadow && material.casts_shadow;
    out.casts_shadow[triangle] = casts && !material.see_through();
    if (!out.see_through.empty()) out.see_through[triangle] = !material.see_through() ? 0 : casts ? 1 : 2;
  }
}

/// Dropped vertices become zero, so that whoever reads all positions finds numbers.
void clear_dropped(const Instance& instance, FrameGeometry& out) {
  for (std::size_t v = 0; v < instance.mesh.positions.size(); ++v) {
    glm::vec3& position = out.positions[instance.first_vertex + v];
    if (std::isnan(position.x)) position = glm::vec3(0.0f);
  }
}

void write_instance(const Scene& scene, const Instance& instance, std::span<const double> weights,
                    double time_s, FrameGeometry& out) {
  if (instance.skin) scene::evaluate_joints(*instance.skin, out.pose, out.deformed);
  std::size_t bad = 0;
  if (scene::deforms(instance.mesh)) {
    scene::deform_mesh(instance.mesh, weights, time_s, out.deformed);
    bad = place(instance, out.deformed.positions, out.deformed.normals, out.deformed.tangents, out);
  } else {
    bad = place(instance, instance.mesh.positions, instance.mesh.normals, instance.mesh.tangents, out);
  }
  const glm::dmat4& decisive = instance.skin ? out.deformed.joints.front() : instance.to_world;
  write_triangles(instance, mirrors(glm::dmat3(decisive)), bad > 0, out);
  write_materials(scene, instance, out);
  if (bad > 0) clear_dropped(instance, out);
}

void resize(const Scene& scene, FrameGeometry& out) {
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  bool any_tangents = false;
  for (const Node& node : scene.nodes) {
    if (node.mesh < 0) continue;
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
    vertices += mesh.positions.size();
    triangles += mesh.triangles.size();
    any_tangents = any_tangents || !mesh.tangents.empty();
  }
  out.positions.resize(vertices);
  out.normals.resize(vertices);
  out.tangents.resize(any_tangents ? vertices : 0);
  out.triangles.resize(triangles);
  out.materials.resize(triangles);
  out.casts_shadow.resize(triangles);
  const bool any_see_through = std::any_of(scene.materials.begin(), scene.materials.end(),
                                           [](const Material& m) { return m.see_through(); });
  out.see_through.resize(any_see_through ? triangles : 0);
}

}  // namespace

void evaluate_frame(const Scene& scene, int clip, double time_s, FrameGeometry& out) {
  const bool at_rest = clip < 0 || static_cast<std::size_t>(clip) >= scene.clips.size();
  const double shape_time_s = at_rest ? -std::numeric_limits<double>::infinity() : time_s;
  scene::evaluate_pose(scene, clip, time_s, out.pose);
  resize(scene, out);
  out.dropped_non_finite = 0;
  out.parts.clear();
  std::size_t vertex = 0;
  std::size_t triangle = 0;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    const Node& node = scene.nodes[i];
    if (node.mesh < 0) continue;
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
    const NodePose& pose = out.pose.nodes[i];
    const std::span<const double> weights(out.pose.weights.data() + pose.first_weight,
                                          mesh.morph_targets.size());
    out.parts.push_back(static_cast<std::uint32_t>(triangle));
    const Instance instance{mesh,         vertex,        triangle,
                            pose.visible, pose.to_world, scene::skin_of(scene, node, mesh)};
    write_instance(scene, instance, weights, shape_time_s, out);
    vertex += mesh.positions.size();
    triangle += mesh.triangles.size();
  }
}

SurfaceCoordinates surface_coordinates(const Scene& scene) {
  SurfaceCoordinates result;
  std::size_t vertices = 0;
  // One list after the other; a list begins with the first mesh that has it, and is filled up to there.
  const auto append = [&](auto& list, const auto& of_mesh, std::size_t count, auto otherwise) {
    if (of_mesh.empty() && list.empty()) return;
    list.resize(vertices, otherwise);
    list.insert(list.end(), of_mesh.begin(), of_mesh.end());
    list.resize(vertices + count, otherwise);
  };
  for (const Node& node : scene.nodes) {
    if (node.mesh < 0) continue;
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
    const std::size_t count = mesh.positions.size();
    for (std::size_t set = 0; set < 2; ++set)
      append(result.texture_coordinates[set], mesh.texture_coordinates[set], count, glm::vec2(0.0f));
    append(result.colors, mesh.colors, count, glm::vec4(1.0f));
    vertices += count;
  }
  return result;
}

}  // namespace tenebra
