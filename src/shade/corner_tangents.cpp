#include "shade/corner_tangents.h"

#include <cmath>

namespace tenebra::shade {
namespace {

using glm::dvec3;
using glm::vec3;
using glm::vec4;

/// The direction in which the first coordinate grows, and the sign of the y axis beside a normal on the side
/// of the edges' cross product: y is up in the picture, where the second coordinate falls.
vec4 own_tangent(const dvec3& e1, const dvec3& e2, const CoordinatePlane& map) {
  const glm::dvec2 second(map.by_second), third(map.by_third);
  const double area = second.x * third.y - third.x * second.y;
  const dvec3 along = (area < 0 ? -1.0 : 1.0) * (third.y * e1 - second.y * e2);
  const double square = glm::dot(along, along);
  if (area == 0 || !(square > 0) || !std::isfinite(square)) return vec4(0.0f);
  return {vec3(along / std::sqrt(square)), area < 0 ? 1.0f : -1.0f};
}

}  // namespace

std::array<vec4, 3> corner_tangents(const FrameGeometry& geometry, const TriangleSetup& setup,
                                    const glm::uvec3& corners, const CoordinatePlane& map) {
  const dvec3 e1(setup.e1), e2(setup.e2), wound = glm::cross(e1, e2);
  vec3 normal(0.0f);
  for (int k = 0; k < 3 && !geometry.normals.empty(); ++k) normal += geometry.normals[corners[k]];
  const bool has_normal = normal != vec3(0.0f);
  const float behind =
      glm::dot(has_normal ? normal : vec3(glm::normalize(wound)), setup.face) < 0 ? -1.0f : 1.0f;
  vec4 own = own_tangent(e1, e2, map);
  if (has_normal && glm::dot(dvec3(normal), wound) < 0) own.w = -own.w;
  std::array<vec4, 3> out{own, own, own};
  for (int k = 0; k < 3 && !geometry.tangents.empty(); ++k)
    if (const vec4& given = geometry.tangents[corners[k]]; vec3(given) != vec3(0.0f))
      out[static_cast<std::size_t>(k)] = given;
  for (vec4& tangent : out) tangent *= behind;
  return out;
}

}  // namespace tenebra::shade
