// What a scene holds, counted: the content of `tenebra info`.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include <tenebra/frame_geometry.h>

namespace tenebra::viewer {

struct Bounds {
  glm::vec3 low{0.0f};
  glm::vec3 high{0.0f};
};

/// The first frame of the first clip (or the rest pose), and what it is made of.
struct SceneSummary {
  std::size_t triangles = 0;  ///< drawn: visible, finite, instances counted
  std::size_t casting_triangles = 0;
  std::size_t dropped_non_finite = 0;
  std::size_t vertices = 0;
  std::optional<Bounds> bounds;  ///< world space, of the drawn triangles; none without triangles
  std::vector<WorldLight> lights;
};

SceneSummary summarize_scene(const Scene& scene);

}  // namespace tenebra::viewer
