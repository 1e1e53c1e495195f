// Smooth-shaded bodies: spheres with bumps and dents, and what a floor adds.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <numbers>
#include <vector>

#include <tenebra/visible_points.h>

namespace tenebra::testing {

struct RoundBody {
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::uvec3> triangles;
  std::vector<std::uint8_t> casts;

  TriangleView flat() const { return {positions, triangles, casts}; }
  TriangleView smooth() const {
    TriangleView view = flat();
    view.normals = normals;
    return view;
  }
};

/// `rows` x `columns` vertices around a sphere of radius 1 at `centre`, whose radius grows and shrinks by
/// `bumps`; normals are those of the surface.
inline RoundBody round_body(int rows, int columns, glm::dvec3 centre = glm::dvec3(0), double bumps = 0) {
  const auto at = [&](double down, double around) {
    const double r = 1 + bumps * std::sin(3 * down) * std::cos(2 * around) + bumps * std::cos(5 * down);
    return r *
           glm::dvec3(std::sin(down) * std::cos(around), std::cos(down), std::sin(down) * std::sin(around));
  };
  RoundBody body;
  for (int i = 0; i <= rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      const double down = std::numbers::pi * i / rows, around = 2 * std::numbers::pi * j / columns;
      constexpr double step = 1e-4;
      const glm::dvec3 p = at(down, around);
      const bool pole = i == 0 || i == rows;
      const glm::dvec3 n = pole ? p
                                : glm::cross(at(down, around + step) - at(down, around - step),
                                             at(down + step, around) - at(down - step, around));
      body.positions.emplace_back(p + centre);
      body.normals.emplace_back(glm::normalize(glm::dot(n, p) < 0 ? -n : n));
    }
  }
  const auto c = static_cast<std::uint32_t>(columns);
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(rows); ++i) {
    for (std::uint32_t j = 0; j < c; ++j) {
      const std::uint32_t a = i * c + j, b = i * c + (j + 1) % c;
      if (i > 0) body.triangles.push_back({a, b, a + c});
      if (i + 1 < static_cast<std::uint32_t>(rows)) body.triangles.push_back({b, b + c, a + c});
    }
  }
  body.casts.assign(body.triangles.size(), 1);
  return body;
}

/// A floor of side 2 `half` at height y, with normals of its own.
inline void add_floor(RoundBody& body, float y, float half) {
  const auto first = static_cast<std::uint32_t>(body.positions.size());
  for (const glm::vec2 at : {glm::vec2(-half, -half), {-half, half}, {half, half}, {half, -half}}) {
    body.positions.emplace_back(at.x, y, at.y);
    body.normals.emplace_back(0, 1, 0);
  }
  body.triangles.push_back({first, first + 1, first + 2});
  body.triangles.push_back({first, first + 2, first + 3});
  body.casts.insert(body.casts.end(), 2, 1);
}

}  // namespace tenebra::testing
