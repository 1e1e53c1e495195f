// Morph targets: differences from the mesh, and the weights that drive them.
#include <algorithm>
#include <cmath>

#include "gltf_writer.h"

namespace tenebra::converter {
namespace {

constexpr int float_component = 5126;

/// `target` less `base`; not finite: no difference.
std::vector<aiVector3D> differences(const aiVector3D* target, const aiVector3D* base, unsigned count) {
  std::vector<aiVector3D> list(target, target + count);
  for (unsigned i = 0; i < count; ++i) {
    if (base != nullptr) list[i] -= base[i];
    if (!std::isfinite(list[i].SquareLength())) list[i] = aiVector3D();
  }
  return list;
}

/// The weight of `target` at each key: keys name some targets, and between these it runs straight.
std::vector<float> weights_of(const aiMeshMorphAnim& source, unsigned target) {
  std::vector<float> weights(source.mNumKeys);
  unsigned last = source.mNumKeys;  // the last key that names it
  for (unsigned k = 0; k < source.mNumKeys; ++k) {
    const aiMeshMorphKey& key = source.mKeys[k];
    const unsigned *const start = key.mValues, *const end = start + key.mNumValuesAndWeights;
    const unsigned* const found = std::find(start, end, target);
    if (found == end) {
      weights[k] = last < k ? weights[last] : 0;
      continue;
    }
    const auto weight = static_cast<float>(key.mWeights[found - start]);
    weights[k] = std::isfinite(weight) ? weight : 0;
    const bool first = last == source.mNumKeys;
    for (unsigned i = first ? 0 : last + 1; i < k; ++i) {
      const double share = (source.mKeys[i].mTime - source.mKeys[first ? 0 : last].mTime) /
                           (key.mTime - source.mKeys[first ? 0 : last].mTime);
      weights[i] = first ? weights[k] : std::lerp(weights[last], weights[k], static_cast<float>(share));
    }
    last = k;
  }
  return weights;
}

}  // namespace

/// Null where it has none.
Json GltfWriter::morph_targets(const aiMesh& mesh) {
  Json targets;
  for (unsigned i = 0; i < mesh.mNumAnimMeshes; ++i) {
    const aiAnimMesh& source = *mesh.mAnimMeshes[i];
    const bool relative = mesh.mMethod == aiMorphingMethod_MORPH_RELATIVE;
    Json target = Json::object();
    const auto add = [&](const char* name, const aiVector3D* to, const aiVector3D* from) {
      if (to == nullptr || from == nullptr || source.mNumVertices != mesh.mNumVertices) return;
      const auto list = differences(to, relative ? nullptr : from, mesh.mNumVertices);
      target[name] = glb_.add_accessor(list.data(), list.size(), float_component, "VEC3");
    };
    add("POSITION", source.mVertices, mesh.mVertices);
    add("NORMAL", source.mNormals, mesh.mNormals);
    targets.push_back(std::move(target));
  }
  if (mesh.mNumAnimMeshes > 0) leave_out("Morph targets that nothing animates have the weight 0.");
  return targets;
}

/// glTF asks for the same number of targets in all primitives of a mesh.
void GltfWriter::even_out_targets(Json& primitives) {
  const auto count = [](const Json& one) { return one.contains("targets") ? one["targets"].size() : 0; };
  const bool even = std::all_of(primitives.begin(), primitives.end(),
                                [&](const Json& one) { return count(one) == count(primitives[0]); });
  if (even) return;
  for (Json& one : primitives) one.erase("targets");
  leave_out("Morph targets of a mesh whose parts have different numbers of them are left out.");
}

void GltfWriter::add_weights(const aiMeshMorphAnim& source, double ticks_per_second, Json& animation) {
  std::string name = source.mName.C_Str();
  if (!node_index_.contains(name)) name.resize(std::min(name.size(), name.rfind('*')));  // FBX: "node*0"
  const auto node = node_index_.find(name);
  if (node == node_index_.end()) return;
  const Json& written = glb_.json["nodes"][node->second];
  if (!written.contains("mesh")) return;
  const Json& first = glb_.json["meshes"][written["mesh"].get<std::size_t>()]["primitives"][0];
  if (!first.contains("targets")) return;
  std::vector<std::vector<float>> weights;
  for (unsigned t = 0; t < first["targets"].size(); ++t) weights.push_back(weights_of(source, t));
  std::vector<float> times, values;
  for (unsigned k = 0; k < source.mNumKeys; ++k) {
    const auto time = static_cast<float>(source.mKeys[k].mTime / ticks_per_second);
    if (!(time >= 0) || !std::isfinite(time) || (!times.empty() && time <= times.back())) continue;
    times.push_back(time);
    for (const std::vector<float>& list : weights) values.push_back(list[k]);
  }
  add_track(times, values, "SCALAR", "weights", node->second, animation);
}

}  // namespace tenebra::converter
