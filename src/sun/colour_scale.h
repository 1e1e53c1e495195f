// Numbers as colours: viridis, which grows evenly brighter, in print and for the colour-blind too.
#pragma once

#include <glm/glm.hpp>

#include "sun/hours_table.h"

namespace tenebra::sun {

/// From 0, dark blue, to `most`, yellow.
struct ColourScale {
  double most = 1;  ///< above 0; larger numbers have its colour

  /// sRGB, 0 to 1.
  glm::vec3 operator()(double value) const;
};

/// Up to the largest value; 1 where there is none above 0.
ColourScale scale_of(const Study& study);

}  // namespace tenebra::sun
