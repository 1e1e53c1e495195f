#include <algorithm>
#include <cmath>

#include "gltf_writer.h"

namespace tenebra::converter {
namespace {

constexpr int float_component = 5126, word_component = 5125, short_component = 5123;

bool has_triangles(const aiMesh& mesh) {
  return mesh.mNumVertices > 0 && std::any_of(mesh.mFaces, mesh.mFaces + mesh.mNumFaces,
                                              [](const aiFace& face) { return face.mNumIndices == 3; });
}

/// glTF's order: columns.
void append(const aiMatrix4x4& matrix, std::vector<float>& values) {
  for (unsigned column = 0; column < 4; ++column)
    for (unsigned row = 0; row < 4; ++row) values.push_back(matrix[row][column]);
}

}  // namespace

void GltfWriter::add_colors_and_coordinates(const aiMesh& mesh, Json& attributes) {
  // Those of .blend come in bytes, and few of its materials use them.
  if (mesh.HasVertexColors(0) && !is_of("Blender"))
    attributes["COLOR_0"] = glb_.add_accessor(mesh.mColors[0], mesh.mNumVertices, float_component, "VEC4");
  for (unsigned set = 0; set < 2 && mesh.HasTextureCoords(set); ++set) {
    std::vector<float> values;
    values.reserve(2 * std::size_t{mesh.mNumVertices});
    for (unsigned i = 0; i < mesh.mNumVertices; ++i)
      for (const float part : {mesh.mTextureCoords[set][i].x, mesh.mTextureCoords[set][i].y})
        values.push_back(std::isfinite(part) ? part : 0);
    attributes[set == 0 ? "TEXCOORD_0" : "TEXCOORD_1"] =
        glb_.add_accessor(values.data(), mesh.mNumVertices, float_component, "VEC2");
  }
}

Json GltfWriter::primitive(const aiMesh& mesh) {
  Json attributes{
      {"POSITION", glb_.add_accessor(mesh.mVertices, mesh.mNumVertices, float_component, "VEC3")}};
  if (mesh.HasNormals()) {
    std::vector<aiVector3D> normals(mesh.mNormals, mesh.mNormals + mesh.mNumVertices);
    for (aiVector3D& normal : normals) {
      const float length = normal.Length();
      normal = std::isfinite(length) && length > 0 ? normal / length : aiVector3D(0, 1, 0);
    }
    attributes["NORMAL"] = glb_.add_accessor(normals.data(), normals.size(), float_component, "VEC3");
  }
  add_colors_and_coordinates(mesh, attributes);
  std::vector<std::uint32_t> corners;
  corners.reserve(3 * std::size_t{mesh.mNumFaces});
  for (unsigned i = 0; i < mesh.mNumFaces; ++i)
    if (mesh.mFaces[i].mNumIndices == 3)
      corners.insert(corners.end(), mesh.mFaces[i].mIndices, mesh.mFaces[i].mIndices + 3);
  Json written{{"attributes", std::move(attributes)},
               {"indices", glb_.add_accessor(corners.data(), corners.size(), word_component, "SCALAR")}};
  if (Json targets = morph_targets(mesh); !targets.is_null()) written["targets"] = std::move(targets);
  if (mesh.mMaterialIndex < scene_.mNumMaterials) written["material"] = mesh.mMaterialIndex;
  return written;
}

/// The mesh of a node, null without triangles. Nodes with the same ones share it, but for skins.
Json GltfWriter::mesh_of(const aiNode& node) {
  std::vector<const aiMesh*> parts;
  for (unsigned i = 0; i < node.mNumMeshes; ++i)
    if (has_triangles(*scene_.mMeshes[node.mMeshes[i]])) parts.push_back(scene_.mMeshes[node.mMeshes[i]]);
  if (parts.empty()) return nullptr;
  const bool bends =
      std::any_of(parts.begin(), parts.end(), [](const aiMesh* m) { return m->mNumBones > 0; });
  if (const auto known = mesh_index_.find(parts); known != mesh_index_.end() && !bends) return known->second;
  Json primitives = Json::array();
  for (const aiMesh* const part : parts) {
    if (const auto known = primitive_of_.find(part); known != primitive_of_.end()) {
      primitives.push_back(known->second);
      continue;
    }
    primitives.push_back(primitive(*part));
    primitive_of_[part] = primitives.back();
  }
  even_out_targets(primitives);
  return mesh_index_[parts] =
             glb_.add("meshes", {{"name", node.mName.C_Str()}, {"primitives", std::move(primitives)}});
}

void GltfWriter::add_influences(const aiMesh& mesh, const std::map<std::string, std::uint16_t>& joints,
                                Json& attributes) {
  constexpr std::size_t most = 4;  // as the import was asked for
  std::vector<std::uint16_t> places(most * mesh.mNumVertices);
  std::vector<float> weights(most * mesh.mNumVertices);
  for (unsigned b = 0; b < mesh.mNumBones; ++b) {
    const aiBone& bone = *mesh.mBones[b];
    for (unsigned w = 0; w < bone.mNumWeights; ++w) {
      const aiVertexWeight& weight = bone.mWeights[w];
      if (weight.mVertexId >= mesh.mNumVertices || !(weight.mWeight > 0)) continue;
      for (std::size_t at = most * weight.mVertexId, end = at + most; at < end; ++at) {
        if (weights[at] != 0) continue;
        weights[at] = weight.mWeight;
        places[at] = joints.at(bone.mName.C_Str());
        break;
      }
    }
  }
  attributes["JOINTS_0"] = glb_.add_accessor(places.data(), mesh.mNumVertices, short_component, "VEC4");
  attributes["WEIGHTS_0"] = glb_.add_accessor(weights.data(), mesh.mNumVertices, float_component, "VEC4");
}

/// Where all meshes of `node` have bones that are nodes: a skin for them.
void GltfWriter::add_skin(const aiNode& node, Json& written) {
  std::map<std::string, std::uint16_t> joints;
  Json joint_nodes = Json::array();
  std::vector<float> inverse_bind;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene_.mMeshes[node.mMeshes[i]];
    if (!has_triangles(mesh)) continue;
    if (mesh.mNumBones == 0) return;
    for (unsigned b = 0; b < mesh.mNumBones; ++b) {
      const aiBone& bone = *mesh.mBones[b];
      const auto place = node_index_.find(bone.mName.C_Str());
      if (place == node_index_.end() || joints.size() > 60'000) return;
      if (!joints.try_emplace(bone.mName.C_Str(), static_cast<std::uint16_t>(joints.size())).second) continue;
      joint_nodes.push_back(place->second);
      append(bone.mOffsetMatrix, inverse_bind);
    }
  }
  Json& primitives = glb_.json["meshes"][written["mesh"].get<std::size_t>()]["primitives"];
  std::size_t next = 0;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene_.mMeshes[node.mMeshes[i]];
    if (has_triangles(mesh)) add_influences(mesh, joints, primitives[next++]["attributes"]);
  }
  written["skin"] =
      glb_.add("skins", {{"joints", std::move(joint_nodes)},
                         {"inverseBindMatrices",
                          glb_.add_accessor(inverse_bind.data(), joints.size(), float_component, "MAT4")}});
}

}  // namespace tenebra::converter
