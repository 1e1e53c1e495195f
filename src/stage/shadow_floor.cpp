#include "stage/shadow_floor.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "stage/default_light.h"
#include "stage/framing.h"
#include "stage/places.h"

namespace tenebra::stage {
namespace {

constexpr double lowest_sun_rad = std::numbers::pi / 6;  ///< its shadow still falls on the opaque part
constexpr double outer_radius = 1.6;                     ///< of the inner, up to which the floor is opaque
constexpr std::uint32_t corners = 64;

/// Opaque at the left end, nothing at the right, level at both.
TextureImage fading_picture() {
  TextureImage picture;
  picture.name = "added floor";
  picture.width = 128;
  picture.height = 1;
  for (int i = 0; i < picture.width; ++i) {
    const double x = i / (picture.width - 1.0), left = 1 - x * x * (3 - 2 * x);
    picture.rgba.insert(picture.rgba.end(),
                        {255, 255, 255, static_cast<std::uint8_t>(std::lround(255 * left))});
  }
  return picture;
}

/// As bright in the sun as the ground of the sky.
Material floor_material() {
  Material material;
  material.name = "added floor";
  const auto high = static_cast<float>(towards_sun({}).y);
  material.base_color = glm::vec3(default_horizon / (default_ambient + default_sun * high));
  material.casts_shadow = false;
  return material;
}

Material rim_material(int image) {
  Material material = floor_material();
  material.name = "added floor's rim";
  material.alpha_mode = AlphaMode::blend;
  material.base_color_map.image = image;
  material.base_color_map.wrap_u = material.base_color_map.wrap_v = Wrap::clamp_to_edge;
  return material;
}

/// A disc, and a ring around it that has coordinates from 0 to 1 outwards.
Mesh floor_mesh(const glm::dvec3& centre, double inner_m, std::uint32_t disc, std::uint32_t ring) {
  Mesh mesh;
  mesh.name = "added floor";
  const auto add = [&](double radius_m, double angle, float u) {
    mesh.positions.emplace_back(centre + radius_m * glm::dvec3(std::cos(angle), 0, -std::sin(angle)));
    mesh.texture_coordinates[0].emplace_back(u, 0.5f);
  };
  for (std::uint32_t i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners;
    add(inner_m, angle, 0), add(outer_radius * inner_m, angle, 1);
  }
  for (std::uint32_t i = 2; i < corners; ++i) mesh.triangles.emplace_back(0, 2 * i - 2, 2 * i);
  mesh.materials.assign(mesh.triangles.size(), disc);
  for (std::uint32_t i = 0; i < corners; ++i) {
    const std::uint32_t at = 2 * i, next = (at + 2) % (2 * corners);
    mesh.triangles.insert(mesh.triangles.end(), {{at, at + 1, next + 1}, {at, next + 1, next}});
  }
  mesh.materials.resize(mesh.triangles.size(), ring);
  return mesh;
}

}  // namespace

bool has_floor(const Subject& subject) {
  const glm::dvec3 size = subject.high - subject.low;
  const double band = subject.low.y + 0.1 * size.y;
  const double shadow = 0.6 * size.y;  // the sun's, along either axis, in the mean
  double covered = 0;
  for (const glm::uvec3& triangle : subject.first.triangles) {
    if (triangle == glm::uvec3(0)) continue;
    glm::dvec3 v[3];
    for (int k = 0; k < 3; ++k) v[k] = glm::dvec3(subject.first.positions[triangle[k]]);
    const glm::dvec3 normal = glm::cross(v[1] - v[0], v[2] - v[0]);
    if (std::max({v[0].y, v[1].y, v[2].y}) <= band && normal.y > 0.9 * glm::length(normal))
      covered += 0.5 * normal.y;
  }
  return covered > 0 && covered >= 0.75 * (size.x + shadow) * (size.z + shadow);
}

void add_shadow_floor(Scene& scene, const Subject& subject, double floor_y) {
  const glm::dvec3 half = 0.5 * (subject.high - subject.low), middle = subject.centre();
  const double shadow_m = (subject.high.y - floor_y) / std::tan(lowest_sun_rad);
  const double inner_m = std::hypot(half.x, half.z) + shadow_m + 0.1 * subject.radius_m();
  const auto material = static_cast<std::uint32_t>(scene.materials.size());
  Node node;
  node.name = "added floor";
  node.mesh = static_cast<int>(scene.meshes.size());
  scene.meshes.push_back(floor_mesh({middle.x, floor_y, middle.z}, inner_m, material, material + 1));
  scene.materials.push_back(floor_material());
  scene.materials.push_back(rim_material(static_cast<int>(scene.images.size())));
  scene.images.push_back(fading_picture());
  scene.nodes.push_back(std::move(node));
  const glm::dvec3 in_file = scene.frame.to_file({0, floor_y, 0});
  scene.warnings.push_back(fmt::format(
      "The scene has neither light nor floor; a floor that shows its shadow was added at a height "
      "of {} (--floor none leaves it out).",
      coordinate_text(scene.frame.up == UpAxis::z ? in_file.z : in_file.y)));
}

}  // namespace tenebra::stage
