#include "session/scene_summary.h"

#include <algorithm>

#include "scene/material_maps.h"

namespace tenebra::session {
namespace {

void extend(std::optional<Bounds>& bounds, glm::vec3 point) {
  if (!bounds) bounds = Bounds{point, point};
  bounds->low = glm::min(bounds->low, point);
  bounds->high = glm::max(bounds->high, point);
}

void count(const Material& material, SurfaceCounts& counts) {
  const auto maps = scene::texture_maps(material);
  counts.textured += std::any_of(maps.begin(), maps.end(), [](const TextureMap* map) { return bool{*map}; });
  counts.normal_mapped += static_cast<bool>(material.normal_map);
  const bool specular_model =
      material.model == SurfaceModel::phong || material.model == SurfaceModel::specular_glossiness;
  counts.specular += specular_model && material.specular != glm::vec3(0);
  counts.metallic += material.model == SurfaceModel::metallic_roughness && material.metallic > 0;
  counts.emissive += material.emissive != glm::vec3(0);
  counts.unlit += material.model == SurfaceModel::unlit;
  counts.alpha_mask += material.alpha_mode == AlphaMode::mask;
  counts.alpha_blend += material.alpha_mode == AlphaMode::blend;
  counts.transmission += material.transmission > 0;
  counts.see_through += material.see_through();
}

std::size_t count_instances(const Scene& scene) {
  std::vector<bool> shown(scene.meshes.size(), false);
  std::size_t instances = 0;
  for (const Node& node : scene.nodes) {
    if (node.mesh < 0) continue;
    const auto mesh = static_cast<std::size_t>(node.mesh);
    instances += shown[mesh];
    shown[mesh] = true;
  }
  return instances;
}

}  // namespace

SceneSummary summarize_scene(const Scene& scene) {
  const int clip = scene.clips.empty() ? -1 : 0;
  const double time_s = scene.clips.empty() ? 0.0 : scene.clips.front().start_s;
  FrameGeometry geometry;
  evaluate_frame(scene, clip, time_s, geometry);
  SceneSummary summary;
  summary.vertices = geometry.positions.size();
  summary.dropped_non_finite = geometry.dropped_non_finite;
  summary.lights = evaluate_lights(scene, clip, time_s);
  summary.instances = count_instances(scene);
  for (const Clip& animation : scene.clips) summary.channels += animation.channels.size();
  const SurfaceCoordinates coordinates = surface_coordinates(scene);
  for (std::size_t i = 0; i < geometry.triangles.size(); ++i) {
    const glm::uvec3 corners = geometry.triangles[i];
    if (corners == glm::uvec3(0)) continue;  // dropped
    ++summary.triangles;
    summary.casting_triangles += geometry.casts_shadow[i];
    count(scene.materials[geometry.materials[i]], summary.surfaces);
    if (!coordinates.colors.empty())
      summary.surfaces.colored += coordinates.colors[corners.x] != glm::vec4(1) ||
                                  coordinates.colors[corners.y] != glm::vec4(1) ||
                                  coordinates.colors[corners.z] != glm::vec4(1);
    for (int corner = 0; corner < 3; ++corner) extend(summary.bounds, geometry.positions[corners[corner]]);
  }
  return summary;
}

std::string_view light_type_name(LightType type) {
  switch (type) {
    case LightType::point:
      return "point";
    case LightType::spot:
      return "spot";
    case LightType::directional:
      return "directional";
    case LightType::area_rect:
      return "area_rect";
    case LightType::area_disk:
      return "area_disk";
  }
  return "";
}

}  // namespace tenebra::session
