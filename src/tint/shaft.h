// The shaft of two boxes: a few planes with the hull of both on one side (Haines 2000), and boxes against it.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "math/box.h"

namespace tenebra::tint {

using Box = math::Box<double>;

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

/// The same in floats, for boxes with coordinates of at most `reach`: wider by more than all sums round.
struct FloatShaft {
  FloatShaft(const Shaft& shaft, double reach);

  float low[3], high[3];
  /// at[i] m + at[j] n <= limit for the place of a box that is deepest within; i and j are rows of
  /// EightBoxes.
  struct Plane {
    int i, j;
    float m, n, limit;
  };
  Plane planes[12];
  int count = 0;
};

}  // namespace tenebra::tint
