// JOINTS_n and WEIGHTS_n of a primitive, with weights that sum to 1.
#include <fmt/core.h>
#include <cmath>

#include "formats/gltf/model.h"

namespace tenebra::formats::gltf {
namespace {

constexpr std::size_t joint_sets = 2;

struct Set {
  std::vector<double> joints, weights;  ///< four for each vertex
};

Set read_set(Asset& asset, const tinygltf::Primitive& primitive, std::size_t set, const std::string& place) {
  const std::string joints_name = fmt::format("JOINTS_{}", set),
                    weights_name = fmt::format("WEIGHTS_{}", set);
  const auto joints = primitive.attributes.find(joints_name),
             weights = primitive.attributes.find(weights_name);
  const auto end = primitive.attributes.end();
  if ((joints == end) != (weights == end))
    refuse("{}.attributes: found {} or {} alone, expected both", place, joints_name, weights_name);
  if (joints == end) return {};
  const auto accessor = [&](int i) -> const Accessor& {
    return asset.model.accessors[static_cast<std::size_t>(i)];
  };
  const int type = accessor(joints->second).componentType;
  if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT)
    refuse("{}.attributes.{}: found component type {}, expected 5121 or 5123", place, joints_name, type);
  for (const auto& found : {joints, weights})
    if (accessor(found->second).type != TINYGLTF_TYPE_VEC4)
      refuse("{}.attributes.{}: found accessors[{}] of another type, expected VEC4", place, found->first,
             found->second);
  return {read_numbers(asset, joints->second), read_numbers(asset, weights->second)};
}

/// The weights of one vertex, from all sets.
struct Vertex {
  double weights[4 * joint_sets] = {};

  /// Makes the sum 1. Returns false where it was, within the rounding of stored floats.
  bool mend() {
    double sum = 0;
    int used = 0;
    bool broken = false;
    for (double& weight : weights) {
      if (!(weight >= 0 && std::isfinite(weight))) weight = 0, broken = true;
      sum += weight;
      used += weight > 0;
    }
    constexpr double rounding = 2e-7;  // of each weight, a float near 1 or less
    if (!broken && std::abs(sum - 1) <= rounding * used) return false;
    for (double& weight : weights) weight = sum > 0 ? weight / sum : 0;
    if (!(sum > 0)) weights[0] = 1;  // the first joint is as good a guess as any
    return true;
  }
};

/// Whether two weights of vertex `v` that are not 0 name the same joint.
bool repeats(const Set& first, const Set& second, const Vertex& vertex, std::size_t v) {
  const std::size_t count = second.joints.empty() ? 4 : 8;
  const auto joint = [&](std::size_t k) {
    return k < 4 ? first.joints[4 * v + k] : second.joints[4 * v + k - 4];
  };
  for (std::size_t a = 0; a < count; ++a)
    for (std::size_t b = a + 1; b < count; ++b)
      if (vertex.weights[a] > 0 && vertex.weights[b] > 0 && joint(a) == joint(b)) return true;
  return false;
}

}  // namespace

Influences read_influences(Asset& asset, const tinygltf::Primitive& primitive, const std::string& place) {
  Influences result;
  const Set first = read_set(asset, primitive, 0, place), second = read_set(asset, primitive, 1, place);
  if (first.joints.empty()) {
    if (!second.joints.empty())
      refuse("{}.attributes: found JOINTS_1 without JOINTS_0, expected both", place);
    return result;
  }
  const bool more = !second.joints.empty();
  const std::size_t count = first.joints.size() / 4;
  result.joints.resize(count);
  result.weights.resize(count);
  result.more_joints.resize(more ? count : 0);
  result.more_weights.resize(more ? count : 0);
  for (std::size_t v = 0; v < count; ++v) {
    Vertex vertex;
    for (std::size_t c = 0; c < 4; ++c) {
      vertex.weights[c] = first.weights[4 * v + c];
      if (more) vertex.weights[4 + c] = second.weights[4 * v + c];
    }
    result.mended += vertex.mend();
    result.repeated += repeats(first, second, vertex, v);
    for (int c = 0; c < 4; ++c) {
      const std::size_t at = 4 * v + static_cast<std::size_t>(c);
      result.joints[v][c] = static_cast<std::uint16_t>(first.joints[at]);
      result.weights[v][c] = static_cast<float>(vertex.weights[c]);
      if (!more) continue;
      result.more_joints[v][c] = static_cast<std::uint16_t>(second.joints[at]);
      result.more_weights[v][c] = static_cast<float>(vertex.weights[4 + c]);
    }
  }
  return result;
}

}  // namespace tenebra::formats::gltf
