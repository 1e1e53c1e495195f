// What MTL files say, and what our materials make of it.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/images/scene_images.h"

namespace tenebra::formats {

/// A picture that a material names. Its options are in OBJ's sense: v points up.
struct MtlMap {
  std::string statement;  ///< in lower case: "map_kd", "bump"
  std::string written;    ///< as the file writes it
  std::string picture;    ///< file name, blanks included
  glm::vec2 scale{1}, offset{0};
  float bump = 1;  ///< -bm
  bool clamp = false;
};

/// One material. What the file does not state is not set.
struct MtlMaterial {
  std::string name;     ///< what follows newmtl, without a comment
  std::string written;  ///< the same with the comment
  glm::vec3 diffuse{0.6f}, specular{0}, emission{0};
  std::optional<float> shininess, dissolve, transparency, roughness, metallic;
  int illumination = -1;  ///< one of the format's models
  std::vector<MtlMap> maps;

  /// The last of `maps` with one of these statements, or null.
  const MtlMap* map(std::initializer_list<std::string_view> statements) const;
};

/// Of all MTL files of a scene together: each costs about a kilobyte, and eight bytes of a file.
inline constexpr std::size_t most_materials = 100'000;

/// Appends the materials of an MTL text, whose `file` name the sentences in `warnings` begin with. False:
/// there are more than most_materials; the rest of the text is not read.
bool parse_mtl(std::string_view text, const std::string& file, std::vector<MtlMaterial>& materials,
               std::vector<std::string>& warnings);

/// Appends `sources` to the scene's materials, in order, and names what is not used.
void add_materials(const std::vector<MtlMaterial>& sources, SceneImages& images, Scene& scene);

/// For each of `names`, as they stand behind usemtl, its index in `materials`, with comments on both sides or
/// on none; -1: none. Of two with one name the first.
std::vector<int> find_materials(const std::vector<MtlMaterial>& materials,
                                const std::vector<std::string>& names);

}  // namespace tenebra::formats
