#include "query/geometry_scene.h"

#include <algorithm>

#include "base/until_stopped.h"

namespace tenebra::query {

namespace {

using glm::vec3;

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

}  // namespace

bool GeometryScene::follow(const std::shared_ptr<const GeometryData>& data, const StopFlag* stop) {
  if (whole_ && data_ == data && revision_ == data->revision) return true;
  whole_ = false;  // until it is rebuilt: memory may run out, or a stop be requested
  data_ = data, revision_ = data->revision;
  return whole_ = rebuild(stop);
}

bool GeometryScene::rebuild(const StopFlag* stop) {
  scene_ = {};
  scene_.materials.resize(1);
  scene_.meshes.push_back(mesh_of(data_->positions, data_->triangles, stop));
  if (stop_requested(stop) || !make_room(scene_, geometry_, stop)) return false;
  scene_.nodes.resize(1);
  scene_.nodes[0].mesh = 0;
  evaluate_frame(scene_, -1, 0.0, geometry_);
  if (stop_requested(stop)) return false;
  if (data_->casts_shadow.empty()) {
    std::fill(geometry_.casts_shadow.begin(), geometry_.casts_shadow.end(), std::uint8_t{1});
  } else {
    std::copy(data_->casts_shadow.begin(), data_->casts_shadow.end(), geometry_.casts_shadow.begin());
  }
  return true;
}

}  // namespace tenebra::query
