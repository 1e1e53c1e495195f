#include "scene_summary.h"

#include "scene_choice.h"

namespace tenebra::viewer {
namespace {

void extend(std::optional<Bounds>& bounds, glm::vec3 point) {
  if (!bounds) bounds = Bounds{point, point};
  bounds->low = glm::min(bounds->low, point);
  bounds->high = glm::max(bounds->high, point);
}

}  // namespace

SceneSummary summarize_scene(const Scene& scene) {
  const int clip = scene.clips.empty() ? -1 : 0;
  const double time_s = time_of_frame(scene, clip, 0, 30.0);  // frame 0 is the begin at any frame rate
  FrameGeometry geometry;
  evaluate_frame(scene, clip, time_s, geometry);
  SceneSummary summary;
  summary.vertices = geometry.positions.size();
  summary.dropped_non_finite = geometry.dropped_non_finite;
  summary.lights = evaluate_lights(scene, clip, time_s);
  for (std::size_t i = 0; i < geometry.triangles.size(); ++i) {
    const glm::uvec3 corners = geometry.triangles[i];
    if (corners == glm::uvec3(0)) continue;  // dropped
    ++summary.triangles;
    summary.casting_triangles += geometry.casts_shadow[i];
    for (int corner = 0; corner < 3; ++corner) extend(summary.bounds, geometry.positions[corners[corner]]);
  }
  return summary;
}

}  // namespace tenebra::viewer
