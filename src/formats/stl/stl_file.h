// What an STL file says: triangles whose corners at one place are one vertex; nothing is placed yet.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace tenebra::formats {

struct StlFile {
  /// A solid: vertices and triangles from these to the next solid's.
  struct Solid {
    std::string name;
    std::size_t first_position = 0, first_triangle = 0;
  };
  std::vector<Solid> solids;
  std::vector<glm::dvec3> positions;  ///< as the file has them; may not be finite
  std::vector<glm::uvec3> triangles;  ///< indices into `positions`
  std::vector<std::string> warnings;  ///< what was passed over
  bool floats = false;                ///< positions are floats, not text
  std::size_t colored = 0;            ///< triangles with bytes that some programs use for colours
};

/// Reads ASCII or binary, as the size tells where the first word does not. Throws ImportFailure.
StlFile parse_stl(std::string_view bytes);

}  // namespace tenebra::formats
