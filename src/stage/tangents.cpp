#include "stage/tangents.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <vector>

#include "scene/map_tangent.h"

namespace tenebra::stage {
namespace {

using glm::dvec2;
using glm::dvec3;

dvec3 unit(const dvec3& v) {
  const double length = glm::length(v);
  return length > 0 && std::isfinite(length) ? v / length : dvec3(0.0);
}

struct Sum {
  dvec3 along{0.0};
  bool left = false, right = false;  ///< triangles with y on either side of cross(normal, along) met there
};

/// Sums over the triangles of one material.
struct TangentSums {
  const Mesh& mesh;
  const TextureMap& map;
  std::vector<std::uint32_t> first;  ///< of the vertices with the same position, normal and coordinates
  std::vector<Sum> sums;             ///< by the first

  const std::vector<glm::vec2>& set() const {
    return mesh.texture_coordinates[static_cast<std::size_t>(map.uv_set)];
  }

  /// In bits: positions may be no numbers. 0 is added so that -0 is 0.
  std::array<std::uint32_t, 8> key(std::uint32_t v) const {
    const glm::vec3 &p = mesh.positions[v], &n = mesh.normals[v];
    const auto bits = [](float value) { return std::bit_cast<std::uint32_t>(value + 0.0f); };
    return {bits(p.x), bits(p.y), bits(p.z),        bits(n.x),
            bits(n.y), bits(n.z), bits(set()[v].x), bits(set()[v].y)};
  }

  /// Begins with no sums for these vertices, which it puts in the order of what they are.
  void begin(std::vector<std::uint32_t>& vertices) {
    std::sort(vertices.begin(), vertices.end(), [&](std::uint32_t a, std::uint32_t b) {
      const auto left = key(a), right = key(b);
      return left != right ? left < right : a < b;
    });
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    first.resize(mesh.positions.size());
    sums.resize(mesh.positions.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const bool same = i > 0 && key(vertices[i]) == key(vertices[i - 1]);
      first[vertices[i]] = same ? first[vertices[i - 1]] : vertices[i];
      sums[vertices[i]] = {};
    }
  }

  dvec2 place(std::uint32_t vertex) const {
    return glm::dmat3x2(map.transform) * dvec3(dvec2(set()[vertex]), 1.0);
  }

  void add(const glm::uvec3& t) {
    const dvec3 e1(dvec3(mesh.positions[t.y]) - dvec3(mesh.positions[t.x])),
        e2(dvec3(mesh.positions[t.z]) - dvec3(mesh.positions[t.x]));
    const dvec2 second = place(t.y) - place(t.x), third = place(t.z) - place(t.x);
    const glm::dvec4 own = scene::map_tangent(e1, e2, second, third);
    const dvec3 along(own), wound = glm::cross(e1, e2);
    if (along == dvec3(0.0)) return;
    for (int k = 0; k < 3; ++k) {
      const dvec3 normal(mesh.normals[t[k]]), here(mesh.positions[t[k]]);
      const auto within = [&](const dvec3& v) { return unit(v - glm::dot(v, normal) * normal); };
      const double cosine = glm::dot(within(dvec3(mesh.positions[t[(k + 1) % 3]]) - here),
                                     within(dvec3(mesh.positions[t[(k + 2) % 3]]) - here));
      Sum& sum = sums[first[t[k]]];
      sum.along += std::acos(std::clamp(cosine, -1.0, 1.0)) * within(along);
      ((glm::dot(normal, wound) < 0) == (own.w > 0) ? sum.left : sum.right) = true;
    }
  }
};

bool is_smooth(const Mesh& mesh, const glm::uvec3& t) {
  const auto has_normal = [&](std::uint32_t v) { return mesh.normals[v] != glm::vec3(0.0f); };
  return has_normal(t.x) && has_normal(t.y) && has_normal(t.z);
}

void add_tangents(Mesh& mesh, const std::vector<glm::uvec3>& triangles, TangentSums& found) {
  std::vector<std::uint32_t> vertices;
  for (const glm::uvec3& t : triangles) vertices.insert(vertices.end(), {t.x, t.y, t.z});
  found.begin(vertices);
  for (const glm::uvec3& t : triangles) found.add(t);
  mesh.tangents.resize(mesh.positions.size(), glm::vec4(0.0f));
  for (const std::uint32_t v : vertices) {
    const Sum& sum = found.sums[found.first[v]];
    if (sum.left == sum.right || mesh.tangents[v] != glm::vec4(0.0f)) continue;
    const dvec3 along = unit(sum.along);
    if (along != dvec3(0.0)) mesh.tangents[v] = {glm::vec3(along), sum.left ? -1.0f : 1.0f};
  }
}

}  // namespace

void add_tangents(Scene& scene) {
  for (Mesh& mesh : scene.meshes) {
    const std::size_t count = mesh.positions.size();
    if (mesh.normals.size() != count || !mesh.shapes.empty()) continue;
    std::map<std::uint32_t, std::vector<glm::uvec3>> by_material;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
      if (scene.materials[mesh.materials[i]].normal_map && is_smooth(mesh, mesh.triangles[i]))
        by_material[mesh.materials[i]].push_back(mesh.triangles[i]);
    std::vector<std::uint32_t> first;
    std::vector<Sum> sums;
    for (const auto& [material, triangles] : by_material) {
      const TextureMap& map = scene.materials[material].normal_map;
      if (mesh.texture_coordinates[static_cast<std::size_t>(map.uv_set)].size() != count) continue;
      TangentSums found{mesh, map, std::move(first), std::move(sums)};
      add_tangents(mesh, triangles, found);
      first = std::move(found.first), sums = std::move(found.sums);
    }
  }
}

}  // namespace tenebra::stage
