// A scene of each kind, small enough to be drawn hundreds of times.
#pragma once

#include <vector>

#include "render/render_fixture.h"
#include "stage/cutout/cutout.h"
#include "stage/looks.h"

namespace tenebra {

struct SmallScene {
  const char* name;
  Scene scene;
};

namespace small_scenes {

inline Light lamp() {
  Light light;
  light.falloff = Falloff::none;
  light.intensity = 0.8f;
  return light;
}

inline Scene plate_with_lamp() {
  Scene scene = white_floor(true);
  scene.ambient_light = glm::vec3(0.2f);
  add_light(scene, lamp(), {1, 5, 0.5f});
  return scene;
}

/// A pane that colours light, above the plate's edge, and a blended one on edge.
inline Scene glass() {
  Scene scene = plate_with_lamp();
  Material pane{.name = "pane", .base_color = {0.75f, 0.5f, 0.25f}};
  pane.transmission = 1;
  pane.tinted_transmission = true;
  Material veil{.name = "veil", .alpha_mode = AlphaMode::blend, .alpha = 0.5f};
  scene.materials.insert(scene.materials.end(), {pane, veil});
  Mesh mesh{.name = "panes"};
  add_quad(mesh, {-2, 2, 1.5f}, {3, 0, 0}, {0, 0, -2}, 1);
  add_quad(mesh, {1.5f, 0, 2}, {0, 2, 0}, {0, 0, -3}, 2);
  add_mesh(scene, std::move(mesh));
  return scene;
}

/// Any of them without pictures and gloss, as --surfaces plain has them.
inline Scene plain(Scene scene) {
  stage::make_plain(scene);
  return scene;
}

/// A sheet with holes, cut along its texture's alpha.
inline Scene cut_outs() {
  Scene scene = plate_with_lamp();
  TextureImage holes{.name = "holes", .width = 8, .height = 8, .rgba = {}};
  for (int i = 0; i < 64; ++i) {
    const bool open = (i % 8 - 3) * (i / 8 - 3) % 2 != 0;
    holes.rgba.insert(holes.rgba.end(), {200, 220, 90, static_cast<std::uint8_t>(open ? 0 : 255)});
  }
  scene.images.push_back(holes);
  Material sheet{.name = "sheet", .alpha_mode = AlphaMode::mask};
  sheet.base_color_map.image = 0;
  scene.materials.push_back(sheet);
  Mesh mesh{.name = "sheet"};
  add_quad(mesh, {-2, 2, 2}, {4, 0, 0}, {0, 0, -4}, 1);
  mesh.texture_coordinates[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  add_mesh(scene, std::move(mesh));
  stage::cut_out_masks(scene);
  return scene;
}

/// A rectangle of its own, and a quad that emits.
inline Scene area_light() {
  Scene scene = white_floor(true);
  Light panel = lamp();
  panel.type = LightType::area_rect;
  panel.falloff = Falloff::inverse_square;
  panel.intensity = 2;
  panel.size_m = {1.5f, 1};
  add_light(scene, panel, {-1, 4, 1}, facing_down);
  Material glow{.name = "glow", .emissive = glm::vec3(3.0f)};
  scene.materials.push_back(glow);
  Mesh mesh{.name = "glow"};
  add_quad(mesh, {2, 3, -1}, {0, 0, 1}, {1, 0, 0}, 1);
  add_mesh(scene, std::move(mesh));
  return scene;
}

/// A sphere-like body with smooth normals under a sun, in textured dress.
inline Scene sunlit() {
  Scene scene = white_floor(true);
  Light sun = lamp();
  sun.type = LightType::directional;
  add_light(scene, sun, {0, 0, 0}, {std::cos(0.55), -std::sin(0.55), 0, 0});
  scene.images.push_back({.name = "checks",
                          .width = 2,
                          .height = 2,
                          .rgba = {255, 40, 40, 255, 40, 255, 40, 255, 40, 255, 40, 255, 255, 40, 40, 255}});
  Material dress{.name = "dress", .model = SurfaceModel::metallic_roughness, .roughness = 0.4f};
  dress.base_color_map.image = 0;
  scene.materials.push_back(dress);
  Mesh mesh{.name = "body"};
  const glm::vec3 corners[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (const glm::vec3 corner : corners) {
    mesh.positions.push_back(corner + glm::vec3(2, 1.5f, 1));
    mesh.normals.push_back(corner);
    mesh.texture_coordinates[0].push_back({corner.x + corner.y, corner.z - corner.y});
  }
  mesh.triangles = {{2, 4, 0}, {2, 0, 5}, {2, 5, 1}, {2, 1, 4}, {3, 0, 4}, {3, 5, 0}, {3, 1, 5}, {3, 4, 1}};
  mesh.materials.assign(mesh.triangles.size(), 1);
  add_mesh(scene, std::move(mesh));
  return scene;
}

inline Scene one_triangle() {
  Scene scene;
  scene.materials.push_back({.name = "white"});
  Mesh mesh{.name = "triangle"};
  mesh.positions = {{-3, 0, 3}, {3, 0, 3}, {0, 1, -3}};
  mesh.triangles = {{0, 1, 2}};
  mesh.materials = {0};
  add_mesh(scene, std::move(mesh));
  add_light(scene, lamp(), {0, 5, 0});
  return scene;
}

}  // namespace small_scenes

inline std::vector<SmallScene> scenes_of_each_kind() {
  using namespace small_scenes;
  Scene nothing;
  nothing.ambient_light = glm::vec3(1.0f);
  return {{"glass", glass()},
          {"plain glass", plain(glass())},
          {"cut-outs", cut_outs()},
          {"area light", area_light()},
          {"sun", sunlit()},
          {"no light", white_floor(true)},
          {"one triangle", one_triangle()},
          {"nothing", nothing}};
}

}  // namespace tenebra
