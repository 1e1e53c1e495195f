#include "bench/common/bench_embree.h"

#include <cmath>
#include <limits>

#include "bench/common/memory_meter.h"
#include "parallel/parallel.h"

namespace tenebra::bench {

RTCDevice new_device(const std::string& settings) {
  RTCDevice device = rtcNewDevice(settings.empty() ? nullptr : settings.c_str());
  const auto count = [](void*, ssize_t bytes, bool) {
    count_memory(bytes);
    return true;
  };
  rtcSetDeviceMemoryMonitorFunction(device, count, nullptr);
  return device;
}

EmbreeScene::EmbreeScene(const TriangleView& triangles, bool only_casters, bool robust)
    : device_(new_device()), scene_(rtcNewScene(device_)) {
  for (std::size_t i = 0; i < triangles.triangles.size(); ++i) {
    const bool casts = triangles.casts_shadow.empty() || triangles.casts_shadow[i] != 0;
    if (casts || !only_casters) ids_.push_back(static_cast<std::uint32_t>(i));
  }
  if (robust) rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
  RTCGeometry mesh = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetGeometryBuildQuality(mesh, RTC_BUILD_QUALITY_HIGH);
  auto* positions = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
      mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), triangles.positions.size()));
  std::copy(triangles.positions.begin(), triangles.positions.end(), positions);
  auto* corners = static_cast<glm::uvec3*>(rtcSetNewGeometryBuffer(
      mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3), ids_.size()));
  for (const std::uint32_t id : ids_) *corners++ = triangles.triangles[id];
  rtcCommitGeometry(mesh);
  rtcAttachGeometry(scene_, mesh);
  rtcReleaseGeometry(mesh);
  rtcCommitScene(scene_);
}

EmbreeScene::~EmbreeScene() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

std::vector<std::uint32_t> nearest_triangles(const TriangleView& triangles, const ViewRays& view, int width,
                                             int height) {
  const EmbreeScene scene(triangles, false);
  const glm::vec3 axis = glm::normalize(glm::cross(view.dx, view.dy));
  std::vector<std::uint32_t> ids(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  parallel::parallel_ranges(static_cast<std::size_t>(height), 8, [&](std::size_t first, std::size_t last) {
    ao::EmbreeQuery query;
    for (std::size_t i = first * static_cast<std::size_t>(width); i < last * static_cast<std::size_t>(width);
         ++i) {
      const float x = static_cast<float>(i % static_cast<std::size_t>(width)) + 0.5f;
      const float y = static_cast<float>(i / static_cast<std::size_t>(width)) + 0.5f;
      const glm::vec3 step = x * view.dx + y * view.dy;
      const glm::vec3 from = view.orthographic ? view.eye + step : view.eye;
      const glm::vec3 along = view.orthographic ? view.d0 : view.d0 + step;
      const float advance = std::abs(glm::dot(along, axis));  // metres along the view axis per unit of t
      RTCRayHit hit{};
      hit.ray = {from.x,
                 from.y,
                 from.z,
                 view.near_m / advance,
                 along.x,
                 along.y,
                 along.z,
                 0,
                 std::numeric_limits<float>::infinity(),
                 ~0u,
                 0,
                 0};
      hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      query.intersect1(scene.get(), hit);
      ids[i] = hit.hit.geomID == RTC_INVALID_GEOMETRY_ID ? no_triangle : scene.id_of(hit.hit.primID);
    }
  });
  return ids;
}

}  // namespace tenebra::bench
