#include "formats/gltf/draco_decoder.h"

#ifdef TENEBRA_DRACO

#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>

#include <cstring>

#include "formats/import_failure.h"

namespace tenebra::formats {
namespace {

constexpr std::uint32_t most_attributes = 64;

/// A decoder of libdraco that looks at what the data claims before memory is taken for it.
template <class Base>
class Careful : public Base {
public:
  explicit Careful(const DracoLimits& limits) : limits_(limits) {}
  bool claims_too_much() const { return claims_too_much_; }

protected:
  /// The first numbers of the connectivity are vertices and faces, in the order of the method.
  bool DecodeConnectivity() override {
    constexpr bool edgebreaker = std::is_same_v<Base, draco::MeshEdgebreakerDecoder>;
    draco::DecoderBuffer peek = *this->buffer();
    std::uint32_t first = 0, second = 0;
    std::uint8_t tables = 0;
    if (!draco::DecodeVarint(&first, &peek) || !draco::DecodeVarint(&second, &peek)) return false;
    if (edgebreaker && !peek.Decode(&tables)) return false;
    const std::uint32_t faces = edgebreaker ? second : first, vertices = edgebreaker ? first : second;
    // Edgebreaker's vertices are split at seams later; there are never more than corners.
    claims_too_much_ = faces > limits_.faces || vertices > limits_.vertices || tables > most_attributes;
    return !claims_too_much_ && Base::DecodeConnectivity();
  }

  bool DecodeAllAttributes() override {
    const draco::PointCloud& cloud = *this->point_cloud();
    std::uint64_t bytes = 0;
    for (int i = 0; i < cloud.num_attributes(); ++i)
      bytes += static_cast<std::uint64_t>(cloud.attribute(i)->byte_stride()) * cloud.num_points();
    // Attributes that are not wanted are decoded too, and may be wider than what is made of them.
    claims_too_much_ = cloud.num_attributes() > static_cast<int>(most_attributes) ||
                       cloud.num_points() > limits_.vertices || bytes > 4 * limits_.bytes;
    return !claims_too_much_ && Base::DecodeAllAttributes();
  }

private:
  DracoLimits limits_;
  bool claims_too_much_ = false;
};

template <class Base>
void decode_by(draco::DecoderBuffer& buffer, const DracoLimits& limits, draco::Mesh& mesh,
               const std::string& place) {
  Careful<Base> decoder(limits);
  const draco::DecoderOptions options;
  const draco::Status status = decoder.Decode(options, &buffer, &mesh);
  if (decoder.claims_too_much())
    refuse(
        "{}: found data of more faces, vertices or attributes than its accessors state, expected {} faces "
        "and {} vertices",
        place, limits.faces, limits.vertices);
  if (!status.ok()) {
    const std::string& why = status.error_msg_string();
    refuse("{}: found compressed bytes that do not decode ({}), expected a mesh of Draco", place,
           why.substr(0, why.find('\n')));
  }
}

template <class T>
void append(std::string& out, const T* values, std::size_t count) {
  out.append(reinterpret_cast<const char*>(values), count * sizeof(T));
}

template <class T>
std::string values_of(const draco::PointAttribute& attribute, std::uint32_t points, int components,
                      const std::string& place) {
  std::string out;
  out.reserve(std::size_t{points} * static_cast<std::size_t>(components) * sizeof(T));
  T value[16] = {};
  for (draco::PointIndex p(0); p < points; ++p) {
    const draco::AttributeValueIndex index = attribute.mapped_index(p);
    if (index.value() >= attribute.size() ||
        !attribute.ConvertValue<T>(index, static_cast<std::int8_t>(components), value))
      refuse("{}: found a value that does not fit the accessor, expected its component type", place);
    append(out, value, static_cast<std::size_t>(components));
  }
  return out;
}

}  // namespace

struct DracoMesh::Decoded {
  draco::Mesh mesh;
};

DracoMesh::DracoMesh(std::string_view stored, const DracoLimits& limits, const std::string& place)
    : decoded_(std::make_unique<Decoded>()), place_(place) {
  draco::DecoderBuffer buffer;
  buffer.Init(stored.data(), stored.size());
  draco::DecoderBuffer peek = buffer;
  draco::DracoHeader header;
  if (!draco::PointCloudDecoder::DecodeHeader(&peek, &header).ok())
    refuse("{}: found no header of Draco, expected one", place);
  if (header.version_major != 2 || header.version_minor != 2)
    refuse("{}: found version {}.{} of Draco's format, expected 2.2", place, header.version_major,
           header.version_minor);
  if (header.encoder_type != draco::TRIANGULAR_MESH) refuse("{}: found no mesh, expected one", place);
  if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING)
    decode_by<draco::MeshEdgebreakerDecoder>(buffer, limits, decoded_->mesh, place);
  else if (header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING)
    decode_by<draco::MeshSequentialDecoder>(buffer, limits, decoded_->mesh, place);
  else
    refuse("{}: found method {}, expected 0 or 1", place, header.encoder_method);
  const draco::Mesh& mesh = decoded_->mesh;
  if (mesh.num_faces() != limits.faces || mesh.num_points() != limits.vertices)
    refuse("{}: found {} faces and {} vertices, expected the {} and {} of its accessors", place,
           mesh.num_faces(), mesh.num_points(), limits.faces, limits.vertices);
}

DracoMesh::~DracoMesh() = default;

std::string DracoMesh::indices(int component_type) const {
  const draco::Mesh& mesh = decoded_->mesh;
  std::string out;
  for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f)
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t vertex = mesh.face(f)[static_cast<std::size_t>(c)].value();
      const std::size_t size = component_type == 5121 ? 1 : component_type == 5123 ? 2 : 4;
      if (vertex >= mesh.num_points() || (size < 4 && vertex >> (8 * size) != 0))
        refuse("{}: found vertex {} in a face, expected one that the accessor of indices can hold", place_,
               vertex);
      append(out, reinterpret_cast<const char*>(&vertex), size);  // little endian
    }
  return out;
}

std::string DracoMesh::attribute(std::uint32_t id, int component_type, int components,
                                 const std::string& place) const {
  const draco::Mesh& mesh = decoded_->mesh;
  const draco::PointAttribute* found = mesh.GetAttributeByUniqueId(id);
  if (found == nullptr) refuse("{}: found id {}, expected one of the compressed attributes", place, id);
  if (found->num_components() != components || components > 16)
    refuse("{}: found {} components, expected the accessor's {}", place, found->num_components(), components);
  switch (component_type) {
    case 5120:
      return values_of<std::int8_t>(*found, mesh.num_points(), components, place);
    case 5121:
      return values_of<std::uint8_t>(*found, mesh.num_points(), components, place);
    case 5122:
      return values_of<std::int16_t>(*found, mesh.num_points(), components, place);
    case 5123:
      return values_of<std::uint16_t>(*found, mesh.num_points(), components, place);
    case 5125:
      return values_of<std::uint32_t>(*found, mesh.num_points(), components, place);
    default:
      return values_of<float>(*found, mesh.num_points(), components, place);
  }
}

}  // namespace tenebra::formats

#endif
