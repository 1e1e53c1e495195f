#include "query/stand_ins.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/until_stopped.h"

namespace tenebra::query {

namespace {

using glm::dvec3;
using glm::vec3;

constexpr std::uint32_t corners = 3;

/// Not all of it if `stop` is requested.
Mesh mesh_of(const std::vector<vec3>& positions, const std::vector<glm::uvec3>& triangles,
             const StopFlag* stop) {
  Mesh mesh;
  base::copy_until_stopped(std::span(positions), mesh.positions, stop);
  base::copy_until_stopped(std::span(triangles), mesh.triangles, stop);
  base::resize_until_stopped(mesh.materials, triangles.size(), stop);
  return mesh;
}

/// Gives `geometry` the sizes that the frame of `scene` needs; false if `stop` was requested.
bool make_room(const Scene& scene, FrameGeometry& geometry, const StopFlag* stop) {
  std::size_t vertices = 0, triangles = 0;
  for (const Mesh& mesh : scene.meshes) vertices += mesh.positions.size(), triangles += mesh.triangles.size();
  return base::resize_until_stopped(geometry.positions, vertices, stop) &&
         base::resize_until_stopped(geometry.normals, vertices, stop) &&
         base::resize_until_stopped(geometry.triangles, triangles, stop) &&
         base::resize_until_stopped(geometry.materials, triangles, stop) &&
         base::resize_until_stopped(geometry.casts_shadow, triangles, stop);
}

/// Room for stand-ins, of no size yet. A shape makes it a mesh that deforms.
Mesh empty_slots(std::size_t slots) {
  std::vector<glm::uvec3> triangles;
  for (std::uint32_t i = 0; i < slots; ++i) triangles.push_back(corners * i + glm::uvec3(0, 1, 2));
  Mesh mesh = mesh_of(std::vector<vec3>(corners * slots, vec3(0.0f)), triangles, nullptr);
  mesh.shapes.push_back({0.0, mesh.positions, {}});
  return mesh;
}

/// A unit vector across `n`, which is one.
dvec3 across(const dvec3& n) {
  const dvec3 size = glm::abs(n);
  const dvec3 axis = size.x <= size.y && size.x <= size.z ? dvec3(1, 0, 0)
                     : size.y <= size.z                   ? dvec3(0, 1, 0)
                                                          : dvec3(0, 0, 1);
  return glm::normalize(glm::cross(axis, n));
}

}  // namespace

bool StandIns::follow(const std::shared_ptr<const GeometryData>& data, std::size_t slots,
                      const StopFlag* stop) {
  const std::size_t room = slots == 0 ? slots_ : std::max(slots_, std::bit_ceil(slots));
  if (whole_ && data_ == data && revision_ == data->revision && room == slots_) return true;
  whole_ = false;  // until it is rebuilt: memory may run out, or a stop be requested
  data_ = data, revision_ = data->revision, slots_ = room;
  return whole_ = rebuild(stop);
}

bool StandIns::rebuild(const StopFlag* stop) {
  scene_ = {};
  scene_.materials.resize(1);
  scene_.meshes.push_back(mesh_of(data_->positions, data_->triangles, stop));
  scene_.meshes.push_back(empty_slots(slots_));
  if (stop_requested(stop) || !make_room(scene_, geometry_, stop)) return false;
  scene_.nodes.resize(scene_.meshes.size());
  for (std::size_t i = 0; i < scene_.nodes.size(); ++i) scene_.nodes[i].mesh = static_cast<int>(i);
  evaluate_frame(scene_, -1, 0.0, geometry_);
  if (stop_requested(stop)) return false;
  std::fill(geometry_.casts_shadow.begin(), geometry_.casts_shadow.end(), std::uint8_t{0});
  const auto own = geometry_.casts_shadow.begin();
  if (data_->casts_shadow.empty()) {
    std::fill_n(own, data_->triangles.size(), std::uint8_t{1});
  } else {
    std::copy(data_->casts_shadow.begin(), data_->casts_shadow.end(), own);
  }
  return true;
}

void StandIns::set(std::size_t slot, const dvec3& point, const dvec3& normal, StandAt at) {
  const dvec3 n = glm::normalize(normal), u = across(n), v = glm::cross(n, u);
  const double reach = std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)});
  double size = std::max(0x1p-6 * reach, 0x1p-12 * data_->diagonal);
  if (!(size > 0)) size = 0x1p-12;
  const dvec3 middle = at == StandAt::behind ? point - size * n : point;
  const dvec3 corner[corners] = {middle + size * u, middle + size * (v - u), middle - size * (u + v)};
  vec3* const to = &geometry_.positions[data_->positions.size() + corners * slot];
  for (std::size_t k = 0; k < corners; ++k) to[k] = vec3(corner[k]);
}

}  // namespace tenebra::query
