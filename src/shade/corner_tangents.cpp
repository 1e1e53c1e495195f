#include "shade/corner_tangents.h"

#include "scene/map_tangent.h"

namespace tenebra::shade {

using glm::dvec3;
using glm::vec3;
using glm::vec4;

std::array<vec4, 3> corner_tangents(const FrameGeometry& geometry, const TriangleSetup& setup,
                                    const glm::uvec3& corners, const CoordinatePlane& map) {
  const dvec3 e1(setup.e1), e2(setup.e2), wound = glm::cross(e1, e2);
  vec3 normal(0.0f);
  for (int k = 0; k < 3 && !geometry.normals.empty(); ++k) normal += geometry.normals[corners[k]];
  const bool has_normal = normal != vec3(0.0f);
  const float behind =
      glm::dot(has_normal ? normal : vec3(glm::normalize(wound)), setup.face) < 0 ? -1.0f : 1.0f;
  vec4 own(scene::map_tangent(e1, e2, glm::dvec2(map.by_second), glm::dvec2(map.by_third)));
  if (has_normal && glm::dot(dvec3(normal), wound) < 0) own.w = -own.w;
  std::array<vec4, 3> out{own, own, own};
  for (int k = 0; k < 3 && !geometry.tangents.empty(); ++k)
    if (const vec4& given = geometry.tangents[corners[k]]; vec3(given) != vec3(0.0f))
      out[static_cast<std::size_t>(k)] = given;
  for (vec4& tangent : out) tangent *= behind;
  return out;
}

}  // namespace tenebra::shade
