// Sixteen pixels at a time, as one would write it to trace with Embree's packets: where the rays through
// pixels meet their triangles, in float, and rays between these points and a light, both in vector code.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include <tenebra/hard_config.h>
#include <tenebra/visible_points.h>
#include "ao/reference/embree.h"

namespace tenebra::bench {

/// Four blocks of 2x2 pixels: a block's lanes follow each other, row by row, so that halves and quarters of a
/// tile are packets as well.
enum class TileShape { square, wide };  // 4x4: two blocks by two; 8x2: four in a row
struct alignas(64) TileLanes {
  float x[16], y[16];  ///< pixels from the tile's first
  static TileLanes of(TileShape shape);
};

/// The planes n.(p - eye) = d that the pixels see; n zero: nothing.
struct alignas(64) TilePlanes {
  float nx[16], ny[16], nz[16], d[16];
};
struct alignas(64) TilePoints {
  float x[16], y[16], z[16];
};

/// Which way rays run.
enum class RayWay { to_light, from_light };

/// A light as rays see it, relative to the eye where that is said.
struct LightAim {
  bool directional = false;
  RayWay way = RayWay::to_light;
  glm::vec3 place{0.0f};     ///< of a point light
  glm::vec3 step{0.0f};      ///< directional: towards the light, as long as the scene is wide
  glm::vec3 from_eye{0.0f};  ///< place - eye; directional: step
  glm::vec3 spot_axis{0.0f};
  float spot_cos = -1;      ///< -1: no cone
  float range_squared = 0;  ///< infinite: unbounded
};
/// `wide_m`: no smaller than the scene.
LightAim aim_at(const ShadowLight& light, const glm::vec3& eye, RayWay way, float wide_m);

/// Code for one instruction set and one size of packets: lanes first ... of a tile.
template <class Hits, class Rays>
struct PacketCode {
  /// Rays from the eye on, beyond the near plane; all of them but their masks. Tile at pixel (x, y).
  void (*look)(const ViewRays& view, const TileLanes& lanes, int first, float x, float y, Hits& rays);
  /// What these met.
  void (*met)(const Hits& rays, int first, TilePlanes& planes, TilePoints& points);
  /// Rays between the points and a light, all but their masks; validity -1 where the plane faces eye and
  /// light and the light reaches. False: nowhere.
  bool (*aim)(const TilePlanes& planes, const TilePoints& points, int first, const LightAim& light,
              Rays& rays, std::int32_t* valid);
  /// Bits of the valid lanes whose rays met nothing.
  std::uint32_t (*lit)(const Rays& rays, const std::int32_t* valid);
};
struct RayTileKernels {
  /// Where the rays through the tile at pixel (x, y) meet `planes`. The view has a perspective.
  void (*place)(const TilePlanes& planes, const ViewRays& view, const TileLanes& lanes, float x, float y,
                TilePoints& points);
  PacketCode<RTCRayHit16, RTCRay16> sixteen;
  PacketCode<RTCRayHit8, RTCRay8> eight;
  PacketCode<RTCRayHit4, RTCRay4> four;
};
RayTileKernels ray_tile_kernels(SimdLevel level);

}  // namespace tenebra::bench
