// A camera for a scene that has none: nearby, with all of the subject in the picture, and some of its shadow;
// or in a closed room.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "stage/small_view.h"
#include "stage/subject.h"

namespace tenebra::stage {

/// Horizontal unit vectors: to the right of a view, and back towards its camera.
struct Compass {
  glm::dvec3 right{1, 0, 0}, back{0, 0, 1};
};
Compass compass_of(const glm::dvec3& right);

/// Unit, to a sun at the left behind the camera, 50 degrees high: the shadow falls to the right and away.
glm::dvec3 towards_sun(const Compass& compass);

struct Framing {
  glm::dvec3 eye{0.0};
  glm::dmat3 basis{1.0};  ///< right, up, back
  float vertical_fov_rad = 0.6f;
  float aspect = 4 / 3.0f;
  float near_m = 0.1f;
  double subject_share = 0;  ///< of the picture's area, at the start; of many small triangles by their cells
  double shadow_share = 0;   ///< of its shadow on the floor beside it; 0 without a floor
  std::optional<glm::dvec3> lamp;  ///< in a closed room: where a light may hang

  Lens lens() const;
};

/// From the side on which most of what is seen shows its front. Of some directions, shares of the shadow and,
/// without `aspect`, shapes of the picture: the first with which the subject fills a third of the picture and
/// its shadow is seen beside it; else the one that comes nearest. `floor_y`: where the shadow falls; none:
/// nowhere.
Framing frame_subject(const Subject& subject, std::optional<double> floor_y, std::optional<float> aspect);

}  // namespace tenebra::stage
