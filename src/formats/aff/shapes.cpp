#include "formats/aff/shapes.h"

#include <cmath>
#include <numbers>

#include "scene/view_basis.h"

namespace tenebra::formats {
namespace {

constexpr double pi = std::numbers::pi;

void add_vertex(Mesh& mesh, glm::dvec3 position, glm::dvec3 normal) {
  mesh.positions.emplace_back(position);
  mesh.normals.emplace_back(normal);
}

void turn_inside_out(Mesh& mesh) {
  for (glm::vec3& normal : mesh.normals) normal = -normal;
  for (glm::uvec3& triangle : mesh.triangles) std::swap(triangle.y, triangle.z);
}

}  // namespace

Mesh make_cone(glm::dvec3 base, double base_radius, glm::dvec3 apex, double apex_radius, int sides,
               bool inside) {
  const glm::dvec3 along = apex - base;
  const glm::dmat3 basis = scene::view_basis(along, {0, 1, 0});
  const glm::dvec3 u = basis[1], w = basis[0], axis = -basis[2];  // u x w = axis
  Mesh mesh;
  for (int k = 0; k < sides; ++k) {
    const double angle = 2 * pi * k / sides;
    const glm::dvec3 outward = std::cos(angle) * u + std::sin(angle) * w;
    const glm::dvec3 slope = outward * glm::length(along) + axis * (base_radius - apex_radius);
    const glm::dvec3 normal = slope / glm::length(slope);
    add_vertex(mesh, base + base_radius * outward, normal);
    add_vertex(mesh, apex + apex_radius * outward, normal);
  }
  const auto count = static_cast<std::uint32_t>(sides);
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint32_t here = 2 * k, next = 2 * ((k + 1) % count);
    if (base_radius > 0 || apex_radius == 0) mesh.triangles.emplace_back(here, next, here + 1);
    if (apex_radius > 0) mesh.triangles.emplace_back(next, next + 1, here + 1);
  }
  if (inside) turn_inside_out(mesh);
  return mesh;
}

Mesh make_sphere(glm::dvec3 center, double radius, bool inside) {
  constexpr std::uint32_t sides = sphere_sides, rings = sphere_rings;
  Mesh mesh;
  add_vertex(mesh, center + glm::dvec3(0, radius, 0), {0, 1, 0});
  for (std::uint32_t ring = 1; ring < rings; ++ring) {
    const double polar = pi * ring / rings;
    for (std::uint32_t side = 0; side < sides; ++side) {
      const double turn = 2 * pi * side / sides;
      const glm::dvec3 n(std::sin(polar) * std::sin(turn), std::cos(polar), std::sin(polar) * std::cos(turn));
      add_vertex(mesh, center + radius * n, n);
    }
  }
  add_vertex(mesh, center - glm::dvec3(0, radius, 0), {0, -1, 0});
  const auto bottom = static_cast<std::uint32_t>(mesh.positions.size() - 1);
  const auto at = [](std::uint32_t ring, std::uint32_t side) {
    return 1 + (ring - 1) * sides + side % sides;
  };
  for (std::uint32_t side = 0; side < sides; ++side) {
    mesh.triangles.emplace_back(0, at(1, side), at(1, side + 1));
    for (std::uint32_t ring = 1; ring + 1 < rings; ++ring) {
      mesh.triangles.emplace_back(at(ring, side), at(ring + 1, side), at(ring + 1, side + 1));
      mesh.triangles.emplace_back(at(ring, side), at(ring + 1, side + 1), at(ring, side + 1));
    }
    mesh.triangles.emplace_back(at(rings - 1, side), bottom, at(rings - 1, side + 1));
  }
  if (inside) turn_inside_out(mesh);
  return mesh;
}

}  // namespace tenebra::formats
