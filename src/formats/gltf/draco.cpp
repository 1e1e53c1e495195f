// KHR_draco_mesh_compression: primitives of compressed data get views and accessors like any other's.
#include <fmt/core.h>
#include <algorithm>

#include "formats/gltf/model.h"

#ifdef TENEBRA_DRACO
#include "formats/gltf/draco_decoder.h"
#endif

namespace tenebra::formats::gltf {
namespace {

constexpr const char* extension_name = "KHR_draco_mesh_compression";

bool has_view(const Asset& asset, int accessor) {
  return asset.model.accessors[static_cast<std::size_t>(accessor)].bufferView >= 0;
}

/// Whether everything that is compressed also stands uncompressed in the file.
bool has_fallback(const Asset& asset, const tinygltf::Primitive& primitive, const Value& attributes) {
  if (primitive.indices >= 0 && !has_view(asset, primitive.indices)) return false;
  for (const auto& [name, accessor] : primitive.attributes)
    if (attributes.Has(name) && !has_view(asset, accessor)) return false;
  return true;
}

#ifdef TENEBRA_DRACO

std::string_view stored_bytes(const Asset& asset, const Value& extension, const std::string& place) {
  const auto index = static_cast<std::size_t>(number_or(extension, "bufferView", 0));
  const auto& view = asset.model.bufferViews[index];
  const std::string& buffer = asset.buffers[static_cast<std::size_t>(view.buffer)];
  if (view.byteOffset > buffer.size() || view.byteLength > buffer.size() - view.byteOffset)
    refuse(
        "{}: found bufferViews[{}] of {} bytes from offset {}, expected them within the {} bytes of its "
        "buffer",
        place, index, view.byteLength, view.byteOffset, buffer.size());
  return std::string_view(buffer).substr(view.byteOffset, view.byteLength);
}

/// Puts `bytes` behind `accessor` of the file, or behind a copy of it where it has bytes already.
int give_bytes(Asset& asset, int accessor, std::string bytes) {
  auto& accessors = asset.model.accessors;
  auto result = static_cast<std::size_t>(accessor);
  if (accessors[result].bufferView >= 0) {
    accessors.push_back(Accessor(accessors[result]));
    result = accessors.size() - 1;
  }
  accessors[result].bufferView = static_cast<int>(asset.model.bufferViews.size());
  accessors[result].byteOffset = 0;
  asset.model.bufferViews.emplace_back();
  set_view(asset, asset.model.bufferViews.back(), std::move(bytes));
  return static_cast<int>(result);
}

std::uint64_t element_bytes(const Accessor& accessor) {
  const int size = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType));
  const int components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
  return static_cast<std::uint64_t>(std::max(size, 1)) * static_cast<std::uint64_t>(std::max(components, 1));
}

/// Vertices that the primitive's accessors state; all compressed ones must agree.
std::uint64_t stated_vertices(const Asset& asset, const tinygltf::Primitive& primitive,
                              const Value& attributes, const std::string& place) {
  std::uint64_t count = 0;
  for (const auto& [name, index] : primitive.attributes) {
    if (!attributes.Has(name)) continue;
    const Accessor& accessor = asset.model.accessors[static_cast<std::size_t>(index)];
    if (count != 0 && accessor.count != count)
      refuse("{}: found {} of {} elements beside others of {}, expected the same number", place, name,
             accessor.count, count);
    count = accessor.count;
  }
  if (count == 0) refuse("{}.attributes: found none that the primitive has, expected at least one", place);
  return count;
}

void decode_primitive(Asset& asset, tinygltf::Primitive& primitive, const Value& extension,
                      const std::string& place) {
  if (primitive.mode != -1 && primitive.mode != TINYGLTF_MODE_TRIANGLES &&
      primitive.mode != TINYGLTF_MODE_TRIANGLE_STRIP)
    refuse("{}: found primitives of mode {}, expected triangles", place, primitive.mode);
  if (primitive.indices < 0) refuse("{}: found a primitive without indices, expected them", place);
  const Value& attributes = extension.Get("attributes");
  const std::string_view stored = stored_bytes(asset, extension, place);
  const std::uint64_t vertices = stated_vertices(asset, primitive, attributes, place);
  const Accessor& indices = asset.model.accessors[static_cast<std::size_t>(primitive.indices)];
  std::uint64_t decoded = indices.count * element_bytes(indices);
  for (const auto& [name, index] : primitive.attributes)
    if (attributes.Has(name))
      decoded += vertices * element_bytes(asset.model.accessors[static_cast<std::size_t>(index)]);
  pay_for_decoded(asset, stored.size(), decoded, place);
  Budget passing = asset.budget;  // what the decoder needs lives only as long as it
  passing.take(indices.count / 3 + vertices, draco_bytes_per_element, place);
  passing.take(decoded, 8, place);

  const DracoMesh mesh(stored, {indices.count / 3, vertices, decoded}, place);
  primitive.indices = give_bytes(asset, primitive.indices, mesh.indices(indices.componentType));
  primitive.mode = TINYGLTF_MODE_TRIANGLES;  // faces, whatever the primitive had before it was compressed
  for (auto& [name, index] : primitive.attributes) {
    if (!attributes.Has(name)) continue;
    const Accessor& accessor = asset.model.accessors[static_cast<std::size_t>(index)];
    const auto id = static_cast<std::uint32_t>(attributes.Get(name).GetNumberAsInt());
    index = give_bytes(asset, index,
                       mesh.attribute(id, accessor.componentType, component_count(accessor),
                                      fmt::format("{}.attributes.{}", place, name)));
  }
}

#else

void decode_primitive(Asset&, tinygltf::Primitive&, const Value&, const std::string& place) {
  refuse("{}: found compressed geometry, expected a build with Draco (package libdraco-dev)", place);
}

#endif

}  // namespace

void decode_draco(Asset& asset) {
  for (std::size_t m = 0; m < asset.model.meshes.size(); ++m) {
    auto& primitives = asset.model.meshes[m].primitives;
    for (std::size_t p = 0; p < primitives.size(); ++p) {
      const auto found = primitives[p].extensions.find(extension_name);
      if (found == primitives[p].extensions.end()) continue;
      if (has_fallback(asset, primitives[p], found->second.Get("attributes"))) continue;
      decode_primitive(asset, primitives[p], found->second,
                       fmt::format("meshes[{}].primitives[{}].extensions.{}", m, p, extension_name));
    }
  }
}

}  // namespace tenebra::formats::gltf
