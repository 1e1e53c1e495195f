// A closed room of six walls, each with its own part of the second set of texture coordinates.
#pragma once

#include <array>

#include "bake/baked_scene.h"
#include "bake/surface_light.h"

namespace tenebra::testing {

/// Walls of a box seen from within. In the map they lie in cells of 3 x 2 with room between them, or, with
/// `gaps` 0, edge to edge.
inline Scene box_room(glm::vec3 low, glm::vec3 high, float gap = 0.02f) {
  Mesh mesh;
  mesh.name = "room";
  const glm::vec3 d = high - low, x(d.x, 0, 0), y(0, d.y, 0), z(0, 0, d.z);
  const std::array<std::array<glm::vec3, 3>, 6> walls{
      {{low, z, x}, {low + y, x, z}, {low, x, y}, {low + z, y, x}, {low, y, z}, {low + x, z, y}}};
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const auto [corner, a, b] = walls[i];
    const glm::vec2 cell(static_cast<float>(i % 3) / 3, static_cast<float>(i / 3) / 2), size(1.0f / 3, 0.5f);
    for (const glm::vec2 at : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)}) {
      mesh.positions.push_back(corner + at.x * a + at.y * b);
      mesh.texture_coordinates[1].push_back(cell + size * (gap + (1 - 2 * gap) * at));
    }
    for (const glm::uvec3 t : {glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)}) {
      mesh.triangles.push_back(first + t);
      mesh.materials.push_back(0);
    }
  }
  Scene scene;
  scene.materials.resize(1);
  scene.meshes.push_back(std::move(mesh));
  scene.nodes.resize(1);
  scene.nodes[0].mesh = 0;
  return scene;
}

/// Adds a point light, or a rectangle of 2 x 1 m that faces down.
inline void add_light(Scene& scene, LightType type, glm::vec3 place) {
  Light light;
  light.type = type;
  light.intensity = 100;
  light.size_m = {2, 1};
  Node node;
  node.light = static_cast<int>(scene.lights.size());
  node.translation = glm::dvec3(place);
  if (type == LightType::area_rect) node.rotation = {0.70710678, -0.70710678, 0, 0};  // -Z to -Y
  scene.lights.push_back(light);
  scene.nodes.push_back(node);
}

struct MapRequest {
  int size = 64;
  int per_side = 2;
  bake::LightRequest light;
};

/// The lightmap before it is dilated.
inline bake::BakedMap bake_map(Scene& scene, const MapRequest& request) {
  render::FrameInput input;
  evaluate_frame(scene, -1, 0, input.geometry);
  input.lights = evaluate_lights(scene, -1, 0);
  std::vector<std::string> notes;
  auto light = bake::SurfaceLight::create(scene, input, request.light, notes).value();
  const auto places = bake::place_in_map(scene, input.geometry, request.size).value();
  const bake::TexelCoverage coverage(places.triangles, request.size, request.per_side);
  bake::BakedMap map(request.size);
  std::vector<bake::Sample> samples;
  for (int row = 0; row < request.size; row += bake::TexelCoverage::band_rows) {
    coverage.samples_of_band(row, samples);
    bake::move_inside(input.geometry, bake::edge_margin(bake::extent_of(input.geometry)), samples);
    std::vector<bake::Light> values(samples.size());
    if (!light.at(samples, values, nullptr, {})) return bake::BakedMap();
    bake::add_means(samples, values, map);
  }
  return map;
}

}  // namespace tenebra::testing
