// Skins of a glTF file.
#include <fmt/core.h>

#include "formats/gltf/model.h"

namespace tenebra::formats::gltf {
namespace {

/// Warns where joints hang from different roots; each has a place all the same.
void check_common_root(const std::vector<int>& joints, const std::vector<int>& parents, std::size_t skin,
                       std::vector<std::string>& warnings) {
  std::vector<int> root(parents.size(), -1);  // known roots, so that long chains are climbed once
  int common = -1;
  for (const int joint : joints) {
    int top = joint;
    while (parents[static_cast<std::size_t>(top)] >= 0 && root[static_cast<std::size_t>(top)] < 0)
      top = parents[static_cast<std::size_t>(top)];
    if (root[static_cast<std::size_t>(top)] >= 0) top = root[static_cast<std::size_t>(top)];
    for (int node = joint; node >= 0 && root[static_cast<std::size_t>(node)] < 0;
         node = parents[static_cast<std::size_t>(node)])
      root[static_cast<std::size_t>(node)] = top;
    if (common >= 0 && top != common)
      return warnings.push_back(
          fmt::format("skins[{}].joints: found joints under different roots, expected one.", skin));
    common = top;
  }
}

/// A joint that does not exist is refused where it has a weight.
void check_joints_in_range(Asset& asset) {
  for (std::size_t n = 0; n < asset.scene.nodes.size(); ++n) {
    const Node& node = asset.scene.nodes[n];
    if (node.skin < 0) continue;
    Mesh& mesh = asset.scene.meshes[static_cast<std::size_t>(node.mesh)];
    const std::size_t joints = asset.scene.skins[static_cast<std::size_t>(node.skin)].joints.size();
    for (auto* const list : {&mesh.joints, &mesh.more_joints}) {
      const auto& weights = list == &mesh.joints ? mesh.weights : mesh.more_weights;
      for (std::size_t v = 0; v < list->size(); ++v)
        for (int c = 0; c < 4; ++c) {
          std::uint16_t& joint = (*list)[v][c];
          if (joint < joints) continue;
          if (weights[v][c] != 0)
            refuse("{} JOINTS_{}: found joint {}, expected less than the {} of skins[{}].joints", mesh.source,
                   list == &mesh.joints ? 0 : 1, joint, joints, node.skin);
          joint = 0;
        }
    }
  }
}

void check_last_rows(Asset& asset, const std::vector<double>& matrices, std::size_t skin) {
  std::size_t odd = 0;
  for (std::size_t i = 0; i + 16 <= matrices.size(); i += 16)
    odd += matrices[i + 3] != 0 || matrices[i + 7] != 0 || matrices[i + 11] != 0 || matrices[i + 15] != 1;
  if (odd > 0)
    asset.scene.warnings.push_back(fmt::format(
        "skins[{}].inverseBindMatrices: found {} with a last row that is not 0 0 0 1; used as they stand.",
        skin, odd));
}

}  // namespace

void build_skins(Asset& asset, const std::vector<int>& scene_node) {
  std::vector<bool> used(asset.model.skins.size(), false);
  for (const Node& node : asset.scene.nodes)
    if (node.skin >= 0) used[static_cast<std::size_t>(node.skin)] = true;
  for (std::size_t s = 0; s < asset.model.skins.size(); ++s) {
    const auto& source = asset.model.skins[s];
    Skin skin;
    check_common_root(source.joints, asset.parents, s, asset.scene.warnings);
    for (const int joint : source.joints) {
      skin.joints.push_back(scene_node[static_cast<std::size_t>(joint)]);
      if (used[s] && skin.joints.back() < 0)
        refuse("skins[{}].joints: found node {} outside the scene that is shown, expected it inside", s,
               joint);
    }
    asset.budget.take(skin.joints.size(), 64, fmt::format("skins[{}]", s));
    skin.inverse_bind.assign(skin.joints.size(), glm::mat4(1));
    if (source.inverseBindMatrices >= 0) {
      const Accessor& accessor = asset.model.accessors[static_cast<std::size_t>(source.inverseBindMatrices)];
      if (accessor.type != TINYGLTF_TYPE_MAT4 || accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT)
        refuse("skins[{}].inverseBindMatrices: found another format, expected MAT4 of floats", s);
      const auto numbers = read_numbers(asset, source.inverseBindMatrices);
      if (numbers.size() < 16 * skin.joints.size())
        refuse("skins[{}].inverseBindMatrices: found {}, expected one for each of {} joints", s,
               numbers.size() / 16, skin.joints.size());
      check_last_rows(asset, numbers, s);
      for (std::size_t i = 0; i < 16 * skin.joints.size(); ++i)
        skin.inverse_bind[i / 16][static_cast<int>(i % 16 / 4)][static_cast<int>(i % 4)] =
            static_cast<float>(numbers[i]);
    }
    asset.scene.skins.push_back(std::move(skin));
  }
  check_joints_in_range(asset);
}

}  // namespace tenebra::formats::gltf
