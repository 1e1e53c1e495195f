// Many triangles before most points: where soft shadows with an allowed error are sampled.
#pragma once

#include "soft/soft_case.h"

namespace tenebra::testing {

/// A floor below, a cloud of loose triangles between, a light above: many triangles before most points.
inline SoftCase below_leaves(int pixels, int leaves = 1200, double size = 0.12) {
  Random random(96);
  SoftCase c;
  c.name = "leaves, seed 96";
  c.soup.quad({-8, 0, -8}, {0, 0, 16}, {16, 0, 0});
  c.soup.append(random_soup(random, leaves, size).moved(1.2, {0, 2.5, 0}));
  c.light = square_light({0.4, 6, -0.3}, {0, 0, 0}, 1.5);
  c.view = pinhole({0, 1.1, 4}, {0, 0, 0}, 0.9, pixels, pixels);
  c.points = view_samples(c.soup.view(), c.view, pixels, pixels);
  return c;
}

}  // namespace tenebra::testing
