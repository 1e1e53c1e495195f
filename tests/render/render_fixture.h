// Small scenes with known answers, and one frame of them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/renderer.h"

namespace tenebra {

inline void add_quad(Mesh& mesh, glm::vec3 corner, glm::vec3 u, glm::vec3 v, std::uint32_t material = 0) {
  const auto i = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), {corner, corner + u, corner + u + v, corner + v});
  mesh.triangles.insert(mesh.triangles.end(), {{i, i + 1, i + 2}, {i, i + 2, i + 3}});
  mesh.materials.insert(mesh.materials.end(), {material, material});
}

inline void add_mesh(Scene& scene, Mesh mesh) {
  scene.meshes.push_back(std::move(mesh));
  scene.nodes.push_back(
      {.name = scene.meshes.back().name, .mesh = static_cast<int>(scene.meshes.size()) - 1});
}

inline Light& add_light(Scene& scene, Light light, glm::vec3 position, glm::dquat rotation = {1, 0, 0, 0}) {
  Node node{.translation = position, .rotation = rotation};
  node.light = static_cast<int>(scene.lights.size());
  scene.nodes.push_back(node);
  scene.lights.push_back(std::move(light));
  return scene.lights.back();
}

/// Turns the -Z of a node down, its +Y to -Z.
inline const glm::dquat facing_down{std::sqrt(0.5), -std::sqrt(0.5), 0, 0};

/// A white floor of 20 x 20 at y = 0, with a plate of 2 x 2 at y = 1 above its middle if asked for.
inline Scene white_floor(bool with_plate) {
  Scene scene;
  scene.materials.push_back({.name = "white", .base_color = glm::vec3(1.0f)});
  scene.ambient_light = glm::vec3(0.0f);
  Mesh mesh{.name = "floor"};
  add_quad(mesh, {-10, 0, 10}, {20, 0, 0}, {0, 0, -20});
  if (with_plate) add_quad(mesh, {-1, 1, 1}, {2, 0, 0}, {0, 0, -2});
  add_mesh(scene, std::move(mesh));
  return scene;
}

inline render::FrameInput frame_of(const Scene& scene, int width, int height, glm::vec3 eye = {0, 8, 8}) {
  render::FrameInput input;
  evaluate_frame(scene, -1, 0, input.geometry);
  input.lights = evaluate_lights(scene, -1, 0);
  input.view = look_at(eye, {0, 0, 0}, {0, 1, 0}, 0.8f, 0.1f, width, height);
  return input;
}

inline render::Renderer renderer_for(const Scene& scene, gl::ContextKind kind = gl::ContextKind::automatic) {
  auto context = gl::Context::create(kind);
  EXPECT_TRUE(context) << context.error().message;
  auto renderer = render::Renderer::create(std::move(*context), scene);
  EXPECT_TRUE(renderer) << renderer.error().message;
  return std::move(*renderer);
}

inline render::FrameResult draw(const Scene& scene, const render::RenderSettings& settings,
                                gl::ContextKind kind = gl::ContextKind::automatic) {
  render::Renderer renderer = renderer_for(scene, kind);
  render::FrameResult result;
  const auto drawn =
      renderer.render_frame(frame_of(scene, settings.width, settings.height), settings, result);
  EXPECT_TRUE(drawn) << drawn.error().message;
  return result;
}

/// Where the ray through a pixel's centre meets the plane y = height; nothing if it does not.
inline std::optional<glm::dvec3> on_plane(const ViewRays& view, int x, int y, double height = 0) {
  const glm::dvec3 d =
      glm::dvec3(view.d0) + (x + 0.5) * glm::dvec3(view.dx) + (y + 0.5) * glm::dvec3(view.dy);
  const double t = (height - double(view.eye.y)) / d.y;
  if (!(t > 0)) return std::nullopt;
  return glm::dvec3(view.eye) + t * d;
}

/// sRGB in double, before rounding to a level: 0 .. 255.
inline double srgb_level(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  return 255.0 * (x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055);
}

/// Irradiance at a point of a level floor from a level rectangle above it that shines down with radiance 1,
/// nothing in between. `low`, `high`: its corners in x and z relative to the point; `height` above the floor.
/// The form factor of a rectangle with a corner above the point, summed over the four corners.
inline double irradiance_below(glm::dvec2 low, glm::dvec2 high, double height) {
  const auto corner = [&](double x, double z) {
    const double a = x / height, b = z / height, p = std::sqrt(1 + a * a), q = std::sqrt(1 + b * b);
    return 0.5 * (a / p * std::atan(b / p) + b / q * std::atan(a / q));
  };
  return corner(high.x, high.y) - corner(low.x, high.y) - corner(high.x, low.y) + corner(low.x, low.y);
}

}  // namespace tenebra
