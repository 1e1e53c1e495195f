#include "bench/ao/ao_receivers.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/seeded_random.h"

namespace tenebra::bench {
namespace {

using glm::dvec3;
using glm::vec3;

bool in_free_space(const vec3& position, const Ball& ball, const AoPeer& peer, testing::Random& random) {
  constexpr int probes = 64;
  const auto clearance = static_cast<float>(ball.radius / 50);
  int fronts = 0, backs = 0;
  for (int i = 0; i < probes; ++i) {
    const vec3 direction(random.direction());
    const PeerHit hit = peer.nearest(position, direction);
    if (hit.distance < clearance) return false;
    if (hit.distance == std::numeric_limits<float>::infinity()) continue;
    (glm::dot(hit.normal, direction) < 0 ? fronts : backs)++;
  }
  return backs <= fronts;
}

}  // namespace

std::vector<Receiver> corner_receivers(const Ball& ball) {
  std::vector<Receiver> receivers;
  const double wall = -1.05 * ball.radius, step = 6 * ball.radius / (wall_points - 1);
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < wall_points * wall_points; ++i) {
      dvec3 p(wall), normal(0.0);
      p[(axis + 1) % 3] += step * (i % wall_points);
      p[(axis + 2) % 3] += step * (i / wall_points);
      normal[axis] = 1;
      receivers.push_back({vec3(ball.centre + p), vec3(normal)});
    }
  }
  return receivers;
}

std::vector<Receiver> floor_receivers(const Object& object, const Ball& ball) {
  double lowest = std::numeric_limits<double>::max();
  for (const glm::uvec3& t : object.triangles) {
    for (int k = 0; k < 3; ++k) lowest = std::min(lowest, static_cast<double>(object.positions[t[k]].y));
  }
  std::vector<Receiver> receivers;
  const double y = lowest - ball.radius / 1000, step = 2 * ball.radius / (wall_points - 1);
  for (int i = 0; i < wall_points * wall_points; ++i) {
    const dvec3 p(ball.centre.x - ball.radius + step * (i % wall_points), y,
                  ball.centre.z - ball.radius + step * (i / wall_points));
    if (glm::distance(p, ball.centre) < ball.radius) receivers.push_back({vec3(p), vec3(0, 1, 0)});
  }
  return receivers;
}

std::vector<Receiver> air_receivers(const Ball& ball, const AoPeer& peer, int count, std::uint64_t seed) {
  testing::Random random(seed);
  std::vector<Receiver> receivers;
  while (receivers.size() < static_cast<std::size_t>(count)) {
    const dvec3 p = random.in_cube(1);
    if (glm::dot(p, p) >= 1) continue;
    const vec3 position(ball.centre + p * ball.radius);
    if (in_free_space(position, ball, peer, random))
      receivers.push_back({position, vec3(random.direction())});
  }
  return receivers;
}

std::vector<SurfacePoint> surface_points(const Object& object, int count, std::uint64_t seed) {
  testing::Random random(seed);
  std::vector<double> area_up_to;
  double area = 0;
  const auto across = [&](const glm::uvec3& t) {
    const dvec3 a = object.positions[t.x], b = object.positions[t.y], c = object.positions[t.z];
    return glm::cross(b - a, c - a);
  };
  for (const glm::uvec3& t : object.triangles) area_up_to.push_back(area += glm::length(across(t)));
  std::vector<SurfacePoint> points;
  for (int i = 0; i < count; ++i) {
    const double at = area * (i + random.unit()) / count;
    const auto found = std::upper_bound(area_up_to.begin(), area_up_to.end(), at);
    const auto id = static_cast<std::uint32_t>(std::min<std::ptrdiff_t>(
        found - area_up_to.begin(), static_cast<std::ptrdiff_t>(object.triangles.size()) - 1));
    const glm::uvec3 t = object.triangles[id];
    const double u = std::sqrt(random.unit()), v = random.unit();
    const dvec3 p = (1 - u) * dvec3(object.positions[t.x]) + u * (1 - v) * dvec3(object.positions[t.y]) +
                    u * v * dvec3(object.positions[t.z]);
    points.push_back({id, {vec3(p), vec3(glm::normalize(across(t)))}});
  }
  return points;
}

}  // namespace tenebra::bench
