#include "stage/cutout/new_vertices.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace tenebra::stage {
namespace {

using Corners = std::array<std::uint32_t, 3>;

template <class Wide, class Value>
Wide mix(const std::vector<Value>& list, const Corners& from, const CutVertex& vertex) {
  Wide sum(0.0);
  for (int k = 0; k < vertex.corners; ++k)
    sum += vertex.weight[k] * Wide(list[from[static_cast<std::size_t>(k)]]);
  return sum;
}

template <class Wide, class Value>
void append_mix(std::vector<Value>& list, std::size_t size, const Corners& from, const CutVertex& vertex) {
  if (list.size() == size) list.push_back(Value(mix<Wide>(list, from, vertex)));
}

void append_tangent(std::vector<glm::vec4>& tangents, std::size_t size, const Corners& from,
                    const CutVertex& vertex) {
  if (tangents.size() != size) return;
  const glm::dvec4 sum = mix<glm::dvec4>(tangents, from, vertex);
  const double length = glm::length(glm::dvec3(sum));
  tangents.push_back(length > 0 ? glm::vec4(glm::vec3(glm::dvec3(sum) / length), sum.w < 0 ? -1.0f : 1.0f)
                                : glm::vec4(0.0f));
}

void append_normal(std::vector<glm::vec3>& normals, std::size_t size, const Corners& from,
                   const CutVertex& vertex) {
  if (normals.size() != size) return;
  const glm::dvec3 sum = mix<glm::dvec3>(normals, from, vertex);
  const double length = std::sqrt(glm::dot(sum, sum));
  normals.push_back(length > 0 ? glm::vec3(sum / length) : glm::vec3(0.0f));
}

/// The weight of each joint, most first; of equal ones the smaller joint.
using Influences = std::vector<std::pair<double, std::uint16_t>>;

void add_influences(const glm::u16vec4& joints, const glm::vec4& weights, double share, Influences& out) {
  for (int k = 0; k < 4; ++k) {
    if (weights[k] == 0.0f) continue;
    const auto known =
        std::find_if(out.begin(), out.end(), [&](const auto& i) { return i.second == joints[k]; });
    if (known != out.end()) {
      known->first += share * weights[k];
    } else {
      out.emplace_back(share * weights[k], joints[k]);
    }
  }
}

double sum_of(const Influences& influences) {
  double sum = 0;
  for (const auto& [weight, joint] : influences) sum += weight;
  return sum;
}

void store(const Influences& influences, std::size_t first, glm::u16vec4& joints, glm::vec4& weights) {
  for (std::size_t k = 0; k < 4 && first + k < influences.size(); ++k) {
    joints[static_cast<int>(k)] = influences[first + k].second;
    weights[static_cast<int>(k)] = static_cast<float>(influences[first + k].first);
  }
}

}  // namespace

std::uint32_t NewVertices::add(const glm::uvec3& triangle, const CutVertex& vertex) {
  Corners from{};
  for (std::size_t k = 0; k < 3; ++k) from[k] = triangle[vertex.corner[k]];
  if (vertex.corners == 1) return from[0];
  if (vertex.corners == 3) return append(from, vertex);
  const std::array<std::uint64_t, 3> key{from[0], from[1], std::bit_cast<std::uint64_t>(vertex.weight[1])};
  const auto [at, is_new] = on_edges_.try_emplace(key, static_cast<std::uint32_t>(mesh_.positions.size()));
  if (is_new) append(from, vertex);
  return at->second;
}

std::uint32_t NewVertices::append(const Corners& from, const CutVertex& vertex) {
  const std::size_t size = mesh_.positions.size();
  append_joints(from, vertex);
  append_normal(mesh_.normals, size, from, vertex);
  append_tangent(mesh_.tangents, size, from, vertex);
  for (auto& coordinates : mesh_.texture_coordinates) append_mix<glm::dvec2>(coordinates, size, from, vertex);
  append_mix<glm::dvec4>(mesh_.colors, size, from, vertex);
  for (MorphTarget& target : mesh_.morph_targets) {
    append_mix<glm::dvec3>(target.positions, size, from, vertex);
    append_mix<glm::dvec3>(target.normals, size, from, vertex);
    append_mix<glm::dvec3>(target.tangents, size, from, vertex);
  }
  for (Mesh::Shape& shape : mesh_.shapes) {
    append_mix<glm::dvec3>(shape.positions, size, from, vertex);
    append_normal(shape.normals, size, from, vertex);
  }
  append_mix<glm::dvec3>(mesh_.positions, size, from, vertex);
  return static_cast<std::uint32_t>(size);
}

void NewVertices::append_joints(const Corners& from, const CutVertex& vertex) {
  const std::size_t size = mesh_.positions.size();
  if (mesh_.joints.size() != size || mesh_.weights.size() != size) return;
  const bool has_more = mesh_.more_joints.size() == size && mesh_.more_weights.size() == size;
  Influences influences;
  for (int k = 0; k < vertex.corners; ++k) {
    const std::uint32_t v = from[static_cast<std::size_t>(k)];
    add_influences(mesh_.joints[v], mesh_.weights[v], vertex.weight[k], influences);
    if (has_more) add_influences(mesh_.more_joints[v], mesh_.more_weights[v], vertex.weight[k], influences);
  }
  std::sort(influences.begin(), influences.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first > b.first : a.second < b.second;
  });
  if (influences.size() > 8) {
    const double all = sum_of(influences);
    influences.resize(8);
    const double kept = sum_of(influences);
    for (auto& [weight, joint] : influences) weight *= all / kept;
    ++lost_joints_;
  }
  if (influences.size() > 4 && !has_more) {
    mesh_.more_joints.assign(size, glm::u16vec4(0));
    mesh_.more_weights.assign(size, glm::vec4(0.0f));
  }
  glm::u16vec4 joints(0), more_joints(0);
  glm::vec4 weights(0.0f), more_weights(0.0f);
  store(influences, 0, joints, weights);
  store(influences, 4, more_joints, more_weights);
  mesh_.joints.push_back(joints), mesh_.weights.push_back(weights);
  if (!mesh_.more_joints.empty()) {
    mesh_.more_joints.push_back(more_joints);
    mesh_.more_weights.push_back(more_weights);
  }
}

}  // namespace tenebra::stage
