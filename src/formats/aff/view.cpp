// Cameras, lights, materials and the interval of the animation.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "base/fail.h"
#include "formats/aff/reader.h"
#include "scene/view_basis.h"

namespace tenebra::formats {
namespace {

glm::dvec3 read_named_vector(AffLexer& in, std::string_view keyword) {
  in.expect(keyword);
  return in.vector("a coordinate");
}

glm::vec3 color(const std::array<double, 12>& numbers, std::size_t first) {
  return {numbers[first], numbers[first + 1], numbers[first + 2]};
}

/// What follows the diffuse colour in `fm`: the specular one, Phong's exponent, the transmittance, and the
/// index of refraction, which nothing uses.
void set_gloss(const std::array<double, 12>& numbers, Material& material) {
  material.specular = glm::max(color(numbers, 6), glm::vec3(0.0f));
  material.phong_exponent = static_cast<float>(std::max(numbers[9], 0.0));
  material.transmission = static_cast<float>(std::clamp(numbers[10], 0.0, 1.0));
}

}  // namespace

void AffReader::read_view(AffLexer& in) {
  constexpr double least_near = 1e-4;
  View view;
  view.node.translation = read_named_vector(in, "from");
  const glm::dvec3 at = read_named_vector(in, "at");
  const glm::dvec3 up = read_named_vector(in, "up");
  view.node.rotation = glm::quat_cast(scene::view_basis(at - view.node.translation, up));
  in.expect("angle");
  double angle = in.number("the view's angle in degrees");
  if (!(angle > 0.0 && angle < 180.0)) {
    in.warn(fmt::to_string(angle), "an angle between 0 and 180 degrees", "made 45");
    angle = 45;
  }
  view.camera.vertical_fov_rad = static_cast<float>(glm::radians(angle));
  in.expect("hither");
  const double hither = in.number("the near distance");
  view.camera.near_m = static_cast<float>(hither < least_near ? 1.0 : hither);
  in.expect("resolution");
  const std::int64_t width = in.integer("the picture's width");
  const std::int64_t height = in.integer("the picture's height");
  if (width > 0 && height > 0) view.camera.aspect = static_cast<float>(width) / static_cast<float>(height);
  view_ = std::move(view);
}

void AffReader::add_light(AffLexer& in, Node node) {
  node.translation = in.vector("a coordinate of the light");
  Light light;
  light.name = node.name;
  light.falloff = Falloff::none;
  if (in.next_is_look()) light.color = glm::vec3(in.look_vector("a value of the light's colour"));
  node.light = static_cast<int>(scene_.lights.size());
  charge(in, 2 * sizeof(Light));
  scene_.lights.push_back(std::move(light));
  add_node(in, std::move(node));
}

void AffReader::read_light(AffLexer& in) {
  add_light(in, {});
}

void AffReader::read_animated_light(AffLexer& in) {
  Node node;
  node.name = in.word("the name of the light");
  const std::string name = node.name;
  add_light(in, std::move(node));
  animated_.push_back(
      {.node = static_cast<int>(scene_.nodes.size()) - 1, .name = name, .translation_only = true});
}

void AffReader::set_material(AffLexer& in, const std::array<double, 12>& numbers, const Material& material) {
  const auto next = static_cast<std::uint32_t>(scene_.materials.size());
  const auto [entry, is_new] = known_materials_.try_emplace(numbers, next);
  if (is_new) {
    charge(in, 2 * sizeof(Material) + 2 * sizeof(*entry));
    scene_.materials.push_back(material);
  }
  material_ = entry->second;
}

void AffReader::read_material(AffLexer& in) {
  Material material;
  material.name = in.place();
  std::array<double, 12> numbers{};
  for (double& number : numbers) number = in.look("one of a material's 12 numbers");
  material.ambient = color(numbers, 0);
  material.base_color = color(numbers, 3);
  set_gloss(numbers, material);
  set_material(in, numbers, material);
}

/// NFF says nothing about ambient light: a tenth of the colour keeps shadows readable.
void AffReader::read_fill(AffLexer& in) {
  constexpr double ambient_share = 0.1;
  Material material;
  material.name = in.place();
  std::array<double, 8> f{};
  for (double& number : f) number = in.look("one of a material's 8 numbers");
  const glm::dvec3 fill(f[0], f[1], f[2]);
  const glm::dvec3 ambient = ambient_share * fill, diffuse = f[3] * fill;
  material.ambient = glm::vec3(ambient);
  material.base_color = glm::vec3(diffuse);
  const std::array<double, 12> numbers{ambient.x, ambient.y, ambient.z, diffuse.x, diffuse.y, diffuse.z,
                                       f[4],      f[4],      f[4],      f[5],      f[6],      f[7]};
  set_gloss(numbers, material);
  set_material(in, numbers, material);
}

void AffReader::read_animation(AffLexer& in) {
  const double start = in.number("the animation's start"), end = in.number("the animation's end");
  const std::size_t frames = in.count("the animation's number of frames");
  if (end < start)
    return in.warn(fmt::to_string(end), "an end after the animation's start", "the keys say both");
  if (frames == 0) in.warn("0 frames", "at least one frame", "the rate says how many");
  clip_.start_s = start;
  clip_.end_s = end;
  clip_.frame_count = static_cast<int>(frames);
  interval_stated_ = true;
}

}  // namespace tenebra::formats
