// The contestant: hard shadows by Embree's occlusion rays, sixteen coherent ones at a time.
#pragma once

#include <cstdint>
#include <vector>

#include "ao/reference/embree.h"
#include "bench/hard/hard_views.h"

namespace tenebra::bench {

/// Which pixels make a packet.
enum class PacketTile { wide, square };  // 8x2, 4x4
inline constexpr PacketTile packet_tiles[] = {PacketTile::wide, PacketTile::square};
const char* packet_tile_name(PacketTile tile);

/// What Embree is given: the visible points as planes of floats (so that its packets are loads, not
/// conversions), and which of them may see the light at all. Made outside of all measurements.
struct PeerPoints {
  int width = 0, height = 0;  ///< rounded up to whole packets; what was added has no ray
  std::vector<float> x, y, z;
  std::vector<std::int32_t> active;  ///< -1: faces eye and light; 0: no ray
};
PeerPoints peer_points(const HardView& view);

/// One scene of Embree over the casters of a frame.
class HardPeer {
public:
  /// `simd`: instructions that Embree is kept to; automatic: all it knows.
  HardPeer(const TriangleView& triangles, RTCBuildQuality quality, int threads,
           SimdLevel simd = SimdLevel::automatic);
  ~HardPeer();
  HardPeer(const HardPeer&) = delete;
  HardPeer& operator=(const HardPeer&) = delete;

  /// Builds the BVH from the same triangles anew.
  void build();
  /// 255 lit, 0 blocked or without a ray; of the size of `points`.
  void trace(const PeerPoints& points, const ShadowLight& light, PacketTile tile, ShadowMask& mask) const;

private:
  void occluded(const std::int32_t* valid, ao::EmbreeQuery& query, RTCRay16& rays) const;

  bool sixteen_;  ///< packets of sixteen are native; else eights are
  RTCDevice device_;
  RTCScene scene_;
  RTCGeometry mesh_;
};

}  // namespace tenebra::bench
