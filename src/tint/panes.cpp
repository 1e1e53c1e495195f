#include "tint/panes.h"

#include <algorithm>
#include <cmath>

#include "texture/transmittance.h"

namespace tenebra::tint {
namespace {

using glm::dvec3;

bool same_color(std::span<const glm::vec4> colors, const glm::uvec3& t) {
  return colors.empty() || (colors[t.x] == colors[t.y] && colors[t.x] == colors[t.z]);
}

}  // namespace

void Panes::reset(const SeeThroughSurfaces& surfaces, const TriangleView& triangles) {
  surfaces_ = surfaces;
  triangles_ = triangles;
  ids_.clear();
  varies_.clear();
  constant_.clear();
  if (surfaces.see_through.empty()) return;
  textured_.clear();
  for (const Material& m : surfaces.scene->materials)
    textured_.push_back(texture::uses_base_map(*surfaces.scene, m) ||
                        texture::uses_transmission_map(*surfaces.scene, m));
  for (std::uint32_t id = 0; id < surfaces.see_through.size(); ++id)
    if (surfaces.see_through[id] == 1) add(id);
}

void Panes::add(std::uint32_t id) {
  const std::uint32_t material = surfaces_.materials[id];
  const Material& m = surfaces_.scene->materials[material];
  const glm::uvec3 t = triangles_.triangles[id];
  const bool colored = texture::uses_vertex_colors(m);
  ids_.push_back(id);
  varies_.push_back(textured_[material] != 0 || (colored && !same_color(surfaces_.colors, t)));
  const bool white = surfaces_.colors.empty() || !colored;
  constant_.push_back(varies_.back() != 0
                          ? glm::vec3(1.0f)
                          : texture::transmittance(m, glm::vec4(1.0f), 1.0f,
                                                   white ? glm::vec4(1.0f) : surfaces_.colors[t.x]));
}

glm::vec3 Panes::transmittance(std::uint32_t number, const dvec3& at) const {
  if (!varies(number)) return constant_[number];
  const std::uint32_t id = ids_[number];
  const glm::uvec3 t = triangles_.triangles[id];
  const auto between = [&](const auto& values, auto otherwise) {
    using Value = decltype(otherwise);
    if (values.empty()) return otherwise;
    glm::vec<Value::length(), double> sum(0.0);
    for (int k = 0; k < 3; ++k) sum += at[k] * glm::vec<Value::length(), double>(values[t[k]]);
    return Value(sum);
  };
  const glm::vec2 uv[2] = {between(surfaces_.texture_coordinates[0], glm::vec2(0.0f)),
                           between(surfaces_.texture_coordinates[1], glm::vec2(0.0f))};
  return texture::transmittance_at(*surfaces_.scene, surfaces_.scene->materials[surfaces_.materials[id]], uv,
                                   between(surfaces_.colors, glm::vec4(1.0f)));
}

dvec3 weights_where(const glm::vec3 corners[3], const dvec3& from, const dvec3& along) {
  const dvec3 a(corners[0]), e1 = dvec3(corners[1]) - a, e2 = dvec3(corners[2]) - a;
  const dvec3 n = glm::cross(e1, e2);
  const dvec3 to = from + along * (glm::dot(n, a - from) / glm::dot(n, along)) - a;
  const double area2 = glm::dot(n, n);
  const double u = glm::dot(glm::cross(to, e2), n) / area2, v = glm::dot(glm::cross(e1, to), n) / area2;
  const dvec3 w(std::max(0.0, 1 - u - v), std::max(0.0, u), std::max(0.0, v));
  const double sum = w.x + w.y + w.z;
  return sum > 0 && std::isfinite(sum) ? w / sum : dvec3(1.0 / 3);
}

}  // namespace tenebra::tint
