#include "bench/ao/ao_peer.h"

#include <algorithm>
#include <cmath>

namespace tenebra::bench {
namespace {

RTCRayHit ray_of(glm::vec3 o, glm::vec3 d, float from, float to) {
  RTCRayHit ray{};
  ray.ray = {o.x, o.y, o.z, from, d.x, d.y, d.z, 0, to, ~0u, 0, 0};
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return ray;
}

void trace_single(RTCScene scene, const trees::RayBatch& rays, float from, float* distance) {
  ao::EmbreeQuery query;
  for (int i = 0; i < trees::batch_size; ++i) {
    RTCRayHit ray = ray_of(rays.origin(i), rays.direction(i), from, distance[i]);
    query.intersect1(scene, ray);
    distance[i] = ray.ray.tfar;
  }
}

void trace_packet(RTCScene scene, const trees::RayBatch& rays, float from, bool coherent, float* distance) {
  RTCRayHit16 packet;
  alignas(64) int valid[trees::batch_size];
  std::fill(valid, valid + trees::batch_size, -1);
  const auto copy = [](const float* from_row, float* to) {
    std::copy(from_row, from_row + trees::batch_size, to);
  };
  copy(rays.ox, packet.ray.org_x), copy(rays.oy, packet.ray.org_y), copy(rays.oz, packet.ray.org_z);
  copy(rays.dx, packet.ray.dir_x), copy(rays.dy, packet.ray.dir_y), copy(rays.dz, packet.ray.dir_z);
  copy(distance, packet.ray.tfar);
  std::fill(packet.ray.tnear, packet.ray.tnear + trees::batch_size, from);
  std::fill(packet.ray.time, packet.ray.time + trees::batch_size, 0.0f);
  std::fill(packet.ray.mask, packet.ray.mask + trees::batch_size, ~0u);
  std::fill(packet.ray.flags, packet.ray.flags + trees::batch_size, 0u);
  std::fill(packet.hit.geomID, packet.hit.geomID + trees::batch_size, RTC_INVALID_GEOMETRY_ID);
  std::fill(packet.hit.instID[0], packet.hit.instID[0] + trees::batch_size, RTC_INVALID_GEOMETRY_ID);
  ao::EmbreeQuery(coherent ? ao::EmbreeQuery::coherent : ao::EmbreeQuery::incoherent)
      .intersect16(valid, scene, packet);
  copy(packet.ray.tfar, distance);
}

}  // namespace

AoPeer::AoPeer(const Object& object) : AoPeer(TriangleView{object.positions, object.triangles, {}}) {}

AoPeer::AoPeer(const TriangleView& triangles, Casters casters, Edges edges)
    : scene_(triangles, casters == Casters::only, edges == Edges::robust), build_ms_(watch_.lap_ms()) {}

PeerHit AoPeer::nearest(glm::vec3 origin, glm::vec3 direction) const {
  RTCRayHit ray = ray_of(origin, direction, 0, std::numeric_limits<float>::infinity());
  ao::EmbreeQuery().intersect1(scene_.get(), ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  return {ray.ray.tfar, {ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z}};
}

Tracer AoPeer::single_rays(float from) const {
  return [scene = scene_.get(), from](std::span<const trees::RayBatch> rays, float* t) {
    for (std::size_t b = 0; b < rays.size(); ++b)
      trace_single(scene, rays[b], from, t + b * trees::batch_size);
  };
}

Tracer AoPeer::packets(bool coherent, float from) const {
  return [scene = scene_.get(), from, coherent](std::span<const trees::RayBatch> rays, float* t) {
    for (std::size_t b = 0; b < rays.size(); ++b)
      trace_packet(scene, rays[b], from, coherent, t + b * trees::batch_size);
  };
}

}  // namespace tenebra::bench
