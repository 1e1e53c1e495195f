#include "bench/common/embree_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstring>

#include "bench/common/bench_embree.h"

namespace tenebra::bench {
namespace {

const char* isa_option(SimdLevel simd) {
  switch (simd) {
    case SimdLevel::avx512:
      return ",isa=avx512";
    case SimdLevel::avx2:
      return ",isa=avx2";
    case SimdLevel::sse4:
      return ",isa=sse4.2";
    case SimdLevel::scalar:  // Embree has none
      return ",isa=sse2";
    case SimdLevel::automatic:
      break;
  }
  return "";
}

bool follows(TreeKind kind) {
  return std::find(std::begin(moving_trees), std::end(moving_trees), kind) != std::end(moving_trees);
}
bool has_two_levels(TreeKind kind) {
  return kind == TreeKind::two_level || kind == TreeKind::two_level_refit;
}

RTCBuildQuality quality_of(TreeKind kind, bool moves) {
  switch (kind) {
    case TreeKind::rebuild:
      return RTC_BUILD_QUALITY_LOW;
    case TreeKind::refit:
      return RTC_BUILD_QUALITY_REFIT;
    case TreeKind::two_level:
      return moves ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_HIGH;
    case TreeKind::two_level_refit:
      return moves ? RTC_BUILD_QUALITY_REFIT : RTC_BUILD_QUALITY_HIGH;
    case TreeKind::medium:
      return RTC_BUILD_QUALITY_MEDIUM;
    case TreeKind::high:
      break;
  }
  return RTC_BUILD_QUALITY_HIGH;
}

}  // namespace

const char* tree_name(TreeKind kind) {
  constexpr const char* names[] = {"rebuild", "refit", "2-level", "2-level refit", "medium", "high"};
  return names[static_cast<std::size_t>(kind)];
}

std::string embree_settings(int threads, SimdLevel simd) {
  return fmt::format("threads={}{}", threads, isa_option(simd));
}

std::vector<std::uint8_t> moved_vertices(std::span<const glm::vec3> before, std::span<const glm::vec3> now) {
  assert(before.size() == now.size());
  std::vector<std::uint8_t> moved(now.size());
  for (std::size_t i = 0; i < now.size(); ++i) moved[i] = before[i] != now[i] ? 1 : 0;
  return moved;
}

bool has_ray_masks() {
  RTCDevice device = rtcNewDevice(nullptr);
  const bool has = rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_RAY_MASK_SUPPORTED) != 0;
  rtcReleaseDevice(device);
  return has;
}

EmbreeTree::EmbreeTree(const glm::vec3* vertices, const TriangleView& triangles,
                       std::span<const std::uint8_t> moves, const Settings& settings)
    : device_(new_device(embree_settings(settings.threads, settings.simd))), scene_(rtcNewScene(device_)) {
  // Embree takes one tree a geometry under a tree of trees for what a scene of low quality is.
  const bool follow = follows(settings.kind);
  if (follow) rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_DYNAMIC);
  rtcSetSceneBuildQuality(scene_, follow ? RTC_BUILD_QUALITY_LOW : quality_of(settings.kind, true));
  Part parts[4] = {{false, false, {}}, {true, false, {}}, {false, true, {}}, {true, true, {}}};
  for (std::size_t i = 0; i < triangles.triangles.size(); ++i) {
    const glm::uvec3 t = triangles.triangles[i];
    if (t == glm::uvec3(0)) continue;  // dropped
    const bool casts = triangles.casts_shadow.empty() || triangles.casts_shadow[i] != 0;
    if (settings.only_casters && !casts) continue;
    const bool apart =
        !has_two_levels(settings.kind) || moves[t.x] != 0 || moves[t.y] != 0 || moves[t.z] != 0;
    parts[(apart ? 1 : 0) + (casts ? 2 : 0)].ids.push_back(static_cast<std::uint32_t>(i));
  }
  for (const Part& part : parts) {
    if (!part.ids.empty()) add(part, vertices, triangles, settings.kind);
  }
  rtcCommitScene(scene_);
}

void EmbreeTree::add(const Part& part, const glm::vec3* vertices, const TriangleView& triangles,
                     TreeKind kind) {
  RTCGeometry mesh = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetGeometryBuildQuality(mesh, quality_of(kind, part.moves));
  rtcSetGeometryMask(mesh, part.casts ? meets_all | meets_casters : meets_all);
  rtcSetSharedGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, vertices, 0,
                             sizeof(glm::vec3), triangles.positions.size());
  auto* corners = static_cast<glm::uvec3*>(rtcSetNewGeometryBuffer(
      mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3), part.ids.size()));
  for (const std::uint32_t id : part.ids) *corners++ = triangles.triangles[id];
  rtcCommitGeometry(mesh);
  [[maybe_unused]] const unsigned number = rtcAttachGeometry(scene_, mesh);
  assert(number == first_.size());
  first_.push_back(ids_.size());
  ids_.insert(ids_.end(), part.ids.begin(), part.ids.end());
  if (part.moves) {
    moving_.push_back(mesh);
  } else {
    rtcReleaseGeometry(mesh);  // the scene has it
  }
}

EmbreeTree::~EmbreeTree() {
  for (RTCGeometry mesh : moving_) rtcReleaseGeometry(mesh);
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

bool EmbreeTree::takes_packets_of(int rays) const {
  const RTCDeviceProperty property = rays == 16  ? RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED
                                     : rays == 8 ? RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED
                                                 : RTC_DEVICE_PROPERTY_NATIVE_RAY4_SUPPORTED;
  return rtcGetDeviceProperty(device_, property) != 0;
}

void EmbreeTree::follow() {
  for (RTCGeometry mesh : moving_) {
    rtcUpdateGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0);
    rtcCommitGeometry(mesh);
  }
  if (!moving_.empty()) rtcCommitScene(scene_);
}

}  // namespace tenebra::bench
