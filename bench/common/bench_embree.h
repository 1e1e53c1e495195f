// Embree's scenes for the contestants: all triangles of a frame, or those that cast shadows.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <tenebra/visible_points.h>

#include "ao/reference/embree.h"

namespace tenebra::bench {

/// A device whose memory a MemoryMeter counts; `settings` as of rtcNewDevice.
RTCDevice new_device(const std::string& settings = "");

/// A device and one scene, built once at the highest quality (building is not measured). primID is the
/// triangle's id in `ids`, or in the view where `ids` is empty. `robust`: rays do not pass between triangles
/// that share an edge.
class EmbreeScene {
public:
  EmbreeScene(const TriangleView& triangles, bool only_casters, bool robust = false);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  RTCScene get() const { return scene_; }
  /// Id in the view of the triangle that Embree calls `prim`.
  std::uint32_t id_of(std::uint32_t prim) const { return ids_[prim]; }

private:
  RTCDevice device_;
  RTCScene scene_;
  std::vector<std::uint32_t> ids_;
};

/// What each pixel's ray meets first beyond the near plane; no_triangle: nothing. On all threads.
std::vector<std::uint32_t> nearest_triangles(const TriangleView& triangles, const ViewRays& view, int width,
                                             int height);

}  // namespace tenebra::bench
