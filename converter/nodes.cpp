#include <assimp/commonMetaData.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gltf_writer.h"

namespace tenebra::converter {
namespace {

constexpr int float_component = 5126;

Json list(const aiVector3D& v) {
  return {v.x, v.y, v.z};
}
Json list(aiQuaternion q) {
  q.Normalize();
  return {q.x, q.y, q.z, q.w};
}

/// With a last element of 1, from which products of matrices stray.
Json matrix_of(const aiMatrix4x4& matrix) {
  const float last = std::isfinite(1 / matrix.d4) ? matrix.d4 : 1;
  Json columns = Json::array();
  for (unsigned column = 0; column < 4; ++column)
    for (unsigned row = 0; row < 4; ++row) columns.push_back(matrix[row][column] / last);
  return columns;
}

/// A node at `place` whose -Z is `direction`, which may be zero: then the node's own.
aiMatrix4x4 looking(const aiVector3D& place, aiVector3D direction, aiVector3D up) {
  if (!(direction.Length() > 0)) direction = aiVector3D(0, 0, -1);
  const aiVector3D back = -direction.Normalize();
  if (!((up ^ back).Length() > 1e-3f * up.Length()))  // any other
    up = std::abs(back.y) < 0.9f ? aiVector3D(0, 1, 0) : aiVector3D(1, 0, 0);
  const aiVector3D right = (up ^ back).Normalize(), above = back ^ right;
  return {right.x, above.x, back.x, place.x, right.y, above.y, back.y, place.y,
          right.z, above.z, back.z, place.z, 0,       0,       0,      1};
}

/// `by_collada`: Assimp makes up an outer cone for those, from an exponent that programs do not set.
Json light_of(const aiLight& source, bool by_collada) {
  const aiColor3D& color = source.mColorDiffuse;
  const float most = std::max({color.r, color.g, color.b});
  const bool dark = !(most > 0) || !std::isfinite(most);
  Json light{{"name", source.mName.C_Str()}, {"intensity", dark ? 0 : most}};
  if (!dark)
    light["color"] = {std::max(color.r, 0.0f) / most, std::max(color.g, 0.0f) / most,
                      std::max(color.b, 0.0f) / most};
  light["type"] = source.mType == aiLightSource_DIRECTIONAL ? "directional" : "point";
  if (source.mType != aiLightSource_DIRECTIONAL && source.mAttenuationLinear == 0 &&
      source.mAttenuationQuadratic == 0)
    light["extras"] = {{"falloff", "none"}, {"intensity", light["intensity"]}};
  if (source.mType != aiLightSource_SPOT) return light;
  constexpr float widest = std::numbers::pi_v<float> / 2;
  const float angle = by_collada ? source.mAngleInnerCone : source.mAngleOuterCone;
  const float outer = std::clamp(angle / 2, 1e-3f, widest);
  light["type"] = "spot";
  light["spot"] = {{"outerConeAngle", outer},
                   {"innerConeAngle", std::clamp(source.mAngleInnerCone / 2, 0.0f, outer * 0.999f)}};
  return light;
}

/// Times in seconds that rise, and the values at them.
template <class Key>
void collect_track(const Key* keys, unsigned count, double ticks_per_second, std::vector<float>& times,
                   std::vector<float>& values) {
  for (unsigned i = 0; i < count; ++i) {
    const auto time = static_cast<float>(keys[i].mTime / ticks_per_second);
    if (!(time >= 0) || !std::isfinite(time) || (!times.empty() && time <= times.back())) continue;
    times.push_back(time);
    for (const Json& part : list(keys[i].mValue)) values.push_back(part.get<float>());
  }
}

}  // namespace

GltfWriter::GltfWriter(const aiScene& scene, const std::filesystem::path& folder)
    : scene_(scene), folder_(folder) {
  add_materials();
  add_nodes();
  add_lights();
  add_cameras();
  add_animations();
  if (is_of("Blender"))
    leave_out(
        "Assimp knows .blend files of Blender up to 2.7, and not all that they hold: what is missing is in a "
        "glTF "
        "that Blender exports.");
  if (is_of("Industry Foundation Classes"))
    leave_out(
        "Assimp knows most shapes of IFC2x3, not all: what is missing is in a glTF that Blender with Bonsai "
        "exports.");
}

bool GltfWriter::is_of(std::string_view program) const {
  aiString format;
  return scene_.mMetaData != nullptr && scene_.mMetaData->Get(AI_METADATA_SOURCE_FORMAT, format) &&
         std::string_view(format.C_Str()).starts_with(program);
}

void GltfWriter::leave_out(const char* sentence) {
  if (std::find(left_out_.begin(), left_out_.end(), sentence) == left_out_.end())
    left_out_.emplace_back(sentence);
}

/// Without recursion: a file may nest nodes as deep as it likes.
void GltfWriter::add_nodes() {
  std::vector<std::pair<const aiNode*, std::size_t>> open;  // with their parents' index
  constexpr std::size_t no_parent = ~std::size_t{0};
  if (scene_.mRootNode != nullptr) open.emplace_back(scene_.mRootNode, no_parent);
  std::vector<std::pair<const aiNode*, std::size_t>> with_meshes;
  while (!open.empty()) {
    const auto [node, parent] = open.back();
    open.pop_back();
    Json written{{"name", node->mName.C_Str()}};
    if (!node->mTransformation.IsIdentity()) written["matrix"] = matrix_of(node->mTransformation);
    const std::size_t index = glb_.add("nodes", std::move(written));
    nodes_.push_back(node);
    node_index_.try_emplace(node->mName.C_Str(), index);
    if (parent != no_parent) glb_.json["nodes"][parent]["children"].push_back(index);
    if (node->mNumMeshes > 0) with_meshes.emplace_back(node, index);
    for (unsigned i = node->mNumChildren; i-- > 0;) open.emplace_back(node->mChildren[i], index);
  }
  for (const auto& [node, index] : with_meshes)
    if (Json mesh = mesh_of(*node); !mesh.is_null()) {
      glb_.json["nodes"][index]["mesh"] = std::move(mesh);
      add_skin(*node, glb_.json["nodes"][index]);
    }
  if (scene_.mRootNode != nullptr) glb_.json["scenes"] = {{{"nodes", {0}}}};
  glb_.json["scene"] = 0;
}

/// A node below the one of that name, else at the top.
void GltfWriter::hang(const aiString& name, const aiMatrix4x4& placed, Json content) {
  content["name"] = name.C_Str();
  content["matrix"] = matrix_of(placed);
  const std::size_t index = glb_.add("nodes", std::move(content));
  const auto parent = node_index_.find(name.C_Str());
  if (parent != node_index_.end())
    glb_.json["nodes"][parent->second]["children"].push_back(index);
  else
    glb_.json["scenes"][0]["nodes"].push_back(index);
}

void GltfWriter::add_lights() {
  Json lights = Json::array();
  const bool by_collada = is_of("Collada");
  for (unsigned i = 0; i < scene_.mNumLights; ++i) {
    const aiLight& source = *scene_.mLights[i];
    if (source.mType == aiLightSource_AMBIENT || source.mType == aiLightSource_UNDEFINED) {
      leave_out("A light of no place and direction is left out.");
      continue;
    }
    hang(source.mName, looking(source.mPosition, source.mDirection, source.mUp),
         {{"extensions", {{"KHR_lights_punctual", {{"light", lights.size()}}}}}});
    lights.push_back(light_of(source, by_collada));
  }
  if (lights.empty()) return;
  glb_.json["extensionsUsed"] = {"KHR_lights_punctual"};
  glb_.json["extensions"]["KHR_lights_punctual"]["lights"] = std::move(lights);
}

void GltfWriter::add_cameras() {
  for (unsigned i = 0; i < scene_.mNumCameras; ++i) {
    const aiCamera& source = *scene_.mCameras[i];
    constexpr float film = 16.0f / 9, narrowest = 0.01f, widest = 3;  // film: where the file has no aspect
    const float aspect = source.mAspect > 0 && std::isfinite(source.mAspect) ? source.mAspect : film;
    const float across =
        std::isfinite(source.mHorizontalFOV) ? std::clamp(source.mHorizontalFOV, narrowest, widest) : 1;
    Json camera{{"name", source.mName.C_Str()},
                {"type", "perspective"},
                {"perspective", {{"yfov", 2 * std::atan(std::tan(across / 2) / aspect)}, {"znear", 0.01}}}};
    hang(source.mName, looking(source.mPosition, source.mLookAt, source.mUp),
         {{"camera", glb_.add("cameras", std::move(camera))}});
  }
}

void GltfWriter::add_track(const std::vector<float>& times, const std::vector<float>& values,
                           const char* type, const char* path, std::size_t node, Json& animation) {
  if (times.empty()) return;
  const std::size_t input = glb_.add_accessor(times.data(), times.size(), float_component, "SCALAR");
  const std::size_t count = std::string_view(type) == "SCALAR" ? values.size() : times.size();
  animation["samplers"].push_back(
      {{"input", input}, {"output", glb_.add_accessor(values.data(), count, float_component, type)}});
  animation["channels"].push_back(
      {{"sampler", animation["samplers"].size() - 1}, {"target", {{"node", node}, {"path", path}}}});
}

void GltfWriter::add_animations() {
  for (unsigned i = 0; i < scene_.mNumAnimations; ++i) {
    const aiAnimation& source = *scene_.mAnimations[i];
    const double ticks = source.mTicksPerSecond > 0 ? source.mTicksPerSecond : 25;
    Json animation{{"name", source.mName.C_Str()}, {"channels", Json::array()}, {"samplers", Json::array()}};
    for (unsigned c = 0; c < source.mNumChannels; ++c) {
      const aiNodeAnim& channel = *source.mChannels[c];
      const auto found = node_index_.find(channel.mNodeName.C_Str());
      if (found == node_index_.end()) continue;
      Json& node = glb_.json["nodes"][found->second];
      if (node.contains("matrix")) {
        aiVector3D scale, place;
        aiQuaternion turn;
        nodes_[found->second]->mTransformation.Decompose(scale, turn, place);
        node.erase("matrix");
        node["translation"] = list(place);
        node["rotation"] = list(turn);
        node["scale"] = list(scale);
      }
      const auto add = [&](const auto* keys, unsigned count, const char* type, const char* path) {
        std::vector<float> times, values;
        collect_track(keys, count, ticks, times, values);
        add_track(times, values, type, path, found->second, animation);
      };
      add(channel.mPositionKeys, channel.mNumPositionKeys, "VEC3", "translation");
      add(channel.mRotationKeys, channel.mNumRotationKeys, "VEC4", "rotation");
      add(channel.mScalingKeys, channel.mNumScalingKeys, "VEC3", "scale");
    }
    for (unsigned c = 0; c < source.mNumMorphMeshChannels; ++c)
      add_weights(*source.mMorphMeshChannels[c], ticks, animation);
    if (!animation["channels"].empty()) glb_.add("animations", std::move(animation));
  }
}

}  // namespace tenebra::converter
