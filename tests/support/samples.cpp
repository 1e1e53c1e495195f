#include "support/samples.h"

#include <algorithm>
#include <limits>

namespace tenebra::testing {
namespace {

using glm::dvec3;

void push(VisiblePoints& points, dvec3 position, std::uint32_t id) {
  points.positions.push_back(position);
  points.triangles.push_back(id);
}

/// Lays the points out as a square picture; pixels left over see nothing.
VisiblePoints squared(VisiblePoints points) {
  const auto count = static_cast<double>(points.positions.size());
  points.width = static_cast<int>(std::ceil(std::sqrt(count)));
  points.height = points.width;
  const auto pixels = static_cast<std::size_t>(points.width) * static_cast<std::size_t>(points.height);
  points.positions.resize(pixels, dvec3(0));
  points.triangles.resize(pixels, no_triangle);
  return points;
}

/// A point of the closed triangle: a vertex, a point of an edge or inside.
dvec3 point_of(const Soup& soup, std::uint32_t id, Random& random, bool border) {
  const dvec3 a(soup.corner(id, 0)), b(soup.corner(id, 1)), c(soup.corner(id, 2));
  const auto kind = random.index(border ? 4 : 8);
  const int k = static_cast<int>(random.index(3));
  if (kind == 0) return dvec3(soup.corner(id, k));
  const dvec3 p(soup.corner(id, k)), q(soup.corner(id, (k + 1) % 3));
  if (kind == 1) return (p + q) * 0.5;
  if (kind < 4) return p + random.unit() * (q - p);
  double s = random.unit(), t = random.unit();
  if (s + t > 1) s = 1 - s, t = 1 - t;
  return a + s * (b - a) + t * (c - a);
}

}  // namespace

PeerTracer::PeerTracer(const TriangleView& triangles)
    : device_(rtcNewDevice("threads=1")), scene_(rtcNewScene(device_)) {
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry mesh = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(
      mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, triangles.positions.size()));
  for (const glm::vec3& p : triangles.positions)
    for (int k = 0; k < 3; ++k) *positions++ = p[k];
  auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, triangles.triangles.size()));
  for (const glm::uvec3& t : triangles.triangles)
    for (int k = 0; k < 3; ++k) *indices++ = t[k];
  rtcCommitGeometry(mesh);
  rtcAttachGeometry(scene_, mesh);
  rtcReleaseGeometry(mesh);
  rtcCommitScene(scene_);
}

PeerTracer::~PeerTracer() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

std::uint32_t PeerTracer::nearest(glm::vec3 origin, glm::vec3 direction, float from) const {
  direction = glm::vec3(glm::normalize(dvec3(direction)));
  if (!(glm::dot(direction, direction) > 0.5f)) return no_triangle;  // Embree asserts on NaN and infinity
  RTCRayHit hit{};
  hit.ray = {origin.x,    origin.y, origin.z,  from, direction.x, direction.y,
             direction.z, 0,        HUGE_VALF, ~0u,  0,           0};
  hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ao::EmbreeQuery().intersect1(scene_, hit);
  return hit.hit.geomID == RTC_INVALID_GEOMETRY_ID ? no_triangle : hit.hit.primID;
}

bool PeerTracer::occluded(glm::vec3 origin, glm::vec3 direction, float from, float to) const {
  RTCRay ray{origin.x, origin.y, origin.z, from, direction.x, direction.y, direction.z, 0, to, ~0u, 0, 0};
  ao::EmbreeQuery().occluded1(scene_, ray);
  return ray.tfar < 0;
}

std::vector<std::uint32_t> PeerTracer::ids(const ViewRays& view, int width, int height) const {
  std::vector<std::uint32_t> ids;
  ids.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const glm::vec3 across = (float(x) + 0.5f) * view.dx + (float(y) + 0.5f) * view.dy;
      ids.push_back(view.orthographic ? nearest(view.eye + across, view.d0)
                                      : nearest(view.eye, view.d0 + across));
    }
  return ids;
}

ViewRays pinhole(dvec3 eye, dvec3 target, double fov, int width, int height) {
  const dvec3 forward = glm::normalize(target - eye);
  const dvec3 up = std::abs(forward.y) > 0.99 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
  const dvec3 right = glm::normalize(glm::cross(forward, up)), above = glm::cross(right, forward);
  const double step = 2 * fov / height;
  ViewRays view;
  view.eye = glm::vec3(eye);
  view.dx = glm::vec3(step * right);
  view.dy = glm::vec3(-step * above);
  view.d0 = glm::vec3(forward - 0.5 * width * step * right + 0.5 * height * step * above);
  view.near_m = 1e-3f;
  return view;
}

VisiblePoints view_samples(const TriangleView& triangles, const ViewRays& view, int width, int height) {
  VisiblePoints points;
  compute_visible_points(PeerTracer(triangles).ids(view, width, height), width, height, view, triangles,
                         points);
  return points;
}

VisiblePoints points_on_triangles(const Soup& soup, Random& random, int count) {
  VisiblePoints points;
  for (int i = 0; i < count; ++i) {
    const auto id = random.index(static_cast<std::uint32_t>(soup.triangles.size()));
    push(points, point_of(soup, id, random, false), id);
  }
  return squared(std::move(points));
}

VisiblePoints points_behind_edges(const Soup& soup, const ShadowLight& light, Random& random, int count) {
  const PeerTracer peer(soup.view());
  const auto beyond = static_cast<float>(1e-5 * glm::length(soup.high() - soup.low()));
  VisiblePoints points;
  for (int tries = 0; tries < 8 * count && static_cast<int>(points.positions.size()) < count; ++tries) {
    const auto occluder = random.index(static_cast<std::uint32_t>(soup.triangles.size()));
    const dvec3 target = point_of(soup, occluder, random, true), from(light.position);
    const dvec3 away = light.directional ? -dvec3(light.to_light) : target - from;
    const std::uint32_t id = peer.nearest(glm::vec3(target), glm::vec3(away), beyond);
    if (id == no_triangle || id == occluder) continue;
    const dvec3 a(soup.corner(id, 0)), b(soup.corner(id, 1)), c(soup.corner(id, 2));
    const dvec3 n = glm::cross(b - a, c - a);
    const double t = glm::dot(n, a - target) / glm::dot(n, away);
    const dvec3 point = target + t * away;
    if (std::isfinite(point.x + point.y + point.z) && t > 0) push(points, point, id);
  }
  return squared(std::move(points));
}

ViewRays view_from_light(const ShadowLight& light) {
  ViewRays view;
  view.orthographic = light.directional;
  view.eye = light.position;
  if (light.directional) view.d0 = -light.to_light;
  return view;
}

}  // namespace tenebra::testing
