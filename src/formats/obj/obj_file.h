// What an OBJ file says, as tables; nothing is placed, looked up or made from it yet.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace tenebra::formats {

/// A corner of a face: indices from 0 into the tables below. Of coordinates and normal -1 is none, and they
/// may point beyond their tables.
struct Corner {
  std::uint32_t position = 0;
  std::int32_t coordinates = -1;
  std::int32_t normal = -1;
};

struct ObjFile {
  std::vector<glm::dvec3> positions;   ///< as the file has them; may not be finite
  std::vector<glm::vec3> colors;       ///< one for each position, or none at all; not_colored: not stated
  std::vector<glm::vec2> coordinates;  ///< the file's sense: v points up
  std::vector<glm::vec3> normals;      ///< of any length
  std::vector<Corner> corners;         ///< of all faces, one face after another
  std::vector<std::uint32_t> faces;    ///< how many corners each has, three or more

  /// Faces from `first_face` to the next shape's, under the name of their group or object.
  struct Shape {
    std::string name;
    std::size_t first_face = 0;
  };
  std::vector<Shape> shapes;
  /// Faces from `first_face` to the next use's have material_names[name]; -1: none.
  struct Use {
    std::int32_t name = -1;
    std::size_t first_face = 0, line = 0;
  };
  std::vector<Use> uses;
  std::vector<std::string> material_names;  ///< what follows usemtl, comments included; each once
  std::vector<std::string> libraries;       ///< what follows mtllib, comments included; each once
  std::vector<std::string> warnings;        ///< what was passed over

  static constexpr glm::vec3 not_colored{-1.0f};
};

/// Reads an OBJ text. Throws ImportFailure, naming the line, where the surface is in doubt: positions that
/// are no numbers, faces of positions that are not there.
ObjFile parse_obj(std::string_view text);

}  // namespace tenebra::formats
