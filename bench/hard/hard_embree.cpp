#include "bench/hard/hard_embree.h"

#include <cstring>
#include <limits>

#include "bench/common/bench_embree.h"
#include "bench/common/embree_tree.h"
#include "math/predicates.h"
#include "parallel/parallel.h"
#include "points/triangle_corners.h"

namespace tenebra::bench {
namespace {

// Rays leave their own surface by this share of their length: the usual bias, which Tenebra has no use for.
constexpr float bias = 1e-4f;
constexpr int band = 8;  // rows of pixels that are given to a thread together

bool faces(const points::Corners& c, const ViewRays& view, const ShadowLight& light) {
  const int lit = light.directional ? math::direction_side(c.v[0], c.v[1], c.v[2], light.to_light)
                                    : math::point_side(c.v[0], c.v[1], c.v[2], light.position);
  const int seen = points::eye_side(c.v, view);
  return lit != 0 && lit == seen;
}

struct Shape {
  int columns, rows;
};
Shape shape_of(PacketTile tile) {
  return tile == PacketTile::wide ? Shape{8, 2} : Shape{4, 4};
}

/// Copies a tile out of a plane of pixels.
template <class T>
void take(const std::vector<T>& plane, std::size_t first, std::size_t width, Shape shape, void* to) {
  const auto bytes = sizeof(T) * static_cast<std::size_t>(shape.columns);
  for (int row = 0; row < shape.rows; ++row)
    std::memcpy(static_cast<char*>(to) + static_cast<std::size_t>(row) * bytes,
                &plane[first + static_cast<std::size_t>(row) * width], bytes);
}

void aim(const ShadowLight& light, float length_of_no_end, RTCRay16& rays) {
  for (int i = 0; i < 16; ++i) {
    rays.dir_x[i] = light.directional ? light.to_light.x : light.position.x - rays.org_x[i];
    rays.dir_y[i] = light.directional ? light.to_light.y : light.position.y - rays.org_y[i];
    rays.dir_z[i] = light.directional ? light.to_light.z : light.position.z - rays.org_z[i];
    rays.tnear[i] = bias;
    rays.tfar[i] = length_of_no_end;
  }
}

/// Half of a packet.
void copy_half(const RTCRay16& from, int first, RTCRay8& to) {
  const auto copy = [&](const float* plane, float* out) { std::copy_n(plane + first, 8, out); };
  copy(from.org_x, to.org_x), copy(from.org_y, to.org_y), copy(from.org_z, to.org_z);
  copy(from.dir_x, to.dir_x), copy(from.dir_y, to.dir_y), copy(from.dir_z, to.dir_z);
  copy(from.tnear, to.tnear), copy(from.tfar, to.tfar), copy(from.time, to.time);
  std::copy_n(from.mask + first, 8, to.mask);
  std::copy_n(from.id + first, 8, to.id);
  std::copy_n(from.flags + first, 8, to.flags);
}

}  // namespace

const char* packet_tile_name(PacketTile tile) {
  return tile == PacketTile::wide ? "8x2" : "4x4";
}

PeerPoints peer_points(const HardView& view) {
  const VisiblePoints& from = view.frame.points;
  PeerPoints to;
  to.width = (from.width + 7) / 8 * 8;
  to.height = (from.height + band - 1) / band * band;
  const auto width = static_cast<std::size_t>(to.width), size = width * static_cast<std::size_t>(to.height);
  to.x.resize(size), to.y.resize(size), to.z.resize(size), to.active.resize(size);
  for (int y = 0; y < from.height; ++y) {
    for (int x = 0; x < from.width; ++x) {
      const auto pixel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(from.width) + static_cast<std::size_t>(x);
      const std::uint32_t id = from.triangles[pixel];
      if (id == no_triangle) continue;
      const glm::vec3 p(from.positions[pixel]);
      const std::size_t place = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
      to.x[place] = p.x, to.y[place] = p.y, to.z[place] = p.z;
      to.active[place] =
          faces(points::corners_of(view.frame.triangles(), id), view.frame.view, view.light) ? -1 : 0;
    }
  }
  return to;
}

HardPeer::HardPeer(const TriangleView& triangles, RTCBuildQuality quality, int threads, SimdLevel simd)
    : device_(new_device(embree_settings(threads, simd))),
      scene_(rtcNewScene(device_)),
      mesh_(rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE)) {
  sixteen_ = rtcGetDeviceProperty(device_, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0;
  if (quality == RTC_BUILD_QUALITY_LOW) rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_DYNAMIC);
  rtcSetSceneBuildQuality(scene_, quality);
  rtcSetGeometryBuildQuality(mesh_, quality);
  auto* positions = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
      mesh_, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), triangles.positions.size()));
  std::copy(triangles.positions.begin(), triangles.positions.end(), positions);
  std::vector<glm::uvec3> casters;
  for (std::size_t i = 0; i < triangles.triangles.size(); ++i) {
    if (triangles.casts_shadow.empty() || triangles.casts_shadow[i] != 0)
      casters.push_back(triangles.triangles[i]);
  }
  void* corners = rtcSetNewGeometryBuffer(mesh_, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                          sizeof(glm::uvec3), casters.size());
  std::memcpy(corners, casters.data(), casters.size() * sizeof(glm::uvec3));
  rtcCommitGeometry(mesh_);
  rtcAttachGeometry(scene_, mesh_);
  rtcCommitScene(scene_);
}

HardPeer::~HardPeer() {
  rtcReleaseGeometry(mesh_);
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

void HardPeer::build() {
  rtcUpdateGeometryBuffer(mesh_, RTC_BUFFER_TYPE_VERTEX, 0);
  rtcCommitGeometry(mesh_);
  rtcCommitScene(scene_);
}

void HardPeer::occluded(const std::int32_t* valid, ao::EmbreeQuery& query, RTCRay16& rays) const {
  if (sixteen_) return query.occluded16(valid, scene_, rays);
  for (int first = 0; first < 16; first += 8) {
    alignas(32) RTCRay8 half;
    copy_half(rays, first, half);
    query.occluded8(valid + first, scene_, half);
    std::copy_n(half.tfar, 8, rays.tfar + first);
  }
}

void HardPeer::trace(const PeerPoints& points, const ShadowLight& light, PacketTile tile,
                     ShadowMask& mask) const {
  const Shape shape = shape_of(tile);
  const auto width = static_cast<std::size_t>(points.width);
  mask.resize(points.x.size());
  const float end = light.directional ? std::numeric_limits<float>::infinity() : 1.0f;
  parallel::parallel_tasks(points.height / band, [&](int part) {
    ao::EmbreeQuery query(ao::EmbreeQuery::coherent);
    alignas(64) RTCRay16 rays{};
    alignas(64) std::int32_t valid[16];
    std::fill(rays.mask, rays.mask + 16, ~0u);
    for (int y = part * band; y < (part + 1) * band; y += shape.rows) {
      for (int x = 0; x < points.width; x += shape.columns) {
        const std::size_t first = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
        take(points.active, first, width, shape, valid);
        take(points.x, first, width, shape, rays.org_x);
        take(points.y, first, width, shape, rays.org_y);
        take(points.z, first, width, shape, rays.org_z);
        aim(light, end, rays);
        occluded(valid, query, rays);
        for (int i = 0; i < 16; ++i) {
          const auto row = static_cast<std::size_t>(i / shape.columns);
          const auto column = static_cast<std::size_t>(i % shape.columns);
          mask[first + row * width + column] = valid[i] != 0 && rays.tfar[i] >= 0 ? 255 : 0;
        }
      }
    }
  });
}

}  // namespace tenebra::bench
