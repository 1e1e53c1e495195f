// The shaft of two boxes: a few planes with the hull of both on one side (Haines 2000), and boxes against it.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace tenebra::tint {

struct Box {
  glm::dvec3 low{0.0}, high{0.0};
};

/// x[i] m + x[j] n <= limit within the shaft.
struct ShaftPlane {
  int i = 0, j = 1;
  double m = 0, n = 0, limit = 0;
};

/// Holds the hull of two boxes, and little more.
struct Shaft {
  Box box;
  ShaftPlane planes[12];
  int count = 0;
};
Shaft shaft_between(const Box& a, const Box& b);

/// Boxes of eight triangles or of eight nodes; those left over hold nothing.
inline constexpr int box_lanes = 8;
struct alignas(64) EightBoxes {
  float low[3][box_lanes], high[3][box_lanes];
};

/// Bits of the boxes that may meet the shaft: conservative.
std::uint32_t boxes_met(const EightBoxes& boxes, const Shaft& shaft);

}  // namespace tenebra::tint
