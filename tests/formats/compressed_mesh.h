// Files with compressed geometry, written by the libraries' own encoders.
#pragma once

#include <glm/glm.hpp>

#include <cmath>

#include "formats/gltf_builder.h"

#ifdef TENEBRA_MESHOPT
#include <meshoptimizer.h>
#endif
#ifdef TENEBRA_DRACO
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>
#endif

namespace tenebra::testing {

/// N x N squares, two triangles each, with heights that no quantization keeps.
struct Grid {
  std::vector<glm::vec3> positions;
  std::vector<std::uint32_t> indices;

  explicit Grid(int n) {
    const auto at = [n](int x, int y) { return static_cast<std::uint32_t>(y * (n + 1) + x); };
    for (int y = 0; y <= n; ++y)
      for (int x = 0; x <= n; ++x)
        positions.emplace_back(0.1f * static_cast<float>(x), 0.1f * static_cast<float>(y),
                               std::sin(0.3f * static_cast<float>(x * y)));
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x)
        for (const std::uint32_t i :
             {at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)})
          indices.push_back(i);
  }
};

/// The bounds that POSITION must have.
inline void add_bounds(Json& accessor, const Grid& grid) {
  glm::vec3 low(INFINITY), high(-INFINITY);
  for (const glm::vec3& p : grid.positions) low = glm::min(low, p), high = glm::max(high, p);
  accessor["min"] = {low.x, low.y, low.z};
  accessor["max"] = {high.x, high.y, high.z};
}

#ifdef TENEBRA_MESHOPT

inline bool has_meshopt() {
  return true;
}

/// Adds a view of `count` elements of `stride` bytes whose compressed bytes are `data`.
inline std::size_t add_compressed(GltfBuilder& file, const std::vector<unsigned char>& data,
                                  std::size_t count, std::size_t stride, const char* mode, const char* filter,
                                  bool state_stride) {
  file.bytes.resize((file.bytes.size() + 3) / 4 * 4, '\0');
  Json& fallback = file.root["extras"]["fallback"];
  const std::size_t offset = fallback.is_null() ? 0 : fallback.get<std::size_t>();
  Json view = {{"buffer", 1}, {"byteOffset", offset}, {"byteLength", count * stride}};
  if (state_stride) view["byteStride"] = stride;
  Json& extension = view["extensions"]["EXT_meshopt_compression"];
  extension = {{"buffer", 0},
               {"byteOffset", file.bytes.size()},
               {"byteLength", data.size()},
               {"byteStride", stride},
               {"count", count},
               {"mode", mode}};
  if (filter) extension["filter"] = filter;
  fallback = offset + (count * stride + 3) / 4 * 4;
  file.bytes.append(reinterpret_cast<const char*>(data.data()), data.size());
  file.root["bufferViews"].push_back(view);
  return file.root["bufferViews"].size() - 1;
}

inline std::vector<unsigned char> encode_vertices(const void* values, std::size_t count, std::size_t stride) {
  std::vector<unsigned char> data(meshopt_encodeVertexBufferBound(count, stride));
  data.resize(meshopt_encodeVertexBuffer(data.data(), data.size(), values, count, stride));
  return data;
}

