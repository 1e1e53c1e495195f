// The shaft of two boxes: a few planes with the hull of both on one side (Haines 2000).
#pragma once

#include <glm/glm.hpp>

#include "math/box.h"

namespace tenebra::trees {

/// Holds the hull of two boxes, and little more.
struct BoxShaft {
  /// x[i] m + x[j] n <= limit within the shaft.
  struct Plane {
    int i = 0, j = 1;
    double m = 0, n = 0, limit = 0;
  };
  math::Box<double> box;
  Plane planes[12];
  int count = 0;
};
BoxShaft shaft_between(const math::Box<double>& a, const math::Box<double>& b);

/// The same in floats, for boxes with coordinates of at most `reach`: wider by more than all sums round.
struct FloatShaft {
  FloatShaft(const BoxShaft& shaft, double reach);

  float low[3], high[3];
  /// at[i] m + at[j] n <= limit for the place of a box that is deepest within; i and j: 0 to 2 are its low
  /// planes, 3 to 5 its high ones.
  struct Plane {
    int i, j;
    float m, n, limit;
  };
  Plane planes[12];
  int count = 0;
};

}  // namespace tenebra::trees
