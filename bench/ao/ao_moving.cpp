#include "bench/ao/ao_moving.h"

#include <algorithm>

namespace tenebra::bench {
namespace {

using glm::vec3;

/// The point of a triangle that is nearest to `p`.
vec3 nearest_point(const vec3& p, const vec3& a, const vec3& b, const vec3& c) {
  const vec3 n = glm::cross(b - a, c - a);
  const vec3 corners[3] = {a, b, c};
  const float area = glm::dot(n, n);
  bool inside = area > 0;
  for (int k = 0; k < 3; ++k) {
    const vec3 from = corners[k], along = corners[(k + 1) % 3] - from;
    inside = inside && glm::dot(glm::cross(along, p - from), n) >= 0;
  }
  if (inside) return p - n * (glm::dot(n, p - a) / area);
  vec3 best = a;
  for (int k = 0; k < 3; ++k) {
    const vec3 from = corners[k], along = corners[(k + 1) % 3] - from;
    const float square = glm::dot(along, along);
    const float t = square > 0 ? std::clamp(glm::dot(p - from, along) / square, 0.0f, 1.0f) : 0.0f;
    const vec3 on = from + t * along;
    if (glm::dot(on - p, on - p) < glm::dot(best - p, best - p)) best = on;
  }
  return best;
}

struct Query {
  const vec3* corners;
  float distance;
  bool found;
};

bool look(RTCPointQueryFunctionArguments* args) {
  Query& query = *static_cast<Query*>(args->userPtr);
  const vec3 p(args->query->x, args->query->y, args->query->z);
  const vec3* c = query.corners + 3 * static_cast<std::size_t>(args->primID);
  if (glm::distance(nearest_point(p, c[0], c[1], c[2]), p) < query.distance) query.found = true;
  if (query.found) args->query->radius = 0;  // enough
  return query.found;
}

}  // namespace

MovingTriangles::MovingTriangles(const FrameGeometry& now, const FrameGeometry& next) {
  for (std::size_t i = 0; i < now.triangles.size(); ++i) {
    const glm::uvec3 s = now.triangles[i], t = next.triangles[i];
    bool moves = false;
    for (int k = 0; k < 3; ++k) moves = moves || now.positions[s[k]] != next.positions[t[k]];
    moves_.push_back(moves);
    if (!moves) continue;
    for (int k = 0; k < 3; ++k) corners_.push_back(now.positions[s[k]]);
    for (int k = 0; k < 3; ++k) corners_.push_back(next.positions[t[k]]);
  }
  for (unsigned i = 0; i < corners_.size(); i += 3) triangles_.emplace_back(i, i + 1, i + 2);
  if (!triangles_.empty())
    scene_ = std::make_unique<EmbreeScene>(TriangleView{corners_, triangles_, {}}, false);
}

bool MovingTriangles::within(const glm::dvec3& point, double distance) const {
  if (!scene_) return false;
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  const vec3 p(point);
  const auto radius = static_cast<float>(distance);
  RTCPointQuery query{p.x, p.y, p.z, 0, radius};
  Query looked{corners_.data(), radius, false};
  rtcPointQuery(scene_->get(), &query, &context, look, &looked);
  return looked.found;
}

}  // namespace tenebra::bench