inline void finish(GltfBuilder& file) {
  file.root["extensionsUsed"] = file.root["extensionsRequired"] = {"EXT_meshopt_compression"};
  file.root["buffers"] = {{{"byteLength", file.bytes.size()}, {"uri", "b.bin"}},
                          {{"byteLength", file.root["extras"]["fallback"]},
                           {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
}

/// View 0 has the positions, view 1 the indices of `index_bytes` bytes.
inline GltfBuilder meshopt_file(const Grid& grid, const std::string& mode, int index_bytes) {
  GltfBuilder file;
  const std::size_t vertices = grid.positions.size(), count = grid.indices.size();
  add_compressed(file, encode_vertices(grid.positions.data(), vertices, 12), vertices, 12, "ATTRIBUTES",
                 nullptr, true);
  std::vector<unsigned char> data;
  if (mode == "TRIANGLES") {
    data.resize(meshopt_encodeIndexBufferBound(count, vertices));
    data.resize(meshopt_encodeIndexBuffer(data.data(), data.size(), grid.indices.data(), count));
  } else {
    data.resize(meshopt_encodeIndexSequenceBound(count, vertices));
    data.resize(meshopt_encodeIndexSequence(data.data(), data.size(), grid.indices.data(), count));
  }
  add_compressed(file, data, count, static_cast<std::size_t>(index_bytes), mode.c_str(), nullptr, false);
  file.root["accessors"] = {
      {{"bufferView", 0}, {"componentType", 5126}, {"count", vertices}, {"type", "VEC3"}},
      {{"bufferView", 1},
       {"componentType", index_bytes == 2 ? 5123 : 5125},
       {"count", count},
       {"type", "SCALAR"}}};
  add_bounds(file.root["accessors"][0], grid);
  file.root["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}};
  file.root["nodes"] = {{{"mesh", 0}}};
  finish(file);
  return file;
}

struct Filtered {
  GltfBuilder file;
  std::vector<double> expected;
};

/// `count` vectors of three floats, of 20 bits each, that share an exponent: from 0.19 on meshoptimizer asks
/// for that.
inline void encode_exponents(char* encoded, std::size_t count, const float* values) {
#if MESHOPTIMIZER_VERSION >= 190
  meshopt_encodeFilterExp(encoded, count, 12, 20, values, meshopt_EncodeExpSharedVector);
#else
  meshopt_encodeFilterExp(encoded, count, 12, 20, values);
#endif
}

/// 64 unit vectors as octahedral normals, quaternions of a rotation, or numbers as exponential positions.
inline Filtered filtered_file(const std::string& filter) {
  constexpr std::size_t count = 64;
  Filtered result;
  std::vector<float> values;
  for (std::size_t i = 0; i < count; ++i) {
    const float a = 0.1f * static_cast<float>(i), b = 0.37f * static_cast<float>(i);
    const glm::vec4 q = glm::normalize(glm::vec4(std::sin(a), std::cos(b), std::sin(b + 1), 1.5f));
    const glm::vec3 n = glm::normalize(glm::vec3(q));
    if (filter == "OCTAHEDRAL") values.insert(values.end(), {n.x, n.y, n.z, 0});
    if (filter == "QUATERNION") values.insert(values.end(), {q.x, q.y, q.z, q.w});
    if (filter == "EXPONENTIAL") values.insert(values.end(), {q.x * 3, q.y, q.z});
    const glm::vec4 kept = filter == "OCTAHEDRAL"   ? glm::vec4(n, 0)
                           : filter == "QUATERNION" ? q
                                                    : glm::vec4(q.x * 3, q.y, q.z, 0);
    for (int c = 0; c < (filter == "QUATERNION" ? 4 : 3); ++c) result.expected.push_back(kept[c]);
  }
  GltfBuilder& file = result.file;
  std::vector<float> line;
  for (std::size_t i = 0; i < count; ++i) line.insert(line.end(), {static_cast<float>(i), 0, 0});
  std::vector<float> times;
  for (std::size_t i = 0; i < count; ++i) times.push_back(static_cast<float>(i));
  const std::size_t positions = file.floats(line, "VEC3", 3, true),
                    input = file.floats(times, "SCALAR", 1, true);
  std::vector<char> encoded(count * 12);
  const std::size_t stride = filter == "EXPONENTIAL" ? 12 : 8;
  if (filter == "OCTAHEDRAL") meshopt_encodeFilterOct(encoded.data(), count, 8, 12, values.data());
  if (filter == "QUATERNION") meshopt_encodeFilterQuat(encoded.data(), count, 8, 14, values.data());
  if (filter == "EXPONENTIAL") encode_exponents(encoded.data(), count, values.data());
  const std::size_t view = add_compressed(file, encode_vertices(encoded.data(), count, stride), count, stride,
                                          "ATTRIBUTES", filter.c_str(), filter != "QUATERNION");
  const bool floats = filter == "EXPONENTIAL";
  file.root["accessors"].push_back({{"bufferView", view},
                                    {"componentType", floats ? 5126 : 5122},
                                    {"normalized", !floats},
                                    {"count", count},
                                    {"type", filter == "QUATERNION" ? "VEC4" : "VEC3"}});
  const std::size_t filtered = file.root["accessors"].size() - 1;
  Json attributes = {{"POSITION", floats ? filtered : positions}};
  if (filter == "OCTAHEDRAL") attributes["NORMAL"] = filtered;
  file.root["meshes"] = {{{"primitives", {{{"attributes", attributes}}}}}};
  file.root["nodes"] = {{{"mesh", 0}}};
  if (filter == "QUATERNION")
    file.root["animations"] = {
        {{"samplers", {{{"input", input}, {"output", filtered}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "rotation"}}}}}}}};
  finish(file);
  file.root["extensionsUsed"].push_back("KHR_mesh_quantization");
  file.root["extensionsRequired"].push_back("KHR_mesh_quantization");
  return result;
}

inline std::vector<double> filtered_values(const Scene& scene, const std::string& filter) {
  if (filter == "QUATERNION") return scene.clips[0].tracks[0].values;
  const Mesh& mesh = scene.meshes[0];
  std::vector<double> values;
  for (const glm::vec3& v : filter == "OCTAHEDRAL" ? mesh.normals : mesh.positions)
    values.insert(values.end(), {v.x, v.y, v.z});
  return values;
}

#else

inline bool has_meshopt() {
  return false;
}
inline GltfBuilder meshopt_file(const Grid&, const std::string&, int) {
  return {};
}
struct Filtered {
  GltfBuilder file;
  std::vector<double> expected;
};
inline Filtered filtered_file(const std::string&) {
  return {};
}
inline std::vector<double> filtered_values(const Scene&, const std::string&) {
  return {};
}

#endif

#ifdef TENEBRA_DRACO

inline bool has_draco() {
  return true;
}

inline std::string encode_draco(const Grid& grid, bool edgebreaker) {
  draco::Mesh mesh;
  const auto points = static_cast<std::uint32_t>(grid.positions.size());
  mesh.set_num_points(points);
  mesh.SetNumFaces(grid.indices.size() / 3);
  for (std::uint32_t f = 0; f < mesh.num_faces(); ++f)
    mesh.SetFace(draco::FaceIndex(f),
                 {draco::PointIndex(grid.indices[3 * f]), draco::PointIndex(grid.indices[3 * f + 1]),
                  draco::PointIndex(grid.indices[3 * f + 2])});
  draco::GeometryAttribute attribute;
  attribute.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, 12, 0);
  const int id = mesh.AddAttribute(attribute, true, points);
  for (std::uint32_t p = 0; p < points; ++p)
    mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(p), &grid.positions[p]);
  mesh.attribute(id)->set_unique_id(7);
  draco::Encoder encoder;
  encoder.SetEncodingMethod(edgebreaker ? draco::MESH_EDGEBREAKER_ENCODING : draco::MESH_SEQUENTIAL_ENCODING);
  draco::EncoderBuffer buffer;
  if (!encoder.EncodeMeshToBuffer(mesh, &buffer).ok()) return {};
  return {buffer.data(), buffer.size()};
}

/// Accessor 0 has the positions, accessor 1 the indices; neither has a view.
inline GltfBuilder draco_file(const Grid& grid, bool edgebreaker) {
  GltfBuilder file;
  const std::size_t view = file.view(encode_draco(grid, edgebreaker));
  file.root["accessors"] = {{{"componentType", 5126}, {"count", grid.positions.size()}, {"type", "VEC3"}},
                            {{"componentType", 5123}, {"count", grid.indices.size()}, {"type", "SCALAR"}}};
  add_bounds(file.root["accessors"][0], grid);
  Json primitive = {{"attributes", {{"POSITION", 0}}}, {"indices", 1}};
  primitive["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", view},
                                                           {"attributes", {{"POSITION", 7}}}};
  file.root["meshes"] = {{{"primitives", {primitive}}}};
  file.root["nodes"] = {{{"mesh", 0}}};
  file.root["extensionsUsed"] = file.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  return file;
}

#else

inline bool has_draco() {
  return false;
}
inline GltfBuilder draco_file(const Grid&, bool) {
  return {};
}

#endif

}  // namespace tenebra::testing
