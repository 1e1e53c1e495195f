// One mesh compressed by Draco, decoded. libdraco is named in draco_decoder.cpp alone.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace tenebra::formats {

/// Memory of the decoder for each face and each vertex, attributes not counted: its corner tables and maps.
inline constexpr std::uint64_t draco_bytes_per_element = 200;

/// What the file states beside the compressed bytes. More than that is refused before it is decoded.
struct DracoLimits {
  std::uint64_t faces = 0;
  std::uint64_t vertices = 0;
  std::uint64_t bytes = 0;  ///< of everything that is wanted
};

class DracoMesh {
public:
  /// Throws ImportFailure naming `place`: broken data, or other numbers of faces and vertices than stated.
  DracoMesh(std::string_view stored, const DracoLimits& limits, const std::string& place);
  ~DracoMesh();
  DracoMesh(const DracoMesh&) = delete;
  DracoMesh& operator=(const DracoMesh&) = delete;

  /// Three vertices for each face, as values of glTF's `component_type` (5121, 5123, 5125).
  std::string indices(int component_type) const;
  /// Values of the attribute with that unique id at each vertex, tightly packed. Throws ImportFailure.
  std::string attribute(std::uint32_t id, int component_type, int components, const std::string& place) const;

private:
  struct Decoded;
  std::unique_ptr<Decoded> decoded_;
  std::string place_;
};

}  // namespace tenebra::formats
