#include "ao/reference/reference_rays.h"

#include "base/fail.h"

#ifdef TENEBRA_EMBREE
#include <cstring>

#include "ao/reference/embree.h"
#include "base/until_stopped.h"

namespace tenebra::ao {

struct ReferenceRays::State {
  RTCDevice device = rtcNewDevice("threads=1");
  RTCScene scene = nullptr;
  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

namespace {

bool casts(const TriangleView& triangles, std::size_t t) {
  const glm::uvec3 v = triangles.triangles[t];
  return (triangles.casts_shadow.empty() || triangles.casts_shadow[t]) && !(v.x == v.y && v.y == v.z);
}

/// What Embree asks while it builds: false ends it.
bool goes_on(void* stop, double) {
  return !stop_requested(static_cast<const StopFlag*>(stop));
}

/// False if memory is short. Of no use if `stop` is requested.
bool attach(const TriangleView& triangles, const StopFlag* stop, RTCDevice device, RTCScene scene) {
  std::size_t count = 0;
  for (std::size_t t = 0; t < triangles.triangles.size(); ++t) count += casts(triangles, t) ? 1 : 0;
  if (count == 0) return true;
  RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(
      mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, triangles.positions.size()));
  auto* indices = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, count));
  if (positions != nullptr && indices != nullptr) {
    base::each_until_stopped(0, triangles.positions.size(), stop, [&](std::size_t v) {
      std::memcpy(positions + 3 * v, &triangles.positions[v], 12);
    });
    base::each_until_stopped(0, triangles.triangles.size(), stop, [&](std::size_t t) {
      if (!casts(triangles, t)) return;
      for (int k = 0; k < 3; ++k) *indices++ = triangles.triangles[t][k];
    });
    rtcCommitGeometry(mesh);
    rtcAttachGeometry(scene, mesh);
  }
  rtcReleaseGeometry(mesh);
  return positions != nullptr && indices != nullptr;
}

}  // namespace

Expected<ReferenceRays> ReferenceRays::create(const TriangleView& triangles, const StopFlag* stop) {
  auto state = std::make_unique<State>();
  if (state->device == nullptr)
    return base::fail("the ray caster did not start: error {}", static_cast<int>(rtcGetDeviceError(nullptr)));
  state->scene = rtcNewScene(state->device);
  rtcSetSceneFlags(state->scene, RTC_SCENE_FLAG_ROBUST);
  if (!attach(triangles, stop, state->device, state->scene))
    return base::fail("the ray caster has no memory for {} triangles", triangles.triangles.size());
  rtcSetSceneProgressMonitorFunction(state->scene, goes_on, const_cast<StopFlag*>(stop));  // only read
  if (!stop_requested(stop)) rtcCommitScene(state->scene);
  if (stop_requested(stop)) return base::stopped();
  return ReferenceRays(std::move(state));
}

void ReferenceRays::nearest_hits(const trees::RayBatch& rays, float* distances) const {
  alignas(64) int valid[16];
  RTCRayHit16 hits;
  for (int i = 0; i < trees::batch_size; ++i) {
    const glm::vec3 d = rays.direction(i);
    valid[i] = glm::dot(d, d) > 0 ? -1 : 0;
    hits.ray.org_x[i] = rays.ox[i], hits.ray.org_y[i] = rays.oy[i], hits.ray.org_z[i] = rays.oz[i];
    hits.ray.dir_x[i] = d.x, hits.ray.dir_y[i] = d.y, hits.ray.dir_z[i] = d.z;
    hits.ray.tnear[i] = 0, hits.ray.tfar[i] = distances[i], hits.ray.time[i] = 0;
    hits.ray.mask[i] = ~0u, hits.ray.flags[i] = 0, hits.ray.id[i] = 0;
    hits.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
  }
  EmbreeQuery().intersect16(valid, state_->scene, hits);
  for (int i = 0; i < trees::batch_size; ++i) {
    if (hits.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID) distances[i] = hits.ray.tfar[i];
  }
}

}  // namespace tenebra::ao

#else

namespace tenebra::ao {

struct ReferenceRays::State {};

Expected<ReferenceRays> ReferenceRays::create(const TriangleView&, const StopFlag*) {
  return base::fail(
      "ambient occlusion by rays: this build has no ray caster; install Embree 3 or 4 (package "
      "libembree-dev), then configure and build again");
}
void ReferenceRays::nearest_hits(const trees::RayBatch&, float*) const {}

}  // namespace tenebra::ao
#endif

namespace tenebra::ao {

ReferenceRays::ReferenceRays(std::unique_ptr<State> state) : state_(std::move(state)) {}
ReferenceRays::ReferenceRays(ReferenceRays&&) noexcept = default;
ReferenceRays& ReferenceRays::operator=(ReferenceRays&&) noexcept = default;
ReferenceRays::~ReferenceRays() = default;

}  // namespace tenebra::ao
