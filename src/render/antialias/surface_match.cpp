#include "render/antialias/surface_match.h"

#include <algorithm>
#include <cmath>

namespace tenebra::render {
namespace {

constexpr float least_cosine = 0.95f;  // of the angle between two normals, 18 degrees

}  // namespace

SurfaceMatch::SurfaceMatch(const FrameGeometry& geometry, const ViewRays& view)
    : geometry_(geometry), view_(view) {}

SurfaceMatch::Plane SurfaceMatch::plane_of(std::uint32_t id) const {
  const glm::uvec3 t = geometry_.triangles[id];
  const glm::vec3 a = geometry_.positions[t.x];
  const glm::vec3 normal = glm::cross(geometry_.positions[t.y] - a, geometry_.positions[t.z] - a);
  const float length = std::max({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)});
  if (!(length > 0)) return {};
  const glm::vec3 bounded = normal / length;  // products of what follows stay in range
  return {bounded, glm::dot(bounded, a - view_.eye)};
}

const SurfaceMatch::Plane& SurfaceMatch::known_plane(std::uint32_t id) {
  Known& known = known_[id % known_.size()];
  if (known.id != id) known = {id, plane_of(id)};
  return known.plane;
}

bool SurfaceMatch::same(std::uint32_t a, std::uint32_t b, glm::vec2 place) {
  if (a == b) return true;
  if (a >= geometry_.triangles.size() || b >= geometry_.triangles.size()) return false;
  if (geometry_.materials[a] != geometry_.materials[b]) return false;
  const Plane p = known_plane(a), q = known_plane(b);
  const glm::vec3 across = place.x * view_.dx + place.y * view_.dy;
  const glm::vec3 along = view_.orthographic ? view_.d0 : view_.d0 + across;
  const glm::vec3 from = view_.orthographic ? across : glm::vec3(0.0f);
  const float speed_p = glm::dot(p.normal, along), speed_q = glm::dot(q.normal, along);
  // Turned to the eye, their normals point about the same way.
  const float cosine = glm::dot(p.normal, q.normal) * (speed_p * speed_q > 0 ? 1.0f : -1.0f);
  const float lengths = std::sqrt(glm::dot(p.normal, p.normal) * glm::dot(q.normal, q.normal));
  if (!(cosine >= least_cosine * lengths)) return false;
  const float t_p = (p.height - glm::dot(p.normal, from)) / speed_p,
              t_q = (q.height - glm::dot(q.normal, from)) / speed_q;
  // What t_p - t_q changes by from one side of a pixel to the other.
  const float scale = view_.orthographic ? 1.0f : std::max(t_p, t_q);
  const glm::vec3 slopes = p.normal / speed_p - q.normal / speed_q;
  const float change = scale * (std::abs(glm::dot(slopes, view_.dx)) + std::abs(glm::dot(slopes, view_.dy)));
  return std::abs(t_p - t_q) <= change + 0x1p-18f * (std::abs(t_p) + std::abs(t_q));  // roundings
}

}  // namespace tenebra::render
