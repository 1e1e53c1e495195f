// What a scene holds, counted: the content of `tenebra info`.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include <tenebra/frame_geometry.h>

namespace tenebra::session {

struct Bounds {
  glm::vec3 low{0.0f};
  glm::vec3 high{0.0f};
};

/// Triangles by what their materials hold; one may count several times.
struct SurfaceCounts {
  std::size_t textured = 0;  ///< any picture
  std::size_t normal_mapped = 0;
  std::size_t specular = 0;  ///< Phong's or specular-glossiness
  std::size_t metallic = 0;
  std::size_t emissive = 0;
  std::size_t unlit = 0;
  std::size_t colored = 0;  ///< colours of vertices
  std::size_t alpha_mask = 0;
  std::size_t alpha_blend = 0;
  std::size_t transmission = 0;
  std::size_t see_through = 0;  ///< alpha_blend or transmission
};

/// The first frame of the first clip (or the rest pose), and what it is made of.
struct SceneSummary {
  std::size_t triangles = 0;  ///< drawn: visible, finite, instances counted
  std::size_t casting_triangles = 0;
  std::size_t dropped_non_finite = 0;
  std::size_t vertices = 0;
  std::optional<Bounds> bounds;  ///< world space, of the drawn triangles; none without triangles
  std::vector<WorldLight> lights;
  SurfaceCounts surfaces;     ///< of the drawn triangles
  std::size_t instances = 0;  ///< nodes that show a mesh which another node before them shows
  std::size_t channels = 0;   ///< of all clips
};

SceneSummary summarize_scene(const Scene& scene);

/// "point", "area_rect": the name of a type of light wherever one is shown.
std::string_view light_type_name(LightType type);

}  // namespace tenebra::session
