// The cone tree: a left-balanced implicit four-way tree over the shadow rays of one light. Bounds rays, not
// triangles. Olsson and Assarsson 2011, sections 3.1, 3.5 and 4.3.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

#include "shadow/decision/triangle_planes.h"
#include "shadow/rays/shadow_rays.h"

namespace tenebra::shadow {

inline constexpr int packet_size = 16;  ///< rays in a leaf: the two lowest levels of four, tested at once
inline constexpr int branching = 4;

/// A leaf: sixteen neighbouring rays. Point i = base + q_i relative to the source's origin, q rounded to
/// float.
struct RayPacket {
  float qx[packet_size], qy[packet_size], qz[packet_size];
  double base_x, base_y, base_z;
  float radius;        ///< >= largest |q|
  float reach;         ///< >= largest |point - origin|
  std::uint32_t live;  ///< bit i: a ray is there and not yet blocked
};

/// Point lights: unit axis w, chord c >= |direction - w| of every ray, shortest and longest ray. Directional
/// lights: w across the light's direction, radius c, lowest and highest position along it. A node without
/// rays has c < 0.
struct ConeNode {
  glm::vec3 w{0.0f};
  float c = -1;
  float near = std::numeric_limits<float>::infinity();
  float far = -std::numeric_limits<float>::infinity();
};

/// Four sibling nodes. Of cones also `sine` >= the sine of the half-angle (2 past 90 degrees) and `slope` >=
/// its tangent (cones of c < narrow_chord only), both made from the chord, which is exact where cosines are
/// not.
struct NodeBlock {
  float wx[4], wy[4], wz[4], c[4], near[4], far[4], sine[4], slope[4];
};
inline constexpr float narrow_chord = 1.35f;           ///< about 85 degrees
inline constexpr float hemisphere_chord = 1.4142137f;  ///< 90 degrees, rounded up

struct ConeTree {
  bool directional = false;
  std::vector<RayPacket> packets;
  /// levels[0]: one node for each packet; node i of level k has the children 4i..4i+3 of level k - 1. The
  /// last level is one block with the root in lane 0.
  std::vector<std::vector<NodeBlock>> levels;

  std::size_t byte_count() const;
  /// Packets below node `node` of level `level`: [first, last).
  std::array<std::size_t, 2> packet_range(std::size_t level, std::size_t node) const;
};

/// Packets and tree of `rays`, bottom-up.
void build_cone_tree(const ShadowRays& rays, std::span<const glm::dvec3> positions, const RaySource& source,
                     SimdLevel simd, ConeTree& out);
/// Bounds anew with the live rays only (section 3.4, between the two passes).
void update_cone_tree(const RaySource& source, ConeTree& tree);

/// Solid angle of the root's cone, or the area of its cylinder's section, about.
float root_extent(const ConeTree& tree);

}  // namespace tenebra::shadow
